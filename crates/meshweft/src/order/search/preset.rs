//! The settings of each target and effort, and every weight that was tuned.
//!
//! Tuned by random search on meshes that are not in the README's tables: cow, spot, a 20,000-face
//! horse, small versions of dragon and bunny, lion_statue, maneki_neko, mannequin, teapot_65k. The
//! program and the seeds that the present numbers come from were not kept. To search again:
//!
//! ```text
//! cd compare && cargo run --release --bin tune -- --target universal --effort best --rounds 200 --seed 1
//! ```
//!
//! It starts from the numbers below, on the five small meshes (`--all`: on all). Each round changes each
//! number, but the margin, with a chance of one in four, by a factor from 1/1.3 to 1.3, within a
//! quarter and four times the start. It keeps what misses less in the mean over the target's caches,
//! the meshes and two seeds of the search, on condition that no cache loses to meshoptimizer's order
//! on any mesh. Weights are kept in 1024ths ([`fixed`]): the fourth digit means little.
//!
//! Before a new number goes in, compare the misses of other meshes before and after, in every cache of
//! the target (`--bin search`): few meshes are soon tuned to by heart.
//!
//! Weights are in pushes, scores in evictions (`settings` has the terms); [`fixed`] makes integers.

use super::settings::{Horizon, Score, Settings, Weights};
use super::state::{CacheLimits, WINDOWS};
use crate::cache::{BatchModel, CacheModel};
use crate::order::in_batches::BESIDE_SIZE;
use crate::order::target::{Effort, Target};

/// The largest cache that is modelled.
pub(super) const MAX_SIZE: u32 = 128;

/// The FIFO cache to order for where the least recently used vertex leaves first: 5/8 of its size,
/// rounded down.
pub(in crate::order) fn lru_as_fifo(size: u32) -> u32 {
    (size / 8 * 5 + size % 8 * 5 / 8).max(3)
}

/// The settings for a target at an effort.
pub(super) fn preset(target: Target, effort: Effort) -> Settings {
    match target {
        Target::Universal => universal(effort),
        Target::Cache(model) => match model {
            CacheModel::Fifo { size } => fifo(size, effort),
            CacheModel::Lru { size } => fifo(lru_as_fifo(size), effort),
            CacheModel::Controllable { size } => controllable(size, effort),
            CacheModel::Batch(batch) if batch.batch_vertices() == 0 && batch.batch_faces() == 0 => {
                fifo(batch.cache_size(), effort)
            }
            CacheModel::Batch(batch) => batches(batch, effort),
            // Which faces share a batch. Where they stand in it is left to the pass inside batches.
            CacheModel::Nvidia => batches(BatchModel::MESHOPT_NVIDIA, effort),
        },
    }
}

/// The value in 1024ths, rounded towards 0.
const fn fixed(value: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "constants of a few units")]
    {
        (value * 1024.0) as i64
    }
}

/// How far to look ahead for one cache: continuations of `steps` vertices, each chosen among the
/// oldest `candidates`. Effort `fast` has one in a round: it is greedy and does not look ahead.
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
        good_enough: i64::MIN,
        patience: steps as usize / 2,
    }
}

/// Stand for windows with one cache: their exits are counted with two caches only.
const NO_WINDOWS: [u32; WINDOWS] = [32, 64, 128];

/// One FIFO cache of `size` vertices.
fn fifo(size: u32, effort: Effort) -> Settings {
    let size = size.clamp(3, MAX_SIZE);
    let is_small = size < 24;
    let age = fixed(1.3) / i64::from(size);
    // The larger the cache, the later a bad choice shows.
    let steps = (40 + size.saturating_sub(12) * 11 / 2).min(200);

    Settings {
        first: CacheLimits::fifo(size),
        second: None,
        window: size,
        windows: NO_WINDOWS,
        weights: Weights {
            // A push also ages the candidate.
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
            ..match (effort, is_small) {
                (Effort::Best, true) => Horizon {
                    runs: 8,
                    commit: steps as usize / 4,
                    ..horizon(effort, steps, 9)
                },
                (Effort::Best, false) => Horizon {
                    runs: 10,
                    margin: fixed(1.5),
                    ..horizon(effort, steps, 8)
                },
                (_, true) => horizon(effort, steps, 9),
                (_, false) => horizon(effort, steps, 14),
            }
        },
    }
}

