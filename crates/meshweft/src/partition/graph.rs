//! Weighted graphs in compact rows.

use crate::faces::Faces;
use crate::index::index32;
use crate::topology::rows::Rows;

/// An undirected graph with weights on vertices and edges.
///
/// ```
/// use meshweft::partition::Graph;
/// // Two squares of two faces each, side by side: a path of four faces.
/// let faces = [[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 5, 4]];
/// let graph = Graph::dual(&faces);
/// assert_eq!(graph.neighbours(0).collect::<Vec<_>>(), [(1, 1), (2, 1)]);
/// assert_eq!((graph.vertex_count(), graph.edge_count()), (4, 3));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Graph {
    /// For each vertex, the other end and the weight of each edge. So each edge is stored twice.
    pub(super) edges: Rows<(u32, u32)>,
    pub(super) weights: Vec<u32>,
}

impl Graph {
    /// The graph of `vertex_count` vertices of weight 1 and these edges: two ends and a weight
    /// each.
    ///
    /// Weights of edges between the same ends are added up; an edge from a vertex to itself is
    /// dropped.
    ///
    /// # Panics
    /// If an edge names a vertex that does not exist, or a sum of weights is more than 32 bits
    /// hold.
    ///
    /// # Complexity
    /// Time and space O(vertices + edges).
    #[must_use]
    pub fn from_edges(vertex_count: usize, edges: &[(u32, u32, u32)]) -> Self {
        let proper = edges.iter().filter(|(a, b, _)| a != b);
        let both_ends = proper.flat_map(|&(a, b, weight)| [(a, (b, weight)), (b, (a, weight))]);
        let raw = Self {
            edges: Rows::by_counting(vertex_count, both_ends),
            weights: vec![1; vertex_count],
        };

        // A contraction adds up parallel edges; here each vertex is a group of its own.
        let alone: Vec<u32> = (0..index32(vertex_count)).collect();
        raw.contracted(&alone, vertex_count)
    }

    /// The dual graph of a mesh: a vertex for each face, an edge between faces that share an edge.
    ///
    /// Where more than two faces share an edge, each is joined to the next, in file order.
    ///
    /// # Complexity
    /// Time O(faces · log of the most faces at a vertex), space 60 bytes a face.
    #[must_use]
    pub fn dual<'a>(faces: impl Into<Faces<'a>>) -> Self {
        let faces = faces.into();

        // For each vertex, the edges of which it is the lesser end: the other end and the face.
        let ends = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        let numbered = (0_u32..).zip(faces.as_slice());
        let items = numbered
            .flat_map(|(face, corners)| ends(corners).map(|[a, b]| (a.min(b), (a.max(b), face))));
        let mut by_lesser_end = Rows::by_counting(faces.vertex_count(), items);

        // Faces that share an edge are next to each other in a sorted row.
        let mut edges = Vec::with_capacity(faces.len() * 3 / 2);
        for row in by_lesser_end.rows_mut() {
            row.sort_unstable();
            let touching = row.windows(2).filter(|pair| pair[0].0 == pair[1].0);
            edges.extend(touching.map(|pair| (pair[0].1, pair[1].1, 1)));
        }
        drop(by_lesser_end);

        Self::from_edges(faces.len(), &edges)
    }

    /// How many vertices there are.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.weights.len()
    }

    /// How many edges there are.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.edges.entries().len() / 2
    }

    /// The neighbours of a vertex, and the weights of the edges to them.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn neighbours(&self, vertex: u32) -> impl Iterator<Item = (u32, u32)> {
        self.row(vertex).iter().copied()
    }

    /// The sum of the weights of all vertices.
    #[must_use]
    pub fn weight(&self) -> u64 {
        self.weights.iter().copied().map(u64::from).sum()
    }

    #[inline]
    pub(super) fn row(&self, vertex: u32) -> &[(u32, u32)] {
        self.edges.row(vertex)
    }

    /// The graph whose vertices are `count` groups of this one's; weights are added up.
    pub(super) fn contracted(&self, group_of: &[u32], count: usize) -> Self {
        let mut weights = vec![0; count];
        for (&group, weight) in group_of.iter().zip(&self.weights) {
            weights[group as usize] += weight;
        }
        let members = Rows::by_counting(count, group_of.iter().copied().zip(0_u32..));

        let mut edges = Rows::with_capacity(count, self.edges.entries().len() / 2);
        // The place of the edge to each group; out of date if it is before the start of the row.
        let mut place = vec![u32::MAX; count];
        for group in 0..index32(count) {
            let start = edges.entries().len();
            for &vertex in members.row(group) {
                for &(other, weight) in self.row(vertex) {
                    let other = group_of[other as usize];
                    if other == group {
                        continue;
                    }
                    let at = place[other as usize] as usize;
                    match edges.entries_mut().get_mut(at) {
                        Some((_, sum)) if at >= start => *sum += weight,
                        _ => {
                            place[other as usize] = index32(edges.entries().len());
                            edges.push((other, weight));
                        }
                    }
                }
            }
            edges.end_row();
        }
        Self { edges, weights }
    }

    /// The graphs of both sides, and for each the vertices of this one that it has.
    pub(crate) fn split(&self, side: &[bool]) -> [(Self, Vec<u32>); 2] {
        let mut number = Vec::with_capacity(side.len());
        let mut members = [Vec::new(), Vec::new()];
        for (vertex, &side) in (0..).zip(side) {
            let members = &mut members[usize::from(side)];
            number.push(index32(members.len()));
            members.push(vertex);
        }
        let [first, second] = members;
        let first_part = self.induced(&first, |v| (!side[v as usize]).then(|| number[v as usize]));
        let second_part = self.induced(&second, |v| side[v as usize].then(|| number[v as usize]));
        [(first_part, first), (second_part, second)]
    }

    /// The graph of some vertices and the edges among them; `number` is the place of a vertex in
    /// `members`, or `None`.
    pub(crate) fn induced(&self, members: &[u32], number: impl Fn(u32) -> Option<u32>) -> Self {
        let share = self.edges.entries().len() * members.len() / self.weights.len().max(1);
        let mut edges = Rows::with_capacity(members.len(), share);
        let mut weights = Vec::with_capacity(members.len());
        for &vertex in members {
            let row = self.row(vertex).iter();
            edges.extend(row.filter_map(|&(other, weight)| Some((number(other)?, weight))));
            edges.end_row();
            weights.push(self.weights[vertex as usize]);
        }
        Self { edges, weights }
    }
}
