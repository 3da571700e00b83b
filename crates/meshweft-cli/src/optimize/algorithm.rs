//! What orders the faces: chosen by the flags, checked before any file is touched.

use std::time::{Duration, Instant};

use meshweft::cache::Schedule;
use meshweft::order::{self, KCacheReorder, Optimizer, Target};
use meshweft::{Budget, CacheModel, FaceOrder, Mesh, Progress};

use super::arguments::{Effort, Mode, Optimize};
use crate::usage::Usage;

/// The largest cache that orders are made for here.
const MAX_SIZE: u32 = 1024;

/// A way to order faces.
#[derive(Debug, Clone)]
pub(super) struct Algorithm {
    optimizer: Optimizer,
    /// How long to search, whatever the effort.
    time_budget: Option<Duration>,
    /// Instead of the optimizer, with what it does not have: the paper's plain reading, weights.
    greedy: Option<KCacheReorder>,
}

impl Algorithm {
    /// The one that the flags ask for.
    pub(super) fn of(arguments: &Optimize) -> Result<Self, Usage> {
        check_size(arguments.cache)?;
        let effort = match arguments.effort {
            Effort::Fast => order::Effort::Fast,
            Effort::Best => order::Effort::Best,
            Effort::Max => order::Effort::Max,
        };
        let optimizer = Optimizer {
            target: arguments.cache,
            effort,
            seed: arguments.seed,
            keep_corners: arguments.keep_corners,
            budget: Budget::Unlimited,
        };
        let time_budget = arguments.time_budget.map(|budget| budget.0);
        let is_faithful = arguments.mode == Mode::Faithful;
        let weights = [arguments.k1, arguments.k2, arguments.k3];
        if !is_faithful && weights == [None; 3] {
            return Ok(Self {
                optimizer,
                time_budget,
                greedy: None,
            });
        }

        // The greedy has them, but neither other caches nor efforts.
        let flag = match is_faithful {
            true => "--mode faithful",
            false => "a weight (--k1, --k2, --k3)",
        };
        let cache = match arguments.cache {
            Target::Cache(cache @ (CacheModel::Fifo { .. } | CacheModel::Controllable { .. })) => {
                cache
            }
            other => {
                return Err(Usage(format!(
                    "{flag} is for --cache fifo:K and controllable:K, not for {other}"
                )));
            }
        };
        if effort != order::Effort::Fast || arguments.time_budget.is_some() {
            return Err(Usage(format!(
                "{flag} is for the greedy: leave out --effort and --time-budget"
            )));
        }

        let usual = KCacheReorder::default();
        let [k1, k2, k3] = weights;
        let greedy = KCacheReorder {
            cache,
            mode: match arguments.mode {
                Mode::Fast => order::Mode::Fast,
                Mode::Faithful => order::Mode::Faithful,
            },
            k1: k1.unwrap_or(usual.k1),
            k2: k2.unwrap_or(usual.k2),
            k3: k3.unwrap_or(usual.k3),
            keep_corners: arguments.keep_corners,
            first_focus: None,
        };
        Ok(Self {
            optimizer,
            time_budget,
            greedy: Some(greedy),
        })
    }

    /// What the order is to be good for.
    pub(super) fn target(&self) -> Target {
        self.optimizer.target
    }

    /// Whether to run exactly once, without the rounds of improvement.
    pub(super) fn runs_once(&self) -> bool {
        let mode = self.greedy.as_ref().map(|greedy| greedy.mode);
        mode == Some(order::Mode::Faithful) || self.time_budget.is_some()
    }

    /// Whether an order with `after` misses for `before` is worth writing.
    ///
    /// Run on its own output, a search that is random or does not look at every cache oscillates
    /// slightly. Changes within that noise are not improvements.
    pub(super) fn is_gain(&self, before: u64, after: u64) -> bool {
        let thousandths = match (self.optimizer.effort, self.optimizer.target) {
            (order::Effort::Fast, Target::Cache(_)) => 0,
            (order::Effort::Fast, _) => 2,
            _ => 5,
        };
        after < before - before * thousandths / 1000
    }

    /// The same for a mesh that has `share` of all faces, and whose corners may be turned or not.
    pub(super) fn for_mesh(&self, share: f64, turnable: bool) -> Self {
        let mut algorithm = self.clone();
        let budget = &mut algorithm.time_budget;
        *budget = budget.map(|time| time.mul_f64(share).max(Duration::from_millis(1)));
        algorithm.optimizer.keep_corners |= !turnable;
        if let Some(greedy) = &mut algorithm.greedy {
            greedy.keep_corners |= !turnable;
        }
        algorithm
    }

