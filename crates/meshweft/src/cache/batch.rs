//! GPUs that gather faces in batches and forget all vertices between them.
//!
//! Kerbl, Kenzel, Ivanchenko, Schmalstieg, Steinberger: *Revisiting the vertex cache*, 2018,
//! doi:10.1145/3233302, measured that no vendor keeps one global cache. The three settings are
//! those of meshoptimizer's analyzer, so that figures can be compared with the many that were
//! made with it.

use super::MIN_CACHE_SIZE;
use super::fifo::Fifo;

/// A FIFO cache that is emptied whenever a batch is full.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BatchModel {
    cache_size: u32,
    batch_vertices: u32,
    batch_faces: u32,
}

impl BatchModel {
    /// 32 entries, 32 vertices, 32 faces.
    pub const NVIDIA: Self = Self::new(32, 32, 32);
    /// 14 entries, 64 vertices, 128 faces.
    pub const AMD: Self = Self::new(14, 64, 128);
    /// 128 entries, no batches.
    pub const INTEL: Self = Self::new(128, 0, 0);

    /// A FIFO cache of `cache_size` vertices, emptied before a face with which the batch would
    /// have more than `batch_vertices` misses or `batch_faces` faces; 0 for no limit.
    ///
    /// # Panics
    /// If the cache size or the limit of vertices is below 3: no face fits.
    #[must_use]
    pub const fn new(cache_size: u32, batch_vertices: u32, batch_faces: u32) -> Self {
        assert!(cache_size >= MIN_CACHE_SIZE, "a face needs three entries");
        assert!(
            batch_vertices == 0 || batch_vertices >= MIN_CACHE_SIZE,
            "a face needs three vertices in its batch"
        );
        Self {
            cache_size,
            batch_vertices,
            batch_faces,
        }
    }

    /// Entries of the FIFO cache inside a batch.
    #[must_use]
    pub const fn cache_size(&self) -> u32 {
        self.cache_size
    }

    /// Most vertices transformed in a batch; 0 for no limit.
    #[must_use]
    pub const fn batch_vertices(&self) -> u32 {
        self.batch_vertices
    }

    /// Most faces in a batch; 0 for no limit.
    #[must_use]
    pub const fn batch_faces(&self) -> u32 {
        self.batch_faces
    }
}

/// The replay of a [`BatchModel`].
#[derive(Debug, Clone)]
pub(super) struct Batches {
    model: BatchModel,
    cache: Fifo,
    vertices: u32,
    faces: u32,
}

impl Batches {
    pub(super) fn new(model: BatchModel, vertex_count: usize) -> Self {
        Self {
            model,
            cache: Fifo::new(model.cache_size, vertex_count),
            vertices: 0,
            faces: 0,
        }
    }

    /// Draws a face; how many of its corners missed.
    ///
    /// Whether the face still fits is decided from the state before it, corner by corner, so a
    /// vertex that a degenerate face names twice counts twice for that decision.
    pub(super) fn draw(&mut self, face: [u32; 3]) -> u8 {
        let absent = |&&v: &&u32| !self.cache.contains(v);
        let needed: u32 = face.iter().filter(absent).map(|_| 1).sum();
        let BatchModel {
            batch_vertices,
            batch_faces,
            ..
        } = self.model;
        let faces_full = batch_faces != 0 && self.faces == batch_faces;
        let vertices_full = batch_vertices != 0 && self.vertices + needed > batch_vertices;
        if faces_full || vertices_full {
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
