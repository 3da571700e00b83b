//! What orders the faces of a document: chosen by the options.

#[cfg(any(feature = "files", test))]
use std::ops::Range;

use super::options::{Greedy, Options};
use super::shared_progress::SharedProgress;
use crate::cache::{self, CacheModel};
use crate::faces::Faces;
use crate::order::{Effort, KCacheReorder, Mode, Optimizer, Target, is_in_blocks};
use crate::permutation::FaceOrder;
use crate::progress::{Budget, Progress};

/// Most faces of which the result of a search is checked. One greedy pass takes little longer than
/// counting, and is always checked.
pub(super) const MOST_CHECKED: usize = 1 << 17;

/// A way to order faces, and to tell whether that is worth it.
#[derive(Debug, Clone)]
pub(super) struct Algorithm {
    optimizer: Optimizer,
    /// Instead of the optimizer, with what it does not have: the paper's plain reading, weights.
    greedy: Option<Greedy>,
    allows_worse: bool,
}

impl Algorithm {
    /// The one that the options ask for, which were checked.
    pub(super) fn new(options: &Options) -> Self {
        Self {
            optimizer: Optimizer {
                target: options.target,
                effort: options.effort,
                seed: options.seed,
                keep_corners: options.keep_corners,
                budget: options.budget,
            },
            greedy: options.greedy,
            allows_worse: options.allow_worse,
        }
    }

    /// What the order is to be good for.
    pub(super) fn target(&self) -> Target {
        self.optimizer.target
    }

    /// The same with the random numbers of another seed; 0 keeps its own.
    pub(super) fn with_other_seed(&self, other: u64) -> Self {
        let mut algorithm = self.clone();
        algorithm.optimizer.seed = self.optimizer.seed.wrapping_add(other << 32);
        algorithm
    }

    /// Whether an order that misses more is taken too.
    pub(super) fn allows_worse(&self) -> bool {
        self.allows_worse
    }

    /// Whether an order of so many faces is checked, that is, its result ordered once more.
    ///
    /// The faithful mode is not, as the paper does not, nor is a search that was given its steps or
    /// its time, nor one of a large mesh.
    pub(super) fn is_checked(&self, faces: usize, progress: &SharedProgress<'_>) -> bool {
        let is_faithful = self
            .greedy
            .is_some_and(|greedy| greedy.mode == Mode::Faithful);
        let is_search = self.optimizer.is_search();
        let has_steps = self.optimizer.budget != Budget::Unlimited && is_search;
        let is_large = is_search && faces > MOST_CHECKED;
        !(is_faithful || has_steps || progress.is_timed() || self.allows_worse || is_large)
    }

    /// The algorithm for faces `range` of the `total` faces of a document: its share of the budget,
    /// corners kept unless `turnable`.
    #[cfg(any(feature = "files", test))]
    pub(super) fn for_share(&self, range: Range<usize>, total: usize, turnable: bool) -> Self {
        let mut algorithm = self.clone();
        algorithm.optimizer.budget = self.optimizer.budget.share(range, total);
        algorithm.optimizer.keep_corners |= !turnable;
        algorithm
    }

    /// The order of the faces, the polygons that begin at `starts` kept whole, and the pushes of
    /// its schedule for a controllable cache.
    pub(super) fn order(
        &self,
        faces: Faces<'_>,
        starts: Option<&[u32]>,
        progress: &dyn Progress,
    ) -> (FaceOrder, u64) {
        let Target::Cache(model @ CacheModel::Controllable { .. }) = self.target() else {
            return (self.unscheduled(faces, starts, progress), 0);
        };
        let is_search = self.optimizer.effort != Effort::Fast
            || progress.time_spent().is_some()
            || starts.is_some()
            || is_in_blocks(faces);
        if self.greedy.is_none() && is_search {
            let order = self.optimizer.face_order_with(faces, starts, progress);
            let ordered = order.apply(faces.as_slice());
            let ordered = Faces::of_checked(&ordered, faces.vertex_count());
            return (order, cache::misses(ordered, model));
        }
        let (order, schedule) = self.greedy(model).schedule(faces);
        (order, schedule.pushes())
    }

    fn unscheduled(
        &self,
        faces: Faces<'_>,
        starts: Option<&[u32]>,
        progress: &dyn Progress,
    ) -> FaceOrder {
        match (self.greedy, self.target()) {
            (Some(_), Target::Cache(cache)) => match starts {
                None => self.greedy(cache).face_order(faces),
                Some(starts) => self.greedy(cache).polygon_order(faces, starts),
            },
            _ => self.optimizer.face_order_with(faces, starts, progress),
        }
    }

    fn greedy(&self, cache: CacheModel) -> KCacheReorder {
        let greedy = self.greedy.unwrap_or_default();
        greedy.for_cache(cache, self.optimizer.keep_corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_the_faithful_mode_and_large_searches_are_not_checked() {
        let is_checked = |options: &Options, faces| {
            Algorithm::new(options).is_checked(faces, &SharedProgress::new(&(), faces))
        };
        let mut options = Options::default();
        assert!(is_checked(&options, MOST_CHECKED) && !is_checked(&options, MOST_CHECKED + 1));
        options.budget = Budget::Steps(100);
        assert!(!is_checked(&options, 100));
        let share = Algorithm::new(&options).for_share(50..75, 100, true);
        assert_eq!(share.optimizer.budget, Budget::Steps(25));
        // A greedy takes no steps, and one pass no time: a budget and the size change nothing.
        options.target = CacheModel::fifo(12).into();
        assert!(is_checked(&options, 10 * MOST_CHECKED));
        options = Options {
            greedy: Some(Greedy::of_mode(Mode::Faithful)),
            target: CacheModel::fifo(12).into(),
            ..Options::default()
        };
        assert!(!is_checked(&options, 100));
        options = Options {
            allow_worse: true,
            ..Options::default()
        };
        assert!(!is_checked(&options, 100));
    }
}
