//! A set of slots that gives them by number.

use crate::index::index32;

/// A set of slots, a bit each, and a bit for each word of these that has one.
#[derive(Debug, Clone, Default)]
pub(super) struct SlotBits {
    words: Vec<u64>,
    filled: Vec<u64>,
    /// No word of `filled` before this one has a bit.
    first: usize,
}

impl SlotBits {
    pub(super) fn new(slots: usize) -> Self {
        let mut bits = Self::default();
        bits.grow(slots);
        bits
    }

    /// Makes room for the slots below a number.
    #[inline]
    pub(super) fn grow(&mut self, slots: usize) {
        if 64 * self.words.len() < slots {
            self.words.resize(slots.div_ceil(64), 0);
            self.filled.resize(slots.div_ceil(64 * 64), 0);
        }
    }

    #[inline]
    pub(super) fn insert(&mut self, slot: u32) {
        let word = slot as usize / 64;
        self.words[word] |= 1 << (slot % 64);
        self.filled[word / 64] |= 1 << (word % 64);
        self.first = self.first.min(word / 64);
    }

    /// Whether it was there.
    #[inline]
    pub(super) fn remove(&mut self, slot: u32) -> bool {
        let word = slot as usize / 64;
        let was_there = self.words[word] >> (slot % 64) & 1 == 1;
        self.words[word] &= !(1 << (slot % 64));
        if self.words[word] == 0 {
            self.filled[word / 64] &= !(1 << (word % 64));
        }
        was_there
    }

    /// Removes the slot of the lowest number. To take all takes a constant time for each, and one for 4,096 slots that
    /// there may be.
    #[inline]
    pub(super) fn take_first(&mut self) -> Option<u32> {
        while *self.filled.get(self.first)? == 0 {
            self.first += 1;
        }
        let word = 64 * self.first + self.filled[self.first].trailing_zeros() as usize;
        let slot = index32(64 * word) + self.words[word].trailing_zeros();
        self.remove(slot);
        Some(slot)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::SlotBits;
    use crate::random::SplitMix64;

    #[test]
    fn slots_come_by_number() {
        for slots in [1, 64, 65, 4096, 4097, 20_000] {
            let random = &mut SplitMix64(slots as u64);
            let (mut bits, mut set) = (SlotBits::new(slots / 2), BTreeSet::new());
            bits.grow(slots);
            bits.grow(slots / 3);
            for _ in 0..3000 {
                let slot = u32::try_from(random.below(slots)).unwrap();
                match random.below(4) {
                    0 => assert_eq!(bits.remove(slot), set.remove(&slot)),
                    1 => assert_eq!(bits.take_first(), set.pop_first()),
                    _ => {
                        bits.insert(slot);
                        set.insert(slot);
                    }
                }
            }
            let all: Vec<u32> = std::iter::from_fn(|| bits.take_first()).collect();
            assert_eq!(all, Vec::from_iter(set));
        }
    }
}
