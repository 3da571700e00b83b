//! Primitive setup: one unit for the whole card, which keeps the corners of nine vertices.

/// How many vertices the setup unit keeps.
pub(crate) const SLOTS: usize = 9;

/// No lane.
const EMPTY: u16 = u16::MAX;

/// A set of lanes.
pub(crate) trait LaneSet: Copy + Default {
    fn has(&self, lane: u32) -> bool;
    fn put(&mut self, lane: u32);
    fn remove(&mut self, lane: u32);
}

/// The lanes of a warp: below 32.
impl LaneSet for u32 {
    #[inline]
    fn has(&self, lane: u32) -> bool {
        self >> lane & 1 != 0
    }

    #[inline]
    fn put(&mut self, lane: u32) {
        *self |= 1 << lane;
    }

    #[inline]
    fn remove(&mut self, lane: u32) {
        *self &= !(1 << lane);
    }
}

/// The vertices of a meshlet: below 256.
impl LaneSet for [u64; 4] {
    #[inline]
    fn has(&self, lane: u32) -> bool {
        self[(lane / 64) as usize] >> (lane % 64) & 1 != 0
    }

    #[inline]
    fn put(&mut self, lane: u32) {
        self[(lane / 64) as usize] |= 1 << (lane % 64);
    }

    #[inline]
    fn remove(&mut self, lane: u32) {
        self[(lane / 64) as usize] &= !(1 << (lane % 64));
    }
}

/// The slots of the setup unit inside a batch, or inside a meshlet of a mesh shader. They are filled in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Setup<Lanes = u32> {
    slots: [u16; SLOTS],
    /// The next slot to fill.
    hand: u8,
    /// The lanes in the slots.
    kept: Lanes,
}

impl<Lanes: LaneSet> Default for Setup<Lanes> {
    fn default() -> Self {
        Self {
            slots: [EMPTY; SLOTS],
            hand: 0,
            kept: Lanes::default(),
        }
    }
}

impl<Lanes: LaneSet> Setup<Lanes> {
    /// The lanes that are kept.
    #[inline]
    pub(crate) fn kept(&self) -> Lanes {
        self.kept
    }

    /// The lanes that are kept, those taken in first at the front unless one was skipped.
    #[inline]
    pub(crate) fn kept_in_turn(&self) -> impl Iterator<Item = u16> + '_ {
        let (newer, older) = self.slots.split_at(usize::from(self.hand));
        let slots = older.iter().chain(newer).copied();
        slots.filter(|&lane| lane != EMPTY)
    }

    /// Sets up a triangle of these lanes; returns the cycles that it takes, 1 to 3.
    #[inline]
    pub(crate) fn add(&mut self, lanes: [u32; 3]) -> u32 {
        let mut misses = 0;
        for lane in lanes {
            if self.kept.has(lane) {
                continue;
            }
            misses += 1;

            // A corner of the same triangle is skipped.
            while self.slot() != EMPTY && lanes.contains(&u32::from(self.slot())) {
                self.turn();
            }
            if self.slot() != EMPTY {
                self.kept.remove(self.slot().into());
            }
            #[expect(clippy::cast_possible_truncation, reason = "lanes are below 256")]
            {
                self.slots[usize::from(self.hand)] = lane as u16;
            }
            self.kept.put(lane);
            self.turn();
        }
        misses.max(1)
    }

    #[inline]
    fn slot(&self) -> u16 {
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

/// The cycles that setup takes for a meshlet of a mesh shader, whose triangles are drawn in this order and whose vertices are
/// numbered by first use: 1, and 1 to 3 for each triangle. At best that is 3 more than there are triangles.
///
/// On an H100 and an H200 other numbers of the vertices cost up to a third more.
///
/// ```
/// use meshweft::cache::nvidia::meshlet_setup_cycles;
/// // A strip: its first triangle brings three vertices, each other one brings one.
/// let strip: Vec<[u8; 3]> = (0..30).map(|i| [i, i + 1, i + 2]).collect();
/// assert_eq!(meshlet_setup_cycles(&strip), 33);
/// ```
///
/// # Complexity
/// Time O(triangles); constant space.
#[must_use]
pub fn meshlet_setup_cycles(triangles: &[[u8; 3]]) -> u64 {
    let mut setup = Setup::<[u64; 4]>::default();
    let cycles = triangles
        .iter()
        .map(|lanes| setup.add(lanes.map(u32::from)));
    match triangles.is_empty() {
        true => 0,
        false => 1 + cycles.map(u64::from).sum::<u64>(),
    }
}
