//! The settings of a search: which caches are modelled, how costs and scores are weighed, how far
//! it looks ahead.

use super::state::{CacheLimits, WINDOWS};

/// All settings of a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settings {
    /// The cache that corners are turned for and candidates come from.
    pub(super) first: CacheLimits,
    /// Another cache that is modelled at the same time.
    pub(super) second: Option<CacheLimits>,
    /// How many of the last pushes into the first cache are candidates.
    pub(super) window: u32,
    /// Lengths of longer windows, in pushes into the first cache; used with two caches only.
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
    /// A face drawn; subtracted.
    pub(super) live: i64,
    /// A push since it entered the first cache; subtracted.
    pub(super) age: i64,
    /// Leaving the first cache before it is finished.
    pub(super) late: i64,
    /// Being outside the first cache.
    pub(super) outside: i64,
    /// A push since it entered the first cache, if it is outside; subtracted.
    pub(super) outside_age: i64,
}

/// Weights of a continuation's score, in 1024ths of an eviction; less is better.
#[derive(Debug, Clone, Copy)]
pub(super) struct Score {
    /// A vertex that leaves each cache unfinished.
    pub(super) exits: [i64; 2],
    /// A vertex that leaves a longer window unfinished.
    pub(super) windows: [i64; WINDOWS],
    /// A face drawn; subtracted.
    pub(super) face: i64,
    /// Weight of the age, in pushes, of each final candidate.
    pub(super) age: i64,
}

/// How far and how often to look ahead.
#[derive(Debug, Clone, Copy)]
pub(super) struct Horizon {
    /// Continuations in each round; 1: greedy.
    pub(super) runs: usize,
    /// Vertices finished in each continuation.
    pub(super) steps: usize,
    /// Vertices of the best continuation that are committed.
    pub(super) commit: usize,
    /// Most candidates compared for a focus, the oldest first.
    pub(super) candidates: u32,
    /// Span of the noise on a candidate's cost, in 1024ths of a push.
    pub(super) noise: i64,
    /// A continuation is given up if its score is worse than the best one's by more than this, in
    /// 1024ths of an eviction.
    pub(super) margin: i64,
    /// A continuation whose score is at most this, in 1024ths of an eviction, ends its round.
    pub(super) good_enough: i64,
    /// The last step of a continuation, from 0, in which it is not given up yet.
    pub(super) patience: usize,
}
