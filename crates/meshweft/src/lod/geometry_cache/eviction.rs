//! The policies by name.

use std::fmt;

use super::finest_first::FinestFirst;
use super::first_available::FirstAvailable;
use super::oldest_first::OldestFirst;
use super::policy::SlotPolicy;
use super::queued_by_error::QueuedByError;

/// Which open slot the next vertex takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum EvictionPolicy {
    /// The finest detail of all open slots, by quarters of an octave of the error, the oldest first in each.
    #[default]
    FinestFirst,
    /// The slot that was used least recently.
    OldestFirst,
    /// The finest detail of the oldest open slots, or the oldest if none is old enough.
    #[non_exhaustive]
    QueuedByError {
        /// The largest size of the queue in hundredths of the slots.
        percent: u32,
        /// For how many frames a slot must be open to be queued.
        age: u32,
    },
    /// The first slot of the buffer that was used neither in this frame nor in the last.
    FirstAvailable,
    /// Every active vertex is sent in every frame, without slots: a standard vertex array.
    Nothing,
}

impl EvictionPolicy {
    /// The paper's four and the default. On most paths none of them uploads more than the one before.
    pub const ALL: [Self; 5] = [
        Self::Nothing,
        Self::FirstAvailable,
        Self::OldestFirst,
        Self::queued_by_error(10, 30),
        Self::FinestFirst,
    ];

    /// [`EvictionPolicy::QueuedByError`]; usual are 10 percent of the slots, as in the paper, and 30 frames.
    #[must_use]
    pub const fn queued_by_error(percent: u32, age: u32) -> Self {
        Self::QueuedByError { percent, age }
    }

    /// The policy for a number of slots. Passes of a cache that keeps nothing take the oldest.
    pub(super) fn policy(self, slots: usize) -> Box<dyn SlotPolicy> {
        match self {
            Self::FinestFirst => Box::new(FinestFirst::new(slots)),
            Self::OldestFirst | Self::Nothing => Box::new(OldestFirst::new(slots)),
            Self::QueuedByError { percent, age } => {
                Box::new(QueuedByError::new(slots, percent, age))
            }
            Self::FirstAvailable => Box::new(FirstAvailable::new(slots)),
        }
    }
}

impl fmt::Display for EvictionPolicy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FinestFirst => f.write_str("finest first"),
            Self::OldestFirst => f.write_str("LRU"),
            Self::QueuedByError { percent, age } => {
                write!(f, "LRU + error queue ({percent} %, {age} frames)")
            }
            Self::FirstAvailable => f.write_str("first available"),
            Self::Nothing => f.write_str("standard vertex array"),
        }
    }
}
