//! Eviction policies, as they are given.

use clap::ValueEnum;
use meshweft::operations::EvictionPolicy;

/// A policy as it is given.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Policy {
    /// Of all open slots, the one with the finest detail
    Finest,
    /// The slot that was used least recently
    Lru,
    /// The finest detail of the oldest slots: a tenth of all at most, open for 30 frames
    Queue,
    /// The first slot that was used neither in this frame nor in the last
    First,
    /// No slots: all active vertices are sent in every frame
    None,
}

impl Policy {
    pub(crate) fn eviction(self) -> EvictionPolicy {
        match self {
            Self::Finest => EvictionPolicy::FinestFirst,
            Self::Lru => EvictionPolicy::OldestFirst,
            Self::Queue => EvictionPolicy::queued_by_error(10, 30),
            Self::First => EvictionPolicy::FirstAvailable,
            Self::None => EvictionPolicy::Nothing,
        }
    }
}
