//! What orders the faces of a document: chosen by the options.

#[cfg(any(feature = "files", test))]
use std::ops::Range;

use super::options::{Greedy, Options};
use crate::cache::{self, CacheModel};
use crate::faces::Faces;
use crate::order::{Effort, KCacheReorder, Mode, Optimizer, Target};
use crate::permutation::FaceOrder;
use crate::progress::{Budget, Progress};

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

    /// Whether to run exactly once, without the improvement rounds: the faithful mode does, as the
    /// paper does, and a search that was given its steps or its time.
    pub(super) fn runs_once(&self, progress: &dyn Progress) -> bool {
        let is_faithful = self
            .greedy
            .is_some_and(|greedy| greedy.mode == Mode::Faithful);
        let has_steps = self.optimizer.budget != Budget::Unlimited && self.optimizer.is_search();
        is_faithful || has_steps || progress.time_spent().is_some() || self.allows_worse
    }

    /// Why an order with `after` misses for `before` is not taken; `None` if it is.
    pub(super) fn refusal(&self, before: u64, after: u64) -> Option<&'static str> {
        match (after < before, self.is_gain(before, after)) {
            _ if self.allows_worse => None,
            (_, true) => None,
            (true, false) => Some("the order found misses less by too little to be an improvement"),
            (false, false) => Some("the order found does not miss less"),
        }
    }

    /// Whether an order with `after` misses for `before` is worth taking.
    ///
    /// Run on its own output, a randomised search oscillates slightly. Changes within that noise are
    /// not improvements.
    fn is_gain(&self, before: u64, after: u64) -> bool {
        let thousandths = match (self.optimizer.effort, self.optimizer.target) {
            (Effort::Fast, Target::Cache(_)) => 0,
            (Effort::Fast, _) => 2,
            _ => 5,
        };
        after < before - before * thousandths / 1000
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
            || starts.is_some();
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

    fn algorithm(target: &str, effort: Effort) -> Algorithm {
        Algorithm::new(&Options {
            target: target.parse().unwrap(),
            effort,
            ..Options::default()
        })
    }

    #[test]
    fn what_oscillates_is_no_gain() {
        let fast = algorithm("fifo:12", Effort::Fast);
        assert!(fast.is_gain(1000, 999) && !fast.is_gain(1000, 1000));
        let best = algorithm("universal", Effort::Best);
        assert!(best.is_gain(10_000, 9_949) && !best.is_gain(10_000, 9_950));
        assert!(best.is_gain(90, 89), "small meshes are exact");
        assert_eq!(best.refusal(90, 89), None);
        let [little, nothing] = [9_960, 10_000].map(|after| best.refusal(10_000, after));
        assert!(little.is_some() && nothing.is_some() && little != nothing);
    }

    #[test]
    fn a_budget_and_the_faithful_mode_run_once() {
        let mut options = Options::default();
        assert!(!Algorithm::new(&options).runs_once(&()));
        options.budget = Budget::Steps(100);
        assert!(Algorithm::new(&options).runs_once(&()));
        let share = Algorithm::new(&options).for_share(50..75, 100, true);
        assert_eq!(share.optimizer.budget, Budget::Steps(25));
        // A greedy takes no steps: a budget changes nothing.
        options.target = CacheModel::fifo(12).into();
        assert!(!Algorithm::new(&options).runs_once(&()));
        options = Options {
            greedy: Some(Greedy::of_mode(Mode::Faithful)),
            target: CacheModel::fifo(12).into(),
            ..Options::default()
        };
        assert!(Algorithm::new(&options).runs_once(&()));
    }
}
