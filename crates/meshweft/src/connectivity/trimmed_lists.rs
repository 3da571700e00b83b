//! The order in which vertices are met, and what each of them brings in.

use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{Permutation, VertexOrder};
use crate::topology::Adjacency;

/// The trimmed adjacency lists of a mesh, one after the other: its reordered vertex array.
///
/// Vertices become the *root* one by one, in the order in which they were met, and each brings in those
/// of its neighbours that were not met before, as they come around it in the direction of the faces. Where
/// no root is left, a vertex that was not met yet begins: this is how parts and vertices without faces are
/// reached.
///
/// The paper leaves open with which neighbour a list begins. It is the one after PREV, the last vertex that
/// was met, where an edge leads there; then one with which an open fan begins, then any.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrimmedLists {
    vertices: VertexOrder,
    lengths: Vec<u32>,
}

impl TrimmedLists {
    /// The lists of a mesh, beginning with one of its vertices.
    ///
    /// # Panics
    /// If there are vertices, and `first_vertex` is not one of them.
    ///
    /// # Complexity
    /// Time O(vertices + faces log valence); space 20 bytes a vertex and 12 a face.
    #[must_use]
    pub fn new<'a>(faces: impl Into<Faces<'a>>, first_vertex: u32) -> Self {
        let faces = faces.into();
        let count = faces.vertex_count();
        assert!(
            count == 0 || (first_vertex as usize) < count,
            "no vertex {first_vertex}"
        );
        let mut met = Met::new(count);
        let mut around = Around::default();
        let adjacency = Adjacency::new(faces);
        let mut lengths = vec![0; count];
        let mut next_seed = 0;
        let mut seed = first_vertex;
        for (root, length) in lengths.iter_mut().enumerate() {
            if root == met.vertices.len() {
                while met.has(seed) {
                    seed = next_seed;
                    next_seed += 1;
                }
                met.add(seed);
            }
            let before = met.vertices.len();
            around.gather(met.vertices[root], faces.as_slice(), &adjacency);
            around.meet(&mut met);
            *length = index32(met.vertices.len() - before);
        }
        Self {
            vertices: Permutation::from_algorithm(met.vertices).into(),
            lengths,
        }
    }

    /// The reordered vertex array.
    #[must_use]
    pub fn vertices(&self) -> &VertexOrder {
        &self.vertices
    }

    /// The share of vertices that an edge joins to the next one, of all but the last.
    ///
    /// # Panics
    /// If the faces have other vertices.
    ///
    /// # Complexity
    /// Time O(vertices + faces).
    #[must_use]
    pub fn joined_share<'a>(&self, faces: impl Into<Faces<'a>>) -> f64 {
        let mut renumbered = faces.into().as_slice().to_vec();
        self.vertices.renumber_in_place(&mut renumbered);
        let steps = self.lengths.len().saturating_sub(1);
        let mut is_joined = vec![false; steps];
        for [a, b, c] in renumbered {
            for [x, y] in [[a, b], [b, c], [c, a]] {
                if x.abs_diff(y) == 1 {
                    is_joined[x.min(y) as usize] = true;
                }
            }
        }
        let joined = is_joined.into_iter().filter(|&it| it).count();
        joined as f64 / steps.max(1) as f64
    }

    /// How many vertices each root brings in, by the new numbers.
    #[must_use]
    pub fn lengths(&self) -> &[u32] {
        &self.lengths
    }
}

/// The vertices that were met.
struct Met {
    vertices: Vec<u32>,
    is_met: Vec<bool>,
}

impl Met {
    fn new(count: usize) -> Self {
        Self {
            vertices: Vec::with_capacity(count),
            is_met: vec![false; count],
        }
    }

    fn has(&self, vertex: u32) -> bool {
        self.is_met[vertex as usize]
    }

    fn add(&mut self, vertex: u32) {
        if !std::mem::replace(&mut self.is_met[vertex as usize], true) {
            self.vertices.push(vertex);
        }
    }
}

/// The faces around a root: of each the two corners that follow it.
#[derive(Default)]
struct Around {
    /// Rising.
    pairs: Vec<[u32; 2]>,
    is_passed: Vec<bool>,
    /// The second corners, rising.
    ends: Vec<u32>,
    /// Of the first pair of each first corner, how many were passed.
    passed: Vec<u32>,
}

impl Around {
    fn gather(&mut self, root: u32, faces: &[[u32; 3]], adjacency: &Adjacency) {
        let pair = |&face: &u32| {
            let [a, b, c] = faces[face as usize];
            match () {
                () if a == root => [b, c],
                () if b == root => [c, a],
                () => [a, b],
            }
        };
        self.pairs.clear();
        self.pairs.extend(adjacency.faces_of(root).iter().map(pair));
        // A corner at the root itself is a neighbour that was met.
        self.pairs.sort_unstable();
        self.is_passed.clear();
        self.is_passed.resize(self.pairs.len(), false);
        self.ends.clear();
        self.ends.extend(self.pairs.iter().map(|pair| pair[1]));
        self.ends.sort_unstable();
        self.passed.clear();
        self.passed.resize(self.pairs.len(), 0);
    }

    /// Adds the neighbours in the order in which they come around the root.
    fn meet(&mut self, met: &mut Met) {
        // After the last one that was met.
        if let Some(&previous) = met.vertices.last() {
            self.walk(previous, met);
        }
        // Open fans: those that go on from a vertex that was met, then the others.
        for is_met in [true, false] {
            for at in 0..self.pairs.len() {
                let [from, _] = self.pairs[at];
                let is_start = self.ends.binary_search(&from).is_err();
                if is_start && !self.is_passed[at] && met.has(from) == is_met {
                    self.walk(from, met);
                }
            }
        }
        // Closed fans.
        for is_met in [true, false] {
            for at in 0..self.pairs.len() {
                if !self.is_passed[at] && met.has(self.pairs[at][0]) == is_met {
                    self.walk(self.pairs[at][0], met);
                }
            }
        }
    }

    /// From a neighbour to the next one, as long as a face leads there.
    fn walk(&mut self, start: u32, met: &mut Met) {
        let mut from = start;
        while let Some(at) = self.face_from(from) {
            self.is_passed[at] = true;
            met.add(from);
            from = self.pairs[at][1];
            met.add(from);
        }
    }

    /// The next face that was not passed and leads on from a neighbour.
    fn face_from(&mut self, from: u32) -> Option<usize> {
        let first = self.pairs.partition_point(|pair| pair[0] < from);
        let passed = self.passed.get_mut(first)?;
        let at = first + *passed as usize;
        let found = self.pairs.get(at).filter(|pair| pair[0] == from);
        *passed += u32::from(found.is_some());
        found.map(|_| at)
    }
}
