//! Which caches each target models, and every weight that was tuned.
//!
//! Tuned on cow, spot, a 20,000-face horse, a small dragon and a small bunny by random search; the
//! meshes that tables are made of were held out, or are larger relatives of these.

use super::rollout::{Horizon, Score, Weights};
use super::state::{CacheLimits, WINDOWS};
use super::{Effort, Target};
use crate::cache::{BatchModel, CacheModel};

/// The largest cache that is modelled.
pub(super) const MAX_SIZE: u32 = 128;

/// All that a search is told.
#[derive(Debug, Clone, Copy)]
pub(super) struct Preset {
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

/// The FIFO cache to order for where the least recently used vertex leaves first.
pub(super) fn lru_as_fifo(size: u32) -> u32 {
    (size / 8 * 5 + size % 8 * 5 / 8).max(3)
}

pub(super) fn preset(target: Target, effort: Effort) -> Preset {
    match target {
        Target::Universal => universal(effort),
        Target::Cache(model) => match model {
            CacheModel::Fifo { size } => fifo(size, effort),
            CacheModel::Lru { size } => fifo(lru_as_fifo(size), effort),
            CacheModel::Controllable { size } => controllable(size, effort),
            CacheModel::Batch(batch) if batch.batch_vertices == 0 && batch.batch_faces == 0 => {
                fifo(batch.cache_size, effort)
            }
            CacheModel::Batch(batch) => batches(batch, effort),
        },
    }
}

/// 1024ths.
const fn fixed(value: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "constants of a few units")]
    {
        (value * 1024.0) as i64
    }
}

fn horizon(effort: Effort, steps: u32, candidates: u32) -> Horizon {
    let (runs, commit) = match effort {
        Effort::Fast => (1, 1),
        Effort::Best => (10, steps * 3 / 10),
        Effort::Max => (128, steps / 5),
    };
    Horizon {
        runs,
        steps: steps as usize,
        commit: commit as usize,
        candidates,
        noise: fixed(0.5),
        margin: fixed(1.0),
    }
}

const NO_WINDOWS: [u32; WINDOWS] = [32, 64, 128];

fn fifo(size: u32, effort: Effort) -> Preset {
    let size = size.clamp(3, MAX_SIZE);
    let is_small = size < 24;
    let age = fixed(1.3) / i64::from(size);
    let steps = (40 + size.saturating_sub(12) * 11 / 2).min(200);
    Preset {
        first: CacheLimits::fifo(size),
        second: None,
        window: size,
        windows: NO_WINDOWS,
        weights: Weights {
            // A push ages the candidate, too.
            missing: [fixed(1.0) - age, 0],
            live: fixed(0.5),
            age,
            late: fixed(2.0),
            outside: 0,
            outside_age: 0,
        },
        score: Score {
            exits: [fixed(1.0), 0],
            windows: [0; WINDOWS],
            face: fixed(if is_small { 0.11 } else { 0.08 }),
            age: fixed(0.2) / i64::from(size),
        },
        horizon: Horizon {
            noise: fixed(if is_small { 0.5 } else { 0.7 }),
            ..horizon(effort, steps, if is_small { 9 } else { 14 })
        },
    }
}

fn controllable(size: u32, effort: Effort) -> Preset {
    let size = size.clamp(3, MAX_SIZE / 2);
    Preset {
        first: CacheLimits {
            is_controllable: true,
            ..CacheLimits::fifo(size)
        },
        second: None,
        window: if size <= 16 { 64 } else { MAX_SIZE },
        weights: Weights {
            missing: [fixed(1.0), 0],
            live: fixed(0.5),
            age: 0,
            late: 0,
            outside: 0,
            outside_age: 0,
        },
        ..fifo(size, effort)
    }
}

fn batches(batch: BatchModel, effort: Effort) -> Preset {
    let unlimited = |limit: u32| if limit == 0 { u32::MAX } else { limit };
    let limits = CacheLimits {
        batch_faces: unlimited(batch.batch_faces),
        batch_vertices: unlimited(batch.batch_vertices),
        ..CacheLimits::fifo(batch.cache_size.clamp(3, MAX_SIZE))
    };
    let base = fifo(limits.size, effort);
    let most_pushes = limits
        .batch_vertices
        .min(limits.batch_faces.saturating_mul(3));
    if limits.size < most_pushes {
        // What leaves during a batch matters more than what its end takes.
        return Preset {
            first: limits,
            score: Score {
                face: fixed(0.2),
                ..base.score
            },
            horizon: horizon(effort, 50, 9),
            ..base
        };
    }
    let is_fast = effort == Effort::Fast;
    let horizon = horizon(effort, 50, 60);
    Preset {
        first: limits,
        window: if is_fast { 48 } else { 32 },
        weights: Weights {
            missing: [fixed(1.0), 0],
            live: fixed(if is_fast { 0.202 } else { 0.146 }),
            age: fixed(if is_fast { -0.021 } else { -0.0057 }),
            late: fixed(if is_fast { 0.291 } else { -0.694 }),
            outside: fixed(if is_fast { 0.607 } else { 0.436 }),
            outside_age: fixed(if is_fast { -0.0056 } else { -0.0821 }),
        },
        score: Score {
            exits: [fixed(1.0), 0],
            windows: [0; WINDOWS],
            face: fixed(0.156),
            age: fixed(-0.0143),
        },
        horizon: Horizon {
            noise: fixed(0.913),
            runs: horizon.runs.div_ceil(2),
            ..horizon
        },
        ..base
    }
}

fn universal(effort: Effort) -> Preset {
    let is_fast = effort == Effort::Fast;
    let horizon = horizon(effort, 40, if is_fast { 40 } else { 24 });
    let weights = match effort {
        Effort::Fast => Weights {
            missing: [fixed(1.2282), fixed(0.4928)],
            live: fixed(0.223),
            age: fixed(0.2036),
            late: fixed(0.9687),
            outside: fixed(-1.6146),
            outside_age: fixed(-0.0239),
        },
        _ => Weights {
            missing: [fixed(1.0), fixed(0.6089)],
            live: fixed(0.058),
            age: fixed(0.3394),
            late: fixed(2.2291),
            outside: fixed(-0.925),
            outside_age: fixed(0.0708),
        },
    };
    Preset {
        first: CacheLimits::fifo(10),
        second: Some(CacheLimits {
            batch_faces: 32,
            batch_vertices: 32,
            ..CacheLimits::fifo(32)
        }),
        window: if is_fast { 16 } else { 12 },
        windows: [23, 75, 200],
        weights,
        score: Score {
            exits: [fixed(0.195), fixed(0.02)],
            windows: [fixed(0.25), fixed(0.1159), fixed(0.021)],
            face: fixed(0.05),
            age: fixed(0.0123),
        },
        horizon: Horizon {
            noise: fixed(1.177),
            runs: (horizon.runs * 2).div_ceil(5),
            ..horizon
        },
    }
}
