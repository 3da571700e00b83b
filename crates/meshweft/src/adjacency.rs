//! Which faces touch each vertex, in compact rows.

use crate::limits::index32;

/// Vertex → faces as compact sparse rows: one offset a vertex, one entry a corner.
///
/// A face that names a vertex twice stands in that vertex's row once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adjacency {
    /// Row `v` is `faces[offsets[v]..offsets[v + 1]]`.
    offsets: Vec<u32>,
    faces: Vec<u32>,
}

impl Adjacency {
    /// The rows of these faces over `vertex_count` vertices; each row rises in file order.
    ///
    /// # Panics
    /// If a face names a vertex past `vertex_count`; a [`Mesh`](crate::Mesh) never does.
    ///
    /// # Complexity
    /// Time O(vertices + faces), 4 bytes a vertex and 12 a face.
    #[must_use]
    pub fn new(faces: &[[u32; 3]], vertex_count: usize) -> Self {
        let mut offsets = vec![0_u32; vertex_count + 1];
        for &face in faces {
            for vertex in distinct(face) {
                offsets[vertex as usize + 1] += 1;
            }
        }
        for v in 0..vertex_count {
            offsets[v + 1] += offsets[v];
        }
        let mut rows = vec![0_u32; offsets[vertex_count] as usize];
        // `offsets[v]` walks from the start of row `v` to its end, then all are set back by one row.
        for (number, &face) in faces.iter().enumerate() {
            for vertex in distinct(face) {
                let end = &mut offsets[vertex as usize];
                rows[*end as usize] = index32(number);
                *end += 1;
            }
        }
        offsets.copy_within(0..vertex_count, 1);
        offsets[0] = 0;
        Self {
            offsets,
            faces: rows,
        }
    }

    /// The faces that name `vertex`, in file order.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    #[inline]
    pub fn faces_of(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.faces[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }

    /// How many faces name `vertex`.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    #[inline]
    pub fn degree(&self, vertex: u32) -> u32 {
        self.offsets[vertex as usize + 1] - self.offsets[vertex as usize]
    }

    /// How many vertices have a row.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.offsets.len() - 1
    }
}

/// The vertices of a face, each once.
#[inline]
pub(crate) fn distinct(face: [u32; 3]) -> impl Iterator<Item = u32> {
    let [a, b, c] = face;
    let keep = [true, b != a, c != a && c != b];
    face.into_iter().zip(keep).filter(|p| p.1).map(|p| p.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_rise_and_name_each_face_once() {
        let adjacency = Adjacency::new(&[[0, 1, 2], [2, 1, 3], [3, 3, 1], [4, 4, 4]], 6);
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
        let adjacency = Adjacency::new(&[], 2);
        assert_eq!(adjacency.faces_of(1), [0; 0]);
        assert_eq!(Adjacency::new(&[], 0).vertex_count(), 0);
    }
}
