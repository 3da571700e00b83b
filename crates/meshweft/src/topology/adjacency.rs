//! Which faces touch each vertex, in compact rows.

use super::rows::Rows;
use crate::faces::Faces;
use crate::index::index32;

/// Vertex → faces as compact sparse rows: one offset a vertex, one entry a corner.
///
/// A face that names a vertex twice stands in that vertex's row once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adjacency {
    rows: Rows<u32>,
}

impl Adjacency {
    /// For each vertex the faces that name it; each row rises in file order.
    ///
    /// # Complexity
    /// Time O(vertices + faces), 4 bytes a vertex and 12 a face.
    #[must_use]
    pub fn new<'a>(faces: impl Into<Faces<'a>>) -> Self {
        let faces = faces.into();
        let numbered = (0_u32..).zip(faces.as_slice());
        let items = numbered.flat_map(|(number, &face)| distinct(face).map(move |v| (v, number)));
        Self {
            rows: Rows::by_counting(faces.vertex_count(), items),
        }
    }

    /// The faces that name `vertex`, in file order.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    #[inline]
    pub fn faces_of(&self, vertex: u32) -> &[u32] {
        self.rows.row(vertex)
    }

    /// How many faces name `vertex`.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    #[inline]
    pub fn degree(&self, vertex: u32) -> u32 {
        index32(self.rows.row(vertex).len())
    }

    /// How many vertices have a row.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.rows.len()
    }
}

/// The vertices of a face, each once.
#[inline]
pub(crate) fn distinct(face: [u32; 3]) -> impl Iterator<Item = u32> + Clone {
    let [a, b, c] = face;
    let (corners, count) = match (b == a, c == a || c == b) {
        (false, false) => ([a, b, c], 3),
        (false, true) => ([a, b, b], 2),
        (true, false) => ([a, c, c], 2),
        (true, true) => ([a; 3], 1),
    };
    corners.into_iter().take(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_rise_and_name_each_face_once() {
        let faces = [[0, 1, 2], [2, 1, 3], [3, 3, 1], [4, 4, 4]];
        let adjacency = Adjacency::new(Faces::new(&faces, 6).unwrap());
        assert_eq!(adjacency.faces_of(0), [0]);
        assert_eq!(adjacency.faces_of(1), [0, 1, 2]);
        assert_eq!(adjacency.faces_of(2), [0, 1]);
        assert_eq!(adjacency.faces_of(3), [1, 2]);
        assert_eq!(adjacency.faces_of(4), [3]);
        assert_eq!(adjacency.faces_of(5), [0; 0]);
        assert_eq!(adjacency.degree(1), 3);
        assert_eq!(adjacency.vertex_count(), 6);
    }

    #[test]
    fn no_faces_leave_empty_rows() {
        let adjacency = Adjacency::new(Faces::new(&[], 2).unwrap());
        assert_eq!(adjacency.faces_of(1), [0; 0]);
        assert_eq!(Adjacency::new(Faces::default()).vertex_count(), 0);
    }
}
