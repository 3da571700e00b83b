//! Primitive setup: one unit for the whole card, which keeps the corners of nine vertices.

/// How many vertices the setup unit keeps.
pub(crate) const SLOTS: usize = 9;

/// No lane.
const EMPTY: u8 = u8::MAX;

/// The slots of the setup unit inside a batch. They are filled in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Setup {
    slots: [u8; SLOTS],
    /// The next slot to fill.
    hand: u8,
    /// The lanes in the slots, one bit each.
    kept: u32,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            slots: [EMPTY; SLOTS],
            hand: 0,
            kept: 0,
        }
    }
}

impl Setup {
    /// The lanes that are kept, one bit each.
    #[inline]
    pub(crate) fn kept(&self) -> u32 {
        self.kept
    }

    /// Sets up a triangle of these lanes (below 32); returns the cycles that it takes, 1 to 3.
    #[inline]
    pub(crate) fn add(&mut self, lanes: [u32; 3]) -> u32 {
        let own = lanes.iter().fold(0, |own, lane| own | 1 << lane);
        let mut misses = 0;
        for lane in lanes {
            if self.kept >> lane & 1 != 0 {
                continue;
            }
            misses += 1;

            // A corner of the same triangle is skipped.
            while self.slot() != EMPTY && own >> self.slot() & 1 != 0 {
                self.turn();
            }
            if self.slot() != EMPTY {
                self.kept &= !(1 << self.slot());
            }
            #[expect(clippy::cast_possible_truncation, reason = "lanes are below 32")]
            {
                self.slots[usize::from(self.hand)] = lane as u8;
            }
            self.kept |= 1 << lane;
            self.turn();
        }
        misses.max(1)
    }

    #[inline]
    fn slot(&self) -> u8 {
        self.slots[usize::from(self.hand)]
    }

    #[inline]
    fn turn(&mut self) {
        self.hand = if usize::from(self.hand) + 1 == SLOTS {
            0
        } else {
            self.hand + 1
        };
    }
}
