//! GPUs that collect faces in batches and forget all vertices between batches.
//!
//! Kerbl, Kenzel, Ivanchenko, Schmalstieg, Steinberger: *Revisiting the vertex cache*, 2018,
//! doi:10.1145/3233302, measured that no vendor keeps one global cache. The three settings are
//! those of meshoptimizer's analyzer, so that figures can be compared with those made by it.

use super::fifo::Fifo;
use super::model::BatchModel;

/// The replay of a [`BatchModel`].
#[derive(Debug, Clone)]
pub(crate) struct Batches {
    model: BatchModel,
    cache: Fifo,
    /// Misses in the current batch.
    vertices: u32,
    /// Faces in the current batch.
    faces: u32,
}

impl Batches {
    pub(super) fn new(model: BatchModel, vertex_count: usize) -> Self {
        Self {
            model,
            cache: Fifo::new(model.cache_size(), vertex_count),
            vertices: 0,
            faces: 0,
        }
    }

    /// Which corners of a face miss if it is drawn next.
    ///
    /// Whether the face fits is decided from the state before it, corner by corner. So a vertex
    /// that a degenerate face names twice counts twice in that decision.
    pub(super) fn missing(&self, face: [u32; 3]) -> [bool; 3] {
        let missing = face.map(|v| !self.cache.contains(v));
        match self.is_full(missing.map(u32::from).iter().sum()) {
            true => [true; 3],
            false => missing,
        }
    }

    /// Whether a face with `misses` misses starts a new batch.
    fn is_full(&self, misses: u32) -> bool {
        let (batch_vertices, batch_faces) = (self.model.batch_vertices(), self.model.batch_faces());
        let faces_full = batch_faces != 0 && self.faces == batch_faces;
        let vertices_full = batch_vertices != 0 && self.vertices + misses > batch_vertices;
        faces_full || vertices_full
    }

    /// Draws a face; returns how many of its corners missed.
    pub(super) fn draw(&mut self, face: [u32; 3]) -> u8 {
        let absent = |&&v: &&u32| !self.cache.contains(v);
        let needed: u32 = face.iter().filter(absent).map(|_| 1).sum();
        if self.is_full(needed) {
            self.cache.clear();
            self.vertices = 0;
            self.faces = 0;
        }
        let missed = face.map(|v| u8::from(self.cache.miss(v))).iter().sum();
        self.vertices = self.vertices.saturating_add(u32::from(missed));
        self.faces = self.faces.saturating_add(1);
        missed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_batch_forgets_its_vertices() {
        let model = BatchModel::new(8, 0, 2);
        let mut batches = Batches::new(model, 4);
        let strip = [[0, 1, 2], [2, 1, 3], [2, 1, 3]];
        assert_eq!(strip.map(|face| batches.draw(face)), [3, 1, 3]);
    }

    #[test]
    fn a_face_that_does_not_fit_starts_a_batch() {
        let model = BatchModel::new(8, 4, 0);
        let mut batches = Batches::new(model, 5);
        let strip = [[0, 1, 2], [2, 1, 3], [2, 3, 4]];
        assert_eq!(strip.map(|face| batches.draw(face)), [3, 1, 3]);
    }
}
