//! The first slot that was used neither in this frame nor in the last.

use super::policy::SlotPolicy;
use super::slot_bits::SlotBits;

/// The paper's first available: open slots as bits, in the order of the slots.
#[derive(Debug)]
pub(super) struct FirstAvailable {
    /// Slots that were open in the last frame too.
    available: SlotBits,
    /// Slots that are open since this frame.
    fresh: SlotBits,
    frame: u32,
}

impl FirstAvailable {
    pub(super) fn new(slots: usize) -> Self {
        Self {
            available: SlotBits::new(slots),
            fresh: SlotBits::new(slots),
            frame: 0,
        }
    }

    /// Makes what was opened in an earlier frame available.
    fn go_on(&mut self, frame: u32) {
        if self.frame == frame {
            return;
        }
        self.frame = frame;
        while let Some(slot) = self.fresh.take_first() {
            self.available.insert(slot);
        }
    }
}

impl SlotPolicy for FirstAvailable {
    fn open(&mut self, slot: u32, error: Option<f32>, frame: u32) {
        self.go_on(frame);
        match error {
            None => self.available.insert(slot),
            Some(_) => self.fresh.insert(slot),
        }
    }

    fn close(&mut self, slot: u32) {
        self.available.remove(slot);
        self.fresh.remove(slot);
    }

    fn take(&mut self, frame: u32) -> Option<u32> {
        self.go_on(frame);
        self.available
            .take_first()
            .or_else(|| self.fresh.take_first())
    }
}
