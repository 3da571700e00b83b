//! What a frame sends to the graphics card.

use std::ops::Range;

use super::slot_ranges::SlotRanges;

/// A vertex that is written to a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Insert {
    /// The slot.
    pub slot: u32,
    /// The vertex that it has from now on.
    pub vertex: u32,
}

/// How the active vertices of a frame are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum FrameMode {
    /// All of them are in slots.
    #[default]
    Cached,
    /// All of them are sent, to a vertex array beside the slots, in the order of the inserts: nothing is cached, or
    /// there are more than slots.
    Streamed,
    /// There are more than slots, and they are drawn by [`GeometryCache::passes`](super::GeometryCache::passes).
    Passes,
}

/// What one frame, or one pass of it, sends.
#[derive(Debug, Clone, Default)]
pub struct Upload {
    pub(super) mode: FrameMode,
    pub(super) inserts: Vec<Insert>,
    pub(super) ranges: SlotRanges,
    pub(super) statistics: FrameStatistics,
}

/// The counts of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FrameStatistics {
    /// Active vertices.
    pub active: usize,
    /// Vertices that became active.
    pub added: usize,
    /// Vertices that became inactive.
    pub removed: usize,
    /// Vertices that are uploaded.
    pub inserts: usize,
    /// Ranges of slots that hold these.
    pub ranges: usize,
    /// Slots in the ranges: more than the inserts only where a gap is allowed.
    pub sent: usize,
    /// How often a policy named a slot that was not open, and the first open one was taken.
    pub overruled: usize,
}

impl FrameStatistics {
    /// How many bytes the ranges have, with vertices of this size.
    #[must_use]
    pub fn bytes(&self, vertex_size: usize) -> u64 {
        self.sent as u64 * vertex_size as u64
    }
}

impl Upload {
    /// How the active vertices are drawn.
    #[must_use]
    pub fn mode(&self) -> FrameMode {
        self.mode
    }

    /// Which vertex goes to which slot, by rising slots.
    #[must_use]
    pub fn inserts(&self) -> &[Insert] {
        &self.inserts
    }

    /// The slots to write, as few ranges, rising and apart.
    #[must_use]
    pub fn ranges(&self) -> &[Range<u32>] {
        self.ranges.as_slice()
    }

    /// The counts.
    #[must_use]
    pub fn statistics(&self) -> FrameStatistics {
        self.statistics
    }

    pub(super) fn restart(&mut self, mode: FrameMode) {
        self.mode = mode;
        self.inserts.clear();
        self.statistics = FrameStatistics::default();
    }

    /// Sorts the inserts and joins their slots.
    pub(super) fn finish(&mut self) {
        self.inserts.sort_unstable();
        let slots = self.inserts.iter().map(|insert| insert.slot);
        self.ranges.replace(slots);
        self.statistics.inserts = self.inserts.len();
        self.statistics.ranges = self.ranges.as_slice().len();
        self.statistics.sent = self.ranges.count();
    }
}
