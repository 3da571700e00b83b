//! The vertices that were used last.

use super::scores::LIST_SIZE;

/// The LRU list, from the last used vertex on.
#[derive(Default)]
pub(super) struct RecentVertices {
    /// The list, then those that the last face pushed out of it.
    vertices: [u32; LIST_SIZE + 3],
    len: usize,
}

impl RecentVertices {
    /// Puts the corners of a face, in their order, to the front.
    #[inline]
    pub(super) fn draw(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners;
        let mut vertices = [0; LIST_SIZE + 3];
        vertices[..3].copy_from_slice(&corners);
        let mut len = 3;
        for &vertex in self.listed() {
            vertices[len] = vertex;
            len += usize::from((vertex != a) & (vertex != b) & (vertex != c));
        }
        *self = Self { vertices, len };
    }

    /// The vertices in the list.
    #[inline]
    pub(super) fn listed(&self) -> &[u32] {
        &self.vertices[..self.len.min(LIST_SIZE)]
    }

    /// The vertices in the list, then those that just left it.
    #[inline]
    pub(super) fn with_those_that_left(&self) -> &[u32] {
        &self.vertices[..self.len]
    }

    /// The vertices that just left the list.
    pub(super) fn left(&self) -> &[u32] {
        &self.vertices[self.listed().len()..self.len]
    }
}
