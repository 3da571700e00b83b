//! Drawing faces tentatively: on time stamps alone, to learn the cost, and taken back.

use crate::index::index32;
use crate::order::greedy::{LiveFaces, LiveVertex, Turn};

/// A FIFO cache that goes on from the real one. Only the stamps of the vertices change, and
/// [`undo`](Self::undo) restores them.
pub(super) struct TentativeCache<'a> {
    faces: &'a [[u32; 3]],
    vertices: &'a mut [LiveVertex],
    /// In vertices.
    size: u32,
    /// The number of the next push.
    clock: u32,
    overwritten: &'a mut Vec<Overwritten>,
}

/// A vertex, and the stamp that it had before a tentative push.
pub(super) type Overwritten = (u32, u32);

impl<'a> TentativeCache<'a> {
    /// A cache of `size` vertices at `clock`; `overwritten` is an empty buffer.
    #[inline]
    pub(super) fn new(
        live: &'a mut LiveFaces<'_>,
        size: u32,
        clock: u32,
        overwritten: &'a mut Vec<Overwritten>,
    ) -> Self {
        debug_assert!(overwritten.is_empty());
        Self {
            faces: live.faces,
            vertices: &mut live.vertices,
            size,
            clock,
            overwritten,
        }
    }

    /// Draws a face as the real traversal does, but without counts and announcements.
    #[inline]
    pub(super) fn draw<const KEEP_CORNERS: bool>(&mut self, face: u32) {
        let corners = self.faces[face as usize];
        let missing = corners.map(|corner| u32::from(self.is_missing(corner)));
        for corner in Turn::new::<KEEP_CORNERS>(missing).pushes(corners) {
            if self.is_missing(corner) {
                let entered = &mut self.vertices[corner as usize].entered;
                self.overwritten.push((corner, *entered));
                *entered = self.clock;
                self.clock = self.clock.wrapping_add(1);
            }
        }
    }

    #[inline]
    fn is_missing(&self, vertex: u32) -> bool {
        self.age(vertex) > self.size
    }

    /// Pushes since `vertex` entered, its own included.
    #[inline]
    pub(super) fn age(&self, vertex: u32) -> u32 {
        self.clock
            .wrapping_sub(self.vertices[vertex as usize].entered)
    }

    /// How many pushes the drawing took.
    #[inline]
    pub(super) fn pushes(&self) -> u32 {
        index32(self.overwritten.len())
    }

    /// Restores the stamps, the last one first: a vertex that was evicted and pushed again is there
    /// twice.
    #[inline]
    pub(super) fn undo(self) {
        while let Some((vertex, entered)) = self.overwritten.pop() {
            self.vertices[vertex as usize].entered = entered;
        }
    }
}
