//! Walks, of either renderer: each path once for a tolerance, drawn by every policy.

use meshweft::operations::{EvictionPolicy, WalkFrame, WalkQuantity};

/// The paper's policies and the library's own.
pub(super) const POLICIES: [EvictionPolicy; 5] = EvictionPolicy::ALL;
/// What they are called in a column.
pub(super) const NAMES: [&str; 5] = ["vertex array", "FA", "LRU", "LRU+queue", "finest"];

/// How much faster the paper found the rendering stage with each policy.
pub(super) type Faster = [Option<f64>; 5];

/// A mesh or a terrain with all its walks.
pub(super) struct Walked {
    /// With a star if it is like one of the paper's.
    pub(super) name: String,
    /// The name of its file without endings.
    pub(super) stem: String,
    pub(super) walks: Vec<PathWalk>,
}

/// A path with a tolerance, drawn by every policy.
pub(super) struct PathWalk {
    pub(super) tolerance: f64,
    /// The paper's for the path, or the next one.
    pub(super) letter: &'static str,
    pub(super) faster: Faster,
    /// How many frames need more vertices than there are slots.
    pub(super) overfull: usize,
    pub(super) most_active: usize,
    pub(super) distinct: usize,
    /// The fewest inserts that are possible; `None` if a frame has more vertices than there are slots.
    pub(super) fewest: Option<u64>,
    pub(super) slots: usize,
    pub(super) vertex_size: usize,
    /// Of each of [`POLICIES`].
    pub(super) frames: Vec<Vec<WalkFrame>>,
}

impl PathWalk {
    /// The inserts of each policy.
    pub(super) fn inserts(&self) -> Vec<u64> {
        let inserts = |frames: &Vec<WalkFrame>| {
            let inserts = frames.iter().map(|frame| frame.inserts as u64);
            inserts.sum()
        };
        self.frames.iter().map(inserts).collect()
    }

    /// The mean of a quantity over the frames, of each policy.
    pub(super) fn means(&self, of: impl Fn(&WalkFrame) -> f64) -> Vec<f64> {
        let mean = |frames: &Vec<WalkFrame>| {
            let sum: f64 = frames.iter().map(&of).sum();
            sum / frames.len().max(1) as f64
        };
        self.frames.iter().map(mean).collect()
    }
}

/// Milliseconds of the stage that the paper calls "build IVA".
pub(super) fn build_milliseconds(frame: &WalkFrame) -> f64 {
    frame.cache_milliseconds + frame.index_milliseconds
}

/// Bytes that are sent.
pub(super) fn bytes(frame: &WalkFrame) -> f64 {
    WalkQuantity::VertexBytes.of(frame) + WalkQuantity::IndexBytes.of(frame)
}