    /// The order of the faces, the polygons that begin at `starts` kept whole, and the pushes of
    /// its schedule for a controllable cache.
    pub(super) fn order(&self, mesh: &Mesh, starts: Option<&[u32]>) -> (FaceOrder, u64) {
        let Target::Cache(CacheModel::Controllable { size, .. }) = self.target() else {
            let order = match (&self.greedy, starts) {
                (None, starts) => self.search(mesh, starts),
                (Some(greedy), None) => greedy.face_order(mesh),
                (Some(greedy), Some(starts)) => greedy.polygon_order(mesh, starts),
            };
            return (order, 0);
        };

        // Controllable caches: the pushes of the order that was searched for, or of the greedy.
        let is_search = self.optimizer.effort != order::Effort::Fast
            || self.time_budget.is_some()
            || starts.is_some();
        if self.greedy.is_none() && is_search {
            let order = self.search(mesh, starts);
            let pushes = Schedule::fewest_pushes(&order.apply(mesh.faces()), size).pushes();
            return (order, pushes);
        }

        let greedy = self.greedy.clone().unwrap_or(KCacheReorder {
            cache: CacheModel::controllable(size),
            keep_corners: self.optimizer.keep_corners,
            ..KCacheReorder::default()
        });
        let (order, schedule) = greedy.schedule(mesh);
        (order, schedule.pushes())
    }
}

impl Algorithm {
    fn search(&self, mesh: &Mesh, starts: Option<&[u32]>) -> FaceOrder {
        match self.time_budget {
            Some(time) => {
                let start = Instant::now();
                self.optimizer.run(mesh, starts, &Clock { start, time })
            }
            None => self.optimizer.run(mesh, starts, &()),
        }
    }
}

/// A caller with a clock.
struct Clock {
    start: Instant,
    time: Duration,
}

impl Progress for Clock {
    fn time_spent(&self) -> Option<f64> {
        Some(self.start.elapsed().as_secs_f64() / self.time.as_secs_f64())
    }
}

fn check_size(target: Target) -> Result<(), Usage> {
    match target {
        Target::Cache(cache) if cache.size() > MAX_SIZE => Err(Usage(format!(
            "--cache {cache}: orders are made for caches of 3 to {MAX_SIZE} vertices"
        ))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args, Command, FromArgMatches};

    use super::*;

    fn algorithm(flags: &str) -> Result<Algorithm, Usage> {
        let words = format!("optimize a.obj --dry-run {flags}");
        let command = Optimize::augment_args(Command::new("optimize"));
        let matches = command.get_matches_from(words.split_whitespace());
        Algorithm::of(&Optimize::from_arg_matches(&matches).unwrap())
    }

    #[test]
    fn weights_and_the_faithful_mode_are_the_greedys() {
        for flags in ["--mode faithful", "--k3 2"] {
            for cache in ["fifo:12", "controllable:9"] {
                let found = algorithm(&format!("{flags} --cache {cache}")).unwrap();
                assert!(found.greedy.is_some());
            }
            for others in ["", "--cache nvidia", "--cache fifo:12 --effort best"] {
                let refused = algorithm(&format!("{flags} {others}"));
                assert!(refused.is_err(), "{flags} {others}");
            }
        }
        assert!(algorithm("--cache fifo:1025").is_err());
        let universal = algorithm("--effort max --seed 7 --time-budget 1.5s").unwrap();
        assert_eq!(universal.target(), Target::Universal);
        assert_eq!(universal.optimizer.seed, 7);
        let budget = universal.for_mesh(0.5, true).time_budget;
        assert_eq!(budget, Some(Duration::from_millis(750)));
        assert!(universal.runs_once());
    }

    #[test]
    fn noise_is_not_a_gain() {
        let fast = algorithm("--cache fifo:12").unwrap();
        assert!(fast.is_gain(1000, 999) && !fast.is_gain(1000, 1000));
        let best = algorithm("--effort best").unwrap();
        assert!(best.is_gain(10_000, 9_949) && !best.is_gain(10_000, 9_950));
        assert!(best.is_gain(90, 89), "small meshes are exact");
    }
}