/// As [`fifo`], but age does not count, and the window is longer than the cache: a vertex may stay
/// while others come and go. So the cache is at most half as long as the longest window.
fn controllable(size: u32, effort: Effort) -> Settings {
    let size = size.clamp(3, MAX_SIZE / 2);
    Settings {
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

/// A FIFO cache that is emptied at the end of each batch.
fn batches(batch: BatchModel, effort: Effort) -> Settings {
    let unlimited = |limit: u32| if limit == 0 { u32::MAX } else { limit };
    let limits = CacheLimits {
        batch_faces: unlimited(batch.batch_faces()),
        batch_vertices: unlimited(batch.batch_vertices()),
        ..CacheLimits::fifo(batch.cache_size().clamp(3, MAX_SIZE))
    };
    let base = fifo(limits.size, effort);

    // A cache smaller than a batch: evictions during a batch matter more than those at its end.
    let most_pushes = limits
        .batch_vertices
        .min(limits.batch_faces.saturating_mul(3));
    if limits.size < most_pushes {
        return Settings {
            first: limits,
            score: Score {
                face: fixed(0.2),
                ..base.score
            },
            horizon: horizon(effort, 50, 9),
            ..base
        };
    }

    // A cache that holds a whole batch: vertices leave it only at the end of the batch.
    let (window, weights, score, horizon) = match effort {
        Effort::Fast => (
            48,
            Weights {
                missing: [fixed(1.0), 0],
                live: fixed(0.202),
                age: fixed(-0.021),
                late: fixed(0.291),
                outside: fixed(0.607),
                outside_age: fixed(-0.0056),
            },
            Score {
                exits: [fixed(1.0), 0],
                windows: [0; WINDOWS],
                face: fixed(0.156),
                age: fixed(-0.0143),
            },
            Horizon {
                runs: 3,
                commit: 16,
                ..horizon(effort, 32, 60)
            },
        ),
        // More continuations gain little: four times as many .5 %.
        _ => (
            26,
            Weights {
                missing: [fixed(0.7764), 0],
                live: fixed(0.1885),
                age: fixed(-0.0049),
                late: fixed(-0.669),
                outside: fixed(0.3936),
                outside_age: fixed(-0.0899),
            },
            Score {
                exits: [fixed(0.9239), 0],
                windows: [0; WINDOWS],
                face: fixed(0.1358),
                age: 0,
            },
            Horizon {
                runs: if effort == Effort::Best { 10 } else { 64 },
                commit: if effort == Effort::Best { 7 } else { 6 },
                ..horizon(effort, 35, 60)
            },
        ),
    };
    Settings {
        first: limits,
        window,
        weights,
        score,
        horizon: Horizon {
            noise: if effort == Effort::Fast {
                fixed(0.913)
            } else {
                fixed(0.69)
            },
            ..horizon
        },
        ..base
    }
}

/// A FIFO cache of 10 and a batch of 32; the longer windows stand for larger caches.
///
/// The weights of each effort were searched for the least mean over FIFO caches of 10 to 64, on
/// condition that no cache or GPU loses to meshoptimizer's order. That is hard for large caches, of
/// 64 and of Intel's 128 entries: they need compact growth, small caches need long strips. Some were then
/// moved for the least cost over 51 of the public meshes, where an order that is above the floor in any model
/// counts as the floor: a heavier price for what is missing (from .8917 at `best`, from 1.0383 at `fast`) brings more
/// meshes below the floor than all else.
fn universal(effort: Effort) -> Settings {
    // Tuned separately for one pass and for a search. Of the search, comments say how far each number
    // alone may move before the mean grows by .001 (`tune --rounds 0`, at effort `best`); `≤` and `≥`:
    // nothing beyond was tried. The mean of one seed deviates by .0004.
    let (window, windows, weights, score, horizon) = match effort {
        Effort::Fast => (
            14,
            [17, 79, 220],
            Weights {
                missing: [fixed(1.376), fixed(1.0671)],
                live: fixed(0.0793),
                age: fixed(0.2706),
                late: fixed(1.561),
                outside: fixed(-1.3606),
                outside_age: fixed(0.034),
            },
            Score {
                exits: [fixed(0.1956), fixed(0.016)],
                windows: [fixed(0.3142), fixed(0.1202), fixed(0.012)],
                face: fixed(0.0343),
                age: fixed(0.016),
            },
            Horizon {
                runs: 3,
                steps: 24,
                commit: 24,
                candidates: 12,
                noise: fixed(1.3579),
                margin: fixed(0.35),
                good_enough: fixed(3.9),
                patience: 8,
            },
        ),
        _ => (
            13,            // 9 to 13
            [33, 66, 236], // 11 to ≥ 132, 39 to ≥ 255, ≤ 59 to ≥ 255
            Weights {
                missing: [fixed(0.8144), fixed(1.169)], // .678 to 1.63; the second is dear
                live: fixed(0.0482),                    // ≤ .012 to ≥ .19
                age: fixed(0.2706),                     // .246 to .54
                late: fixed(1.9991),                    // 1 to ≥ 8
                outside: fixed(-1.3606),                // -1.5 to ≥ -.34
                outside_age: fixed(0.0668),             // ≤ .017 to .08
            },
            Score {
                exits: [fixed(0.13), fixed(0.0255)], // .084 to ≥ .57, ≤ .007 to ≥ .1
                // ≤ .078 to .376, ≤ .036 to .43, ≤ .008 to ≥ .12
                windows: [fixed(0.3142), fixed(0.1432), fixed(0.03)],
                face: fixed(0.0255), // ≤ .007 to ≥ .1
                age: fixed(0.016),   // ≤ .004 to .047
            },
            Horizon {
                runs: if effort == Effort::Best { 10 } else { 64 },
                steps: 36,
                commit: 12,
                candidates: 12,
                noise: fixed(1.3579), // 1.13 to 1.9
                margin: fixed(0.377), // .27 to ≥ 1.5
                good_enough: match effort {
                    Effort::Best => fixed(2.9),
                    _ => i64::MIN,
                },
                patience: 12,
            },
        ),
    };

    Settings {
        first: CacheLimits::fifo(BESIDE_SIZE),
        second: Some(CacheLimits {
            batch_faces: 32,
            batch_vertices: 32,
            ..CacheLimits::fifo(32)
        }),
        window,
        windows,
        weights,
        score,
        horizon,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::order::search::state::RING;

    #[test]
    fn every_window_fits_in_the_ring_of_pushes() {
        let targets = [
            "universal",
            "nvidia",
            "amd",
            "intel",
            "fifo:1024",
            "controllable:200",
        ];
        for target in targets.map(|name| name.parse::<Target>().unwrap()) {
            for effort in [Effort::Fast, Effort::Best, Effort::Max] {
                let settings = preset(target, effort);
                assert!(settings.window <= MAX_SIZE, "{target}");
                assert!(
                    settings
                        .windows
                        .iter()
                        .all(|&window| (window as usize) < RING)
                );
            }
        }
    }
}
