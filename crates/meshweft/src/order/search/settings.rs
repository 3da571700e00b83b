//! What a search is told: which caches are modelled, how costs and scores are weighed, how far it
//! looks ahead.

use super::state::{CacheLimits, WINDOWS};

/// All that a search is told.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settings {
    /// The cache that corners are turned for and candidates come from.
    pub(super) first: CacheLimits,
    /// One beside it.
    pub(super) second: Option<CacheLimits>,
    /// How many of the last pushes into the first cache are candidates.
    pub(super) window: u32,
    pub(super) windows: [u32; WINDOWS],
    pub(super) weights: Weights,
    pub(super) score: Score,
    pub(super) horizon: Horizon,
}

/// Weights of a candidate's cost, in 1024ths of a push.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    /// A vertex that is missing from each cache.
    pub(super) missing: [i64; 2],
    /// A face drawn; the more, the cheaper.
    pub(super) live: i64,
    /// A push since it entered the first cache; the more, the cheaper.
    pub(super) age: i64,
    /// Leaving the first cache before it is finished.
    pub(super) late: i64,
    /// Having left the first cache.
    pub(super) outside: i64,
    /// A push since it entered the first cache, if it has left it.
    pub(super) outside_age: i64,
}

/// What a continuation is judged by, in 1024ths of an eviction; less is better.
#[derive(Debug, Clone, Copy)]
pub(super) struct Score {
    /// A vertex that leaves each cache unfinished.
    pub(super) exits: [i64; 2],
    /// A vertex that leaves a longer window unfinished.
    pub(super) windows: [i64; WINDOWS],
    /// A face drawn.
    pub(super) face: i64,
    /// A push since each vertex entered that is a candidate in the end.
    pub(super) age: i64,
}

/// How far and how often to look ahead.
#[derive(Debug, Clone, Copy)]
pub(super) struct Horizon {
    /// Continuations.
    pub(super) runs: usize,
    /// Vertices finished in each.
    pub(super) steps: usize,
    /// Vertices of the best that are finished for good.
    pub(super) commit: usize,
    /// Most candidates looked at, the oldest first.
    pub(super) candidates: u32,
    /// Span of the noise on a candidate's cost, in 1024ths of a push.
    pub(super) noise: i64,
    /// A run that is this much behind the best after `patience` steps or more is given up.
    pub(super) margin: i64,
    pub(super) patience: usize,
}
