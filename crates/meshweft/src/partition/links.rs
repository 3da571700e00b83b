//! The vertex graph of a mesh, read off its faces.

use crate::faces::Faces;
use crate::topology::{Adjacency, distinct};

/// Vertices joined by an edge for each face that has both: so a face whose vertices are in two
/// parts cuts two edges, and one whose vertices are in three cuts three.
#[derive(Debug)]
pub(super) struct Links<'a> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
}

impl<'a> Links<'a> {
    /// Time and space O(vertices + faces).
    pub(super) fn new(faces: Faces<'a>) -> Self {
        Self {
            faces: faces.as_slice(),
            adjacency: Adjacency::new(faces),
        }
    }

    /// How many vertices there are, used or not.
    pub(super) fn vertex_count(&self) -> usize {
        self.adjacency.vertex_count()
    }

    /// Whether some face names the vertex.
    #[inline]
    pub(super) fn is_used(&self, vertex: u32) -> bool {
        !self.adjacency.faces_of(vertex).is_empty()
    }

    /// The other ends of the edges of a vertex, each as often as there are edges.
    #[inline]
    pub(super) fn others(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let faces = self.adjacency.faces_of(vertex).iter();
        let corners = faces.flat_map(|&face| distinct(self.faces[face as usize]));
        corners.filter(move |&other| other != vertex)
    }

    /// The corners of the faces of a vertex, so itself too: cheaper than
    /// [`others`](Self::others).
    #[inline]
    pub(super) fn corners(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let faces = self.adjacency.faces_of(vertex).iter();
        faces.flat_map(|&face| self.faces[face as usize])
    }

    /// Both ends of each edge.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> {
        self.faces.iter().flat_map(|&[a, b, c]| {
            // A face that names a vertex twice has one edge, or none.
            let [ab, bc, ca] = [a != b, b != c && a != c, a != b && b != c && c != a];
            let edges = [(ab, [a, b]), (bc, [b, c]), (ca, [c, a])];
            edges
                .into_iter()
                .filter(|&(is_edge, _)| is_edge)
                .map(|(_, ends)| ends)
        })
    }
}
