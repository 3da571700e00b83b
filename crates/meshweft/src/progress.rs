//! Limits on long work, and progress reports. There is no clock in this library.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};

/// How much a search may do, in *steps*: a step is one rollout that is committed.
///
/// Steps are counted part by part, so a result depends neither on the number of threads nor on the
/// platform. Each part gets steps in proportion to its faces. When they run out, the remaining faces
/// are ordered without looking ahead. An order that needs no rollouts takes no steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Budget {
    /// As much as the effort asks for.
    #[default]
    Unlimited,
    /// At most this many steps for all faces together.
    Steps(u64),
}

impl Budget {
    /// The share of faces `range` of `total` faces; the shares of all ranges add up to the whole.
    pub(crate) fn share(self, range: Range<usize>, total: usize) -> Self {
        let Self::Steps(steps) = self else {
            return self;
        };
        let up_to = |faces: usize| {
            let share = u128::from(steps) * faces as u128 / total.max(1) as u128;
            u64::try_from(share).unwrap_or(u64::MAX)
        };
        Self::Steps(up_to(range.end) - up_to(range.start))
    }

    /// How many steps there are.
    pub(crate) fn steps(self) -> u64 {
        match self {
            Self::Unlimited => u64::MAX,
            Self::Steps(steps) => steps,
        }
    }
}

/// Receives the progress of long work; may stop it or limit its time.
///
/// Called from any thread, often; `()` listens to nothing. Stopped or timed work is not deterministic.
///
/// ```
/// use std::ops::ControlFlow;
/// use std::sync::atomic::{AtomicBool, Ordering};
/// use meshweft::Progress;
///
/// #[derive(Debug, Default)]
/// struct Button {
///     is_pressed: AtomicBool,
/// }
///
/// impl Progress for Button {
///     fn report(&self, _fraction: f64) -> ControlFlow<()> {
///         match self.is_pressed.load(Ordering::Relaxed) {
///             true => ControlFlow::Break(()),
///             false => ControlFlow::Continue(()),
///         }
///     }
/// }
/// ```
pub trait Progress: Sync {
    /// Hears what fraction is done, from 0 to 1. `Break` stops the work, which then returns a complete
    /// result.
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        let _ = fraction;
        ControlFlow::Continue(())
    }

    /// Elapsed time over allowed time. A search then looks ahead as far and as often as the time
    /// allows, whatever its effort. `None`, the default, always: there is no limit.
    fn time_spent(&self) -> Option<f64> {
        None
    }
}

impl Progress for () {}

/// The progress of a part of the work, from one fraction of the whole to another.
pub(crate) struct PartOfWork<'a> {
    whole: &'a dyn Progress,
    start: f64,
    end: f64,
    is_stopped: AtomicBool,
}

impl<'a> PartOfWork<'a> {
    pub(crate) fn new(whole: &'a dyn Progress, start: f64, end: f64) -> Self {
        Self {
            whole,
            start,
            end,
            is_stopped: AtomicBool::new(false),
        }
    }

    /// Whether it was said in this part that the work stops.
    pub(crate) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}

impl Progress for PartOfWork<'_> {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        let fraction = self.start + fraction * (self.end - self.start);
        let answer = self.whole.report(fraction);
        if answer.is_break() {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
        answer
    }

    fn time_spent(&self) -> Option<f64> {
        self.whole.time_spent()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_budget_add_up_to_it() {
        let budget = Budget::Steps(1000);
        let share = |range| budget.share(range, 3000).steps();
        assert_eq!([share(0..3), share(3..4), share(4..3000)], [1, 0, 999]);
        // However many faces there are for each step.
        let few = Budget::Steps(3);
        let shares = (0..1000).map(|face| few.share(face..face + 1, 1000).steps());
        assert_eq!(shares.sum::<u64>(), 3);
        assert_eq!(
            Budget::Steps(u64::MAX).share(0..9, 9),
            Budget::Steps(u64::MAX)
        );
        assert_eq!(Budget::Unlimited.share(0..1, 2), Budget::Unlimited);
        assert_eq!(budget.share(0..0, 0), Budget::Steps(0));
    }
}
