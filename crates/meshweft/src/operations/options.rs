//! What an optimisation is asked for.

use std::fmt;

use crate::cache::CacheModel;
use crate::order::{Effort, KCacheReorder, Mode, Target};
use crate::progress::Budget;

/// The largest cache that documents are ordered for.
const MAX_CACHE_SIZE: u32 = 1024;

/// How `optimize` orders a document.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// What the orders are to be good for.
    pub target: Target,
    /// How much time they are worth.
    pub effort: Effort,
    /// The greedy of Lin and Yu with settings of its own, instead of what the target and the effort
    /// would choose.
    pub greedy: Option<Greedy>,
    /// Seed of the search; the same seed gives the same bytes.
    pub seed: u64,
    /// How much a search may do for all meshes together. What it finds with a budget is not checked.
    pub budget: Budget,
    /// Forbids turning corners (provoking vertex, data on edges), wherever the file allows it.
    pub keep_corners: bool,
    /// Leaves the vertices where they are.
    pub keep_vertex_order: bool,
    /// Takes an order even if it misses more, unchecked.
    pub allow_worse: bool,
}

/// Settings of K-Cache-Reorder (Lin & Yu 2006), see [`KCacheReorder`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Greedy {
    /// Fast, or faithful to the paper.
    pub mode: Mode,
    /// Weight of a push, if not the paper's.
    pub k1: Option<f64>,
    /// Weight of a face drawn, if not the paper's.
    pub k2: Option<f64>,
    /// Weight of the distance from the front of a FIFO cache, if not the paper's.
    pub k3: Option<f64>,
}

impl Greedy {
    /// With the paper's weights.
    #[must_use]
    pub fn of_mode(mode: Mode) -> Self {
        Self {
            mode,
            ..Self::default()
        }
    }

    /// The algorithm for a cache, FIFO or controllable.
    pub(super) fn for_cache(&self, cache: CacheModel, keep_corners: bool) -> KCacheReorder {
        let usual = KCacheReorder::default();
        KCacheReorder {
            cache,
            mode: self.mode,
            k1: self.k1.unwrap_or(usual.k1),
            k2: self.k2.unwrap_or(usual.k2),
            k3: self.k3.unwrap_or(usual.k3),
            keep_corners,
            first_focus: None,
        }
    }
}

impl Options {
    /// Whether these can be combined; `optimize` checks it first.
    ///
    /// # Errors
    /// [`OptionsError`] if they cannot.
    pub fn check(&self) -> Result<(), OptionsError> {
        check_target(self.target)?;
        if self.greedy.is_none() {
            return Ok(());
        }
        match self.target {
            Target::Cache(CacheModel::Fifo { .. } | CacheModel::Controllable { .. }) => {}
            target => return Err(OptionsError::NotGreedy { target }),
        }
        match self.effort == Effort::Fast && self.budget == Budget::Unlimited {
            true => Ok(()),
            false => Err(OptionsError::GreedyIsOnePass),
        }
    }
}

/// Whether documents are ordered for it.
pub(super) fn check_target(target: Target) -> Result<(), OptionsError> {
    match target {
        Target::Cache(cache) if cache.size() > MAX_CACHE_SIZE => {
            Err(OptionsError::CacheTooLarge { cache })
        }
        _ => Ok(()),
    }
}

/// Options that cannot be combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum OptionsError {
    /// The cache is larger than orders are made for.
    CacheTooLarge {
        /// The cache that was asked for.
        cache: CacheModel,
    },
    /// The greedy does not order for this target.
    NotGreedy {
        /// The target that was asked for.
        target: Target,
    },
    /// The greedy is one pass: it has neither another effort nor a budget.
    GreedyIsOnePass,
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CacheTooLarge { cache } => write!(
                f,
                "{cache}: orders are made for caches of 3 to {MAX_CACHE_SIZE} vertices"
            ),
            Self::NotGreedy { target } => write!(
                f,
                "the faithful mode and weights are for fifo:K and controllable:K, not for {target}"
            ),
            Self::GreedyIsOnePass => f.write_str(
                "the faithful mode and weights run one greedy pass: they cannot be combined with \
                 another effort, a budget or a time limit",
            ),
        }
    }
}

impl std::error::Error for OptionsError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_the_faithful_mode_are_the_greedys() {
        let weights = Greedy {
            k3: Some(2.0),
            ..Greedy::default()
        };
        for greedy in [Greedy::of_mode(Mode::Faithful), weights] {
            let check = |target: &str, effort| {
                let options = Options {
                    target: target.parse().unwrap(),
                    effort,
                    greedy: Some(greedy),
                    ..Options::default()
                };
                options.check()
            };
            for cache in ["fifo:12", "controllable:9"] {
                assert_eq!(check(cache, Effort::Fast), Ok(()));
                let refused = check(cache, Effort::Best).unwrap_err();
                assert_eq!(refused, OptionsError::GreedyIsOnePass);
            }
            for other in ["universal", "nvidia", "lru:12"] {
                let refused = check(other, Effort::Fast).unwrap_err().to_string();
                assert!(refused.ends_with(&format!("not for {other}")), "{refused}");
            }
        }
        let large = Options {
            target: CacheModel::fifo(1025).into(),
            ..Options::default()
        };
        assert_eq!(
            large.check().unwrap_err().to_string(),
            "fifo:1025: orders are made for caches of 3 to 1024 vertices"
        );
    }
}
