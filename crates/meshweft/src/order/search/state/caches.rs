//! The caches that a traversal models.

use crate::index::index32;

/// Entries of a ring of pushed vertices; more than any window.
pub(super) const RING: usize = 256;

/// What is modelled of a cache.
#[derive(Debug, Clone, Copy)]
pub(in crate::order::search) struct CacheLimits {
    /// Most vertices in it.
    pub(in crate::order::search) size: u32,
    /// Most faces in a batch; `u32::MAX` for no limit.
    pub(in crate::order::search) batch_faces: u32,
    /// Most vertices in a batch; `u32::MAX` for no limit.
    pub(in crate::order::search) batch_vertices: u32,
    /// Controllable: a finished vertex leaves at once, and the one that is dearest to finish makes
    /// room. Otherwise the oldest leaves.
    pub(in crate::order::search) is_controllable: bool,
}

impl CacheLimits {
    pub(in crate::order::search) fn fifo(size: u32) -> Self {
        Self {
            size,
            batch_faces: u32::MAX,
            batch_vertices: u32::MAX,
            is_controllable: false,
        }
    }
}

/// A cache, emptied where a batch ends.
#[derive(Clone)]
pub(in crate::order::search) struct Cache {
    pub(super) limits: CacheLimits,
    /// Number of the next push.
    pub(super) pushes: u32,
    /// A vertex whose last push has a lower number is not in the cache.
    pub(super) first: u32,
    /// Faces of the batch.
    pub(super) faces: u32,
    /// Vertices of the batch.
    pub(super) vertices: u32,
    /// Controllable: unfinished vertices in it, and those that the face being drawn finishes.
    pub(super) held: u32,
    /// Vertices that left it unfinished.
    pub(in crate::order::search) exits: u32,
    /// The vertex of each of the last pushes.
    pub(super) ring: [u32; RING],
}

impl Cache {
    pub(super) fn new(limits: CacheLimits, nobody: u32) -> Self {
        Self {
            limits,
            pushes: index32(RING),
            first: index32(RING),
            faces: 0,
            vertices: 0,
            held: 0,
            exits: 0,
            ring: [nobody; RING],
        }
    }

    /// Whether a face with so many misses does not fit in the batch.
    #[inline]
    pub(super) fn is_full(&self, misses: u32) -> bool {
        self.faces == self.limits.batch_faces
            || self.vertices.saturating_add(misses) > self.limits.batch_vertices
    }

    /// The vertex of a push, one of the last [`RING`].
    #[inline]
    pub(super) fn pushed(&self, number: u32) -> u32 {
        self.ring[number as usize % RING]
    }
}
