//! Ranges of faces to draw.

use std::ops::Range;

use crate::index::index32;

/// Ranges of faces to draw, rising and apart; memory that is used again for each view.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ranges {
    ranges: Vec<Range<u32>>,
    /// Gaps by size, while ranges are joined.
    gaps: Vec<(u32, u32)>,
}

impl Ranges {
    /// No range, and room for some: with as many as there are parts to draw, no view needs memory.
    #[must_use]
    pub fn with_capacity(ranges: usize) -> Self {
        Self {
            ranges: Vec::with_capacity(ranges),
            gaps: Vec::with_capacity(ranges),
        }
    }

    /// The ranges.
    #[must_use]
    pub fn as_slice(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// How many faces are drawn.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.ranges.iter().map(|range| range.len()).sum()
    }

    /// What draws each range by a call: the arguments that Vulkan, Direct3D 12, Metal and WebGPU read for an indexed
    /// draw, the number of indices, of instances (1), the first index, what is added to each index (0), the first
    /// instance (0).
    pub fn draws(&self) -> impl Iterator<Item = [u32; 5]> + '_ {
        let draw = |range: &Range<u32>| [3 * (range.end - range.start), 1, 3 * range.start, 0, 0];
        self.ranges.iter().map(draw)
    }

    /// Joins ranges until no more than `most` are left, with the fewest faces between them.
    ///
    /// Each join adds the faces of one gap, whatever else is joined: the smallest gaps are the best choice.
    ///
    /// # Panics
    /// If the most is 0.
    ///
    /// # Complexity
    /// Time O(ranges).
    pub fn join_to(&mut self, most: usize) {
        assert!(most > 0, "at least one range is needed");
        let Some(surplus @ 1..) = self.ranges.len().checked_sub(most) else {
            return;
        };
        self.gaps.clear();
        let pairs = self.ranges.windows(2);
        let sizes = pairs.map(|pair| pair[1].start - pair[0].end);
        self.gaps.extend(sizes.zip(1..));
        let (_, largest, _) = self.gaps.select_nth_unstable(surplus - 1);
        let largest = *largest;

        let mut place = 0;
        self.ranges.dedup_by(|range, kept| {
            place += 1;
            let gap = (range.start - kept.end, place);
            let is_joined = gap <= largest;
            if is_joined {
                kept.end = range.end;
            }
            is_joined
        });
        debug_assert_eq!(self.ranges.len(), most);
    }

    pub(super) fn clear(&mut self) {
        self.ranges.clear();
    }

    /// Adds a range after the last one, or makes that longer.
    #[inline]
    pub(super) fn push(&mut self, range: Range<u32>) {
        if range.is_empty() {
            return;
        }
        match self.ranges.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => self.ranges.push(range),
        }
    }

    /// All faces.
    pub(super) fn push_all(&mut self, faces: usize) {
        self.push(0..index32(faces));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn ranges_are_joined_with_the_fewest_faces_between() {
        let mut random = SplitMix64(1);
        for _ in 0..2000 {
            let mut ranges = Ranges::default();
            let mut at = 0;
            for _ in 0..1 + random.below(9) {
                let start = at + 1 + index32(random.below(4));
                at = start + 1 + index32(random.below(3));
                ranges.push(start..at);
            }
            let count = ranges.as_slice().len();
            let most = 1 + random.below(10);
            let mut joined = ranges.clone();
            joined.join_to(most);
            assert_eq!(joined.as_slice().len(), most.min(count));

            // By trying all choices of gaps.
            let gaps: Vec<usize> = ranges
                .ranges
                .windows(2)
                .map(|pair| (pair[1].start - pair[0].end) as usize)
                .collect();
            let joins = index32(count.saturating_sub(most));
            let choices = (0_u32..1 << gaps.len()).filter(|bits| bits.count_ones() == joins);
            let added = |bits: u32| {
                (0..gaps.len())
                    .filter(|i| bits >> i & 1 == 1)
                    .map(|i| gaps[i])
                    .sum::<usize>()
            };
            let least = choices.map(added).min().unwrap();
            assert_eq!(joined.face_count(), ranges.face_count() + least);
            let is_in = |range: &Range<u32>| {
                joined
                    .ranges
                    .iter()
                    .any(|all| all.start <= range.start && range.end <= all.end)
            };
            assert!(ranges.ranges.iter().all(is_in));
        }
    }
}
