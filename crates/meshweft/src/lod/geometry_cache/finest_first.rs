//! The slot with the finest detail of all that are open.

use super::linked_slots::LinkedSlots;
use super::policy::SlotPolicy;

/// One list of open slots for each quarter of an octave of the error, the oldest first in it.
#[derive(Debug)]
pub(super) struct FinestFirst {
    open: LinkedSlots,
    /// The list of each slot that is open.
    list_of: Vec<u16>,
    /// Which lists have a slot, a bit each.
    filled: [u64; FinestFirst::LISTS.div_ceil(64)],
}

impl FinestFirst {
    /// Empty slots, and the 256 exponents of a float with two bits after each.
    const LISTS: usize = 1 + (256 << 2);

    pub(super) fn new(slots: usize) -> Self {
        Self {
            open: LinkedSlots::new(slots, Self::LISTS),
            list_of: vec![0; slots],
            filled: [0; Self::LISTS.div_ceil(64)],
        }
    }

    /// The list of an error: its exponent and the first two bits of what follows, after the list of empty slots.
    fn list(error: Option<f32>) -> u16 {
        let quarter = |error: f32| 1 + (error.abs().to_bits() >> 21);
        let list = error.map_or(0, quarter);
        u16::try_from(list).unwrap_or(u16::MAX) // 1,024 at most.
    }

    fn remove(&mut self, slot: u32, list: usize) {
        self.open.remove(slot);
        if self.open.first(list).is_none() {
            self.filled[list / 64] &= !(1 << (list % 64));
        }
    }
}

impl SlotPolicy for FinestFirst {
    fn open(&mut self, slot: u32, error: Option<f32>, _: u32) {
        let list = Self::list(error);
        self.list_of[slot as usize] = list;
        self.filled[list as usize / 64] |= 1 << (list % 64);
        self.open.push(list as usize, slot);
    }

    fn close(&mut self, slot: u32) {
        self.remove(slot, self.list_of[slot as usize] as usize);
    }

    fn take(&mut self, _: u32) -> Option<u32> {
        let word = self.filled.iter().position(|&bits| bits != 0)?;
        let list = 64 * word + self.filled[word].trailing_zeros() as usize;
        let slot = self.open.first(list)?;
        self.remove(slot, list);
        Some(slot)
    }
}

#[cfg(test)]
mod tests {
    use super::FinestFirst;

    #[test]
    fn lists_are_quarters_of_an_octave() {
        let list = |error| FinestFirst::list(Some(error));
        assert_eq!(list(1.0), list(1.24));
        assert_eq!(list(1.25), list(1.0) + 1);
        assert_eq!(list(1.99), list(1.0) + 3);
        assert_eq!(list(2.0), list(1.0) + 4);
        assert_eq!((FinestFirst::list(None), list(0.0), list(-0.0)), (0, 1, 1));
        assert!(usize::from(list(f32::INFINITY)) < FinestFirst::LISTS);
        assert!(list(f32::MAX) < list(f32::INFINITY));
    }
}
