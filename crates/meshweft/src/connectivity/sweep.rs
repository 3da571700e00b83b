//! How far vertices are from each other, in edges.

use crate::faces::Faces;
use crate::topology::Adjacency;

/// Stands for a vertex that is not reached.
pub(super) const FAR: u32 = u32::MAX;

/// Goes through parts of a mesh from any vertex, nearest vertices first.
pub(super) struct Sweep<'a> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
    /// Edges from the first vertex; [`FAR`] of those not reached by the last sweep.
    distance: Vec<u32>,
    /// The vertices reached, nearest first.
    reached: Vec<u32>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(faces: Faces<'a>) -> Self {
        Self {
            faces: faces.as_slice(),
            adjacency: Adjacency::new(faces),
            distance: vec![FAR; faces.vertex_count()],
            reached: Vec::new(),
        }
    }

    /// Sweeps the part of a vertex; returns the vertices reached, nearest first, and how far the last one is.
    pub(super) fn from(&mut self, vertex: u32) -> (&[u32], u32) {
        for &reached in &self.reached {
            self.distance[reached as usize] = FAR;
        }
        self.reached.clear();
        self.reached.push(vertex);
        self.distance[vertex as usize] = 0;
        let mut at = 0;
        while let Some(&vertex) = self.reached.get(at) {
            at += 1;
            let next = self.distance[vertex as usize] + 1;
            for &face in self.adjacency.faces_of(vertex) {
                for corner in self.faces[face as usize] {
                    let distance = &mut self.distance[corner as usize];
                    if *distance == FAR {
                        *distance = next;
                        self.reached.push(corner);
                    }
                }
            }
        }
        let last = self.reached.last().copied().unwrap_or(vertex);
        (&self.reached, self.distance[last as usize])
    }

    /// A vertex at an end of the part of a vertex: the farthest from it, and the farthest from that, as long
    /// as they get farther.
    pub(super) fn end(&mut self, vertex: u32) -> u32 {
        let (mut end, mut farthest) = (vertex, 0);
        loop {
            let (reached, distance) = self.from(end);
            let Some(&last) = reached.last().filter(|_| distance > farthest) else {
                return end;
            };
            (end, farthest) = (last, distance);
        }
    }
}

/// A bound of the required buffer size, of any order in which vertices are sent once: (*V* − 1) over the
/// diameter, of the part for which it is largest.
///
/// A first-in first-out buffer that holds both ends of each edge is longer than the largest difference of
/// numbers at an edge, and these differences lead from the first number to the last within the diameter. The
/// diameter is that of a double sweep from four vertices, which may be too small: then the bound is too
/// large.
///
/// # Complexity
/// Time O(vertices + faces).
#[must_use]
pub fn buffer_bound<'a>(faces: impl Into<Faces<'a>>) -> f64 {
    let faces = faces.into();
    let mut sweep = Sweep::new(faces);
    let mut is_known = vec![false; faces.vertex_count()];
    let mut bound = 0.0_f64;
    for vertex in faces.as_slice().as_flattened() {
        if is_known[*vertex as usize] {
            continue;
        }
        let (part, _) = sweep.from(*vertex);
        let count = part.len();
        let starts = [0, 1, 2, 3].map(|quarter| part[quarter * count / 4]);
        for &reached in part {
            is_known[reached as usize] = true;
        }
        let diameters = starts.map(|start| {
            let (reached, _) = sweep.from(start);
            let last = reached.last().copied().unwrap_or(start);
            sweep.from(last).1
        });
        let diameter = diameters.into_iter().max().unwrap_or(0);
        if diameter > 0 {
            bound = bound.max((count - 1) as f64 / f64::from(diameter));
        }
    }
    bound
}
