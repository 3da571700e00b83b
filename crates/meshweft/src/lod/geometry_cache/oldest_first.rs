//! The slot that was used least recently.

use super::linked_slots::LinkedSlots;
use super::policy::SlotPolicy;

/// The paper's LRU: open slots in a list, the oldest first.
#[derive(Debug)]
pub(super) struct OldestFirst {
    open: LinkedSlots,
}

impl OldestFirst {
    pub(super) fn new(slots: usize) -> Self {
        Self {
            open: LinkedSlots::new(slots, 1),
        }
    }
}

impl SlotPolicy for OldestFirst {
    fn open(&mut self, slot: u32, _: Option<f32>, _: u32) {
        self.open.push(0, slot);
    }

    fn close(&mut self, slot: u32) {
        self.open.remove(slot);
    }

    fn take(&mut self, _: u32) -> Option<u32> {
        let slot = self.open.first(0)?;
        self.open.remove(slot);
        Some(slot)
    }
}
