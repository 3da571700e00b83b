//! The caches that a traversal models.
//!
//! Pushes into a cache are numbered, and a vertex knows the number of its last push. It is in the
//! cache if that is [`Cache::first`] or later: to evict the oldest or to end a batch, it is enough to
//! raise `first`. A controllable cache instead sets the number of an evicted vertex to 0.

use crate::index::index32;

/// Entries of the ring of pushed vertices. More than any window: those of candidates are asserted
/// in `State::new`, the longer ones (up to 236) by a test of `preset`.
pub(in crate::order::search) const RING: usize = 256;

/// What is modelled of a cache.
#[derive(Debug, Clone, Copy)]
pub(in crate::order::search) struct CacheLimits {
    /// Most vertices in it.
    pub(in crate::order::search) size: u32,
    /// Most faces in a batch; `u32::MAX` for no limit.
    pub(in crate::order::search) batch_faces: u32,
    /// Most vertices in a batch; `u32::MAX` for no limit.
    pub(in crate::order::search) batch_vertices: u32,
    /// Controllable: a finished vertex leaves at once, and to make room the one that costs most to
    /// finish. Otherwise the oldest leaves.
    pub(in crate::order::search) is_controllable: bool,
}

impl CacheLimits {
    /// First in, first out, without batches.
    pub(in crate::order::search) fn fifo(size: u32) -> Self {
        Self {
            size,
            batch_faces: u32::MAX,
            batch_vertices: u32::MAX,
            is_controllable: false,
        }
    }
}

/// The state of a cache, which is emptied where a batch ends.
#[derive(Clone)]
pub(in crate::order::search) struct Cache {
    pub(super) limits: CacheLimits,
    /// The number of the next push. Starts at [`RING`], so that a window fits before the first push
    /// and 0 can mean never.
    pub(super) pushes: u32,
    /// A vertex whose last push has a lower number is not in the cache.
    pub(super) first: u32,
    pub(super) faces_in_batch: u32,
    pub(super) pushes_in_batch: u32,
    /// How many faces across a border end the batch: it takes no more than these.
    pub(super) reserved: u32,
    /// Controllable: how many vertices are in it; those that the face being drawn finishes leave
    /// after it.
    pub(super) held: u32,
    /// How many vertices left it unfinished.
    pub(in crate::order::search) exits: u32,
    /// The vertex of each of the last pushes, by the push number modulo [`RING`].
    pub(super) ring: [u32; RING],
}

impl Cache {
    /// An empty cache; `nobody` is the number past the last vertex, which is on no face.
    pub(super) fn new(limits: CacheLimits, nobody: u32) -> Self {
        Self {
            limits,
            pushes: index32(RING),
            first: index32(RING),
            faces_in_batch: 0,
            pushes_in_batch: 0,
            reserved: 0,
            held: 0,
            exits: 0,
            ring: [nobody; RING],
        }
    }

    /// Whether another face, with `misses` misses, fits in the batch.
    #[inline]
    pub(super) fn has_room(&self, misses: u32) -> bool {
        self.faces_in_batch + self.reserved != self.limits.batch_faces
            && self.pushes_in_batch.saturating_add(misses) <= self.limits.batch_vertices
    }

    /// The vertex of a push, one of the last [`RING`].
    #[inline]
    pub(super) fn pushed(&self, number: u32) -> u32 {
        self.ring[number as usize % RING]
    }
}
