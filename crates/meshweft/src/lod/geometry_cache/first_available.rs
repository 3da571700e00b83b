//! The first slot that was used neither in this frame nor in the last.

use super::policy::SlotPolicy;

/// The paper's first available: open slots as bits, in the order of the slots.
#[derive(Debug)]
pub(super) struct FirstAvailable {
    /// Slots that were open in the last frame too.
    available: SlotBits,
    /// Slots that are open since this frame.
    fresh: SlotBits,
    /// Slots opened in the frame, some of which may be closed again.
    opened: Vec<u32>,
    frame: u32,
}

impl FirstAvailable {
    pub(super) fn new(slots: usize) -> Self {
        Self {
            available: SlotBits::new(slots),
            fresh: SlotBits::new(slots),
            opened: Vec::with_capacity(slots),
            frame: 0,
        }
    }

    /// Makes what was opened in an earlier frame available.
    fn go_on(&mut self, frame: u32) {
        if self.frame == frame {
            return;
        }
        self.frame = frame;
        for slot in self.opened.drain(..) {
            if self.fresh.remove(slot) {
                self.available.insert(slot);
            }
        }
    }
}

impl SlotPolicy for FirstAvailable {
    fn open(&mut self, slot: u32, error: Option<f32>, frame: u32) {
        self.go_on(frame);
        match error {
            None => self.available.insert(slot),
            Some(_) => {
                self.fresh.insert(slot);
                self.opened.push(slot);
            }
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

/// A set of slots, a bit each.
#[derive(Debug)]
struct SlotBits {
    words: Vec<u64>,
    /// No word before this one has a slot.
    first: usize,
}

impl SlotBits {
    fn new(slots: usize) -> Self {
        Self {
            words: vec![0; slots.div_ceil(64)],
            first: 0,
        }
    }

    fn insert(&mut self, slot: u32) {
        let word = slot as usize / 64;
        self.words[word] |= 1 << (slot % 64);
        self.first = self.first.min(word);
    }

    /// Whether it was there.
    fn remove(&mut self, slot: u32) -> bool {
        let word = &mut self.words[slot as usize / 64];
        let was_there = *word >> (slot % 64) & 1 == 1;
        *word &= !(1 << (slot % 64));
        was_there
    }

    fn take_first(&mut self) -> Option<u32> {
        while *self.words.get(self.first)? == 0 {
            self.first += 1;
        }
        let word = &mut self.words[self.first];
        let slot = crate::index::index32(64 * self.first) + word.trailing_zeros();
        *word &= *word - 1;
        Some(slot)
    }
}
