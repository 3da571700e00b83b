//! Turning a face's corners so that hits come first.

use crate::faces::turned;

/// How a face is turned, and which of its turned corners may have to be pushed.
pub(in crate::order) struct Turn {
    pub(in crate::order) rotation: u8,
    /// How many corners are not in the cache before the face is drawn.
    pub(in crate::order) misses: u32,
    /// The first turned corner that may have to be pushed.
    first: usize,
}

impl Turn {
    /// The turn of a face; `missing` is 1 for each corner that is not in the cache, else 0.
    #[inline]
    pub(in crate::order) fn new<const KEEP_CORNERS: bool>(missing: [u32; 3]) -> Self {
        let misses = missing[0] + missing[1] + missing[2];
        debug_assert!(missing.iter().all(|&missing| missing <= 1));
        if KEEP_CORNERS {
            return Self {
                rotation: 0,
                misses,
                first: 0,
            };
        }

        let set = missing[0] | missing[1] << 1 | missing[2] << 2;
        Self {
            rotation: HITS_FIRST[set as usize & 7],
            misses,
            // The misses come last, and a hit is not pushed.
            first: 3 - misses as usize,
        }
    }

    /// The corners that may have to be pushed, in the order in which they are drawn.
    #[inline]
    pub(in crate::order) fn pushes(&self, corners: [u32; 3]) -> impl Iterator<Item = u32> {
        turned(corners, self.rotation).into_iter().skip(self.first)
    }
}

/// How far to turn a face so that its hits come first, by the bit set of its missing corners.
pub(in crate::order) const HITS_FIRST: [u8; 8] = [0, 1, 2, 2, 0, 1, 0, 0];
