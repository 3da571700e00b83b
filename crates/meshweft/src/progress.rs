//! How long work may take, and what its caller hears of it. There is no clock in this library.

use std::ops::ControlFlow;

/// How much a search may do, in *steps*: a step is one rollout that is committed.
///
/// Steps are counted part by part, so a result depends neither on the number of threads nor on the
/// platform. Each part has its share of them by its faces; where they are used up, the rest is drawn
/// without looking ahead. An order that needs no rollouts takes no steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Budget {
    /// As much as the effort asks for.
    #[default]
    Unlimited,
    /// At most about so many steps for all faces together.
    Steps(u64),
}

impl Budget {
    /// What `faces` of `total` faces may use, at least one step of any.
    pub(crate) fn share(self, faces: usize, total: usize) -> Self {
        match self {
            Self::Unlimited => Self::Unlimited,
            Self::Steps(steps) => {
                let share = u128::from(steps) * faces as u128;
                let share = share.div_ceil(total.max(1) as u128);
                Self::Steps(u64::try_from(share).unwrap_or(u64::MAX))
            }
        }
    }

    /// How many steps there are.
    pub(crate) fn steps(self) -> u64 {
        match self {
            Self::Unlimited => u64::MAX,
            Self::Steps(steps) => steps,
        }
    }
}

/// The caller of long work: hears how far it is, and may stop it or hurry it.
///
/// Called from any thread, often; `()` listens to nothing. What was stopped or hurried depends on when
/// that happened, so it need not come out the same again.
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
    /// Hears what fraction is done, from 0 to 1; whether to go on. What is stopped ends with what it
    /// has, as soon as that is whole.
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        let _ = fraction;
        ControlFlow::Continue(())
    }

    /// For work that is to take a certain time: what fraction of it is over, from 0 on. A search then
    /// looks ahead as far and as often as that leaves time for, whatever its effort. `None`, always:
    /// there is no such time.
    fn time_spent(&self) -> Option<f64> {
        None
    }
}

impl Progress for () {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_budget_add_up_to_it() {
        let budget = Budget::Steps(1000);
        let shares = [1, 10, 89, 400, 500].map(|faces| budget.share(faces, 1000).steps());
        assert_eq!(shares, [1, 10, 89, 400, 500]);
        assert_eq!(Budget::Steps(3).share(1, 1000), Budget::Steps(1));
        assert_eq!(Budget::Steps(0).share(500, 1000), Budget::Steps(0));
        assert_eq!(Budget::Steps(u64::MAX).share(9, 9), Budget::Steps(u64::MAX));
        assert_eq!(Budget::Unlimited.share(1, 2), Budget::Unlimited);
        assert_eq!(budget.share(0, 0), Budget::Steps(0));
    }
}
