//! Points by how urgently they have to be active.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use crate::lod::view::{DetailBound, Urgency};

/// A point with how urgently it has to be active.
#[derive(Debug, Clone, Copy)]
pub(super) struct Queued {
    pub(super) urgency: Urgency,
    /// What is known of it.
    pub(super) bound: DetailBound,
    pub(super) point: u32,
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Queued {}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> Ordering {
        // Among equals coarse points come first: their balls contain those below.
        let by_urgency = self.urgency.order(other.urgency);
        let by_radius = self.bound.radius.total_cmp(&other.bound.radius);
        by_urgency
            .then(by_radius)
            .then(other.point.cmp(&self.point))
    }
}

/// Points that may be split, the most urgent first, and such that may be collapsed, the least urgent first.
#[derive(Debug, Clone, Default)]
pub(super) struct BudgetQueues {
    pub(super) splits: BinaryHeap<Queued>,
    pub(super) collapses: BinaryHeap<Reverse<Queued>>,
    /// The split for which collapses make room.
    pub(super) room_for: Option<u32>,
    /// How many splits were passed because they need too much room.
    pub(super) passed: usize,
}
