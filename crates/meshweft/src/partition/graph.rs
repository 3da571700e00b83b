//! Weighted graphs in compact rows.

use crate::limits::index32;

/// An undirected graph with weights on vertices and edges, both of them kept at both ends of an
/// edge.
///
/// ```
/// use meshweft::partition::Graph;
/// // Two squares of two faces each, side by side: a path of four faces.
/// let faces = [[0, 1, 4], [0, 4, 3], [1, 2, 4], [2, 5, 4]];
/// let graph = Graph::dual(&faces, 6);
/// assert_eq!(graph.neighbours(0).collect::<Vec<_>>(), [(1, 1), (2, 1)]);
/// assert_eq!((graph.vertex_count(), graph.edge_count()), (4, 3));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Graph {
    pub(super) offsets: Vec<u32>,
    /// The other end and the weight of each edge, by vertex.
    pub(super) edges: Vec<(u32, u32)>,
    pub(super) weights: Vec<u32>,
}

impl Graph {
    /// `vertex_count` vertices of weight 1, joined by edges with their weights.
    ///
    /// Edges between the same ends add up; an edge from a vertex to itself is dropped.
    ///
    /// # Panics
    /// If an edge names a vertex that is not there, or weights add up to more than 32 bits hold.
    ///
    /// # Complexity
    /// Time and space O(vertices + edges).
    #[must_use]
    pub fn from_edges(vertex_count: usize, edges: &[(u32, u32, u32)]) -> Self {
        let mut offsets = vec![0_u32; vertex_count + 1];
        let proper = || edges.iter().filter(|(a, b, _)| a != b);
        for &(a, b, _) in proper() {
            offsets[a as usize + 1] += 1;
            offsets[b as usize + 1] += 1;
        }
        for i in 0..vertex_count {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut rows = vec![(0, 0); offsets[vertex_count] as usize];
        for &(a, b, weight) in proper() {
            for (from, to) in [(a, b), (b, a)] {
                let slot = &mut next[from as usize];
                rows[*slot as usize] = (to, weight);
                *slot += 1;
            }
        }
        let raw = Self {
            offsets,
            edges: rows,
            weights: vec![1; vertex_count],
        };
        // As a contraction in which each vertex stays alone, which adds up what is parallel.
        let alone: Vec<u32> = (0..index32(vertex_count)).collect();
        raw.contracted(&alone, vertex_count)
    }

    /// The dual graph of a mesh: a vertex a face, an edge between faces that share an edge.
    ///
    /// Where more than two faces share an edge, each is joined to the next.
    ///
    /// # Panics
    /// If a face names a vertex that is not there.
    ///
    /// # Complexity
    /// Time O(faces · log of the most faces at a vertex), space 60 bytes a face.
    #[must_use]
    pub fn dual(faces: &[[u32; 3]], vertex_count: usize) -> Self {
        // The edges of all faces by their lesser end: the other end and the face.
        let ends = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        let mut offsets = vec![0_u32; vertex_count + 1];
        for [a, b] in faces.iter().flat_map(ends) {
            assert!(
                (a.max(b) as usize) < vertex_count,
                "face names vertex {a} or {b}"
            );
            offsets[a.min(b) as usize] += 1;
        }
        let mut end = 0;
        for offset in &mut offsets {
            end += *offset;
            *offset = end;
        }
        let mut rows = vec![(0_u32, 0_u32); faces.len() * 3];
        for (face, corners) in (0..index32(faces.len())).zip(faces).rev() {
            for [a, b] in ends(corners) {
                let slot = &mut offsets[a.min(b) as usize];
                *slot -= 1;
                rows[*slot as usize] = (a.max(b), face);
            }
        }
        let mut edges = Vec::with_capacity(faces.len() * 3 / 2);
        for row in offsets.windows(2) {
            let row = &mut rows[row[0] as usize..row[1] as usize];
            row.sort_unstable();
            let touching = row.windows(2).filter(|pair| pair[0].0 == pair[1].0);
            edges.extend(touching.map(|pair| (pair[0].1, pair[1].1, 1)));
        }
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
        self.edges.len() / 2
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
        let v = vertex as usize;
        &self.edges[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }

    /// The graph whose vertices are groups of this one's, `count` of them.
    pub(super) fn contracted(&self, group_of: &[u32], count: usize) -> Self {
        let mut weights = vec![0; count];
        // The members of each group, listed by counting.
        let mut starts = vec![0_u32; count + 1];
        for (&group, weight) in group_of.iter().zip(&self.weights) {
            weights[group as usize] += weight;
            starts[group as usize + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut members = vec![0; group_of.len()];
        for (vertex, &group) in (0..).zip(group_of) {
            let slot = &mut next[group as usize];
            members[*slot as usize] = vertex;
            *slot += 1;
        }
        let mut offsets = Vec::with_capacity(count + 1);
        offsets.push(0);
        let mut edges: Vec<(u32, u32)> = Vec::with_capacity(self.edges.len() / 2);
        // Where the edge to each group stands, if it is at or behind the start of the row.
        let mut place = vec![u32::MAX; count];
        for group in 0..index32(count) {
            let start = edges.len();
            let [from, to] = [group, group + 1].map(|g| starts[g as usize] as usize);
            for &vertex in &members[from..to] {
                for &(other, weight) in self.row(vertex) {
                    let other = group_of[other as usize];
                    if other == group {
                        continue;
                    }
                    let at = place[other as usize] as usize;
                    match edges.get_mut(at) {
                        Some(edge) if at >= start => edge.1 += weight,
                        _ => {
                            place[other as usize] = index32(edges.len());
                            edges.push((other, weight));
                        }
                    }
                }
            }
            offsets.push(index32(edges.len()));
        }
        Self {
            offsets,
            edges,
            weights,
        }
    }

    /// The graphs of both sides, and which vertices of this one they have.
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

    /// The graph of some vertices and the edges among them; `number` is the place of a vertex among
    /// them, if it is one of them.
    pub(crate) fn induced(&self, members: &[u32], number: impl Fn(u32) -> Option<u32>) -> Self {
        let mut graph = Self {
            offsets: Vec::with_capacity(members.len() + 1),
            edges: Vec::with_capacity(self.edges.len() * members.len() / self.weights.len().max(1)),
            weights: Vec::with_capacity(members.len()),
        };
        graph.offsets.push(0);
        for &vertex in members {
            let row = self.row(vertex).iter();
            let inside = row.filter_map(|&(other, weight)| Some((number(other)?, weight)));
            graph.edges.extend(inside);
            graph.offsets.push(index32(graph.edges.len()));
            graph.weights.push(self.weights[vertex as usize]);
        }
        graph
    }
}
