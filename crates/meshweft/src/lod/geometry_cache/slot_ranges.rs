//! Slots as few ranges.

use std::ops::Range;

/// Ranges of slots or places, rising and apart.
#[derive(Debug, Clone, Default)]
pub(super) struct SlotRanges {
    ranges: Vec<Range<u32>>,
    /// How many others may be between two and still be sent with them.
    pub(super) gap: u32,
}

impl SlotRanges {
    pub(super) fn as_slice(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// The ranges of some slots that rise, or stay.
    pub(super) fn replace(&mut self, slots: impl Iterator<Item = u32>) {
        self.ranges.clear();
        for slot in slots {
            match self.ranges.last_mut() {
                Some(last) if slot <= last.end.saturating_add(self.gap) => last.end = slot + 1,
                _ => self.ranges.push(slot..slot + 1),
            }
        }
    }

    /// One range, or none if it is empty.
    pub(super) fn replace_by_one(&mut self, range: Range<u32>) {
        self.ranges.clear();
        self.ranges.extend((!range.is_empty()).then_some(range));
    }

    /// How many slots the ranges have.
    pub(super) fn count(&self) -> usize {
        self.ranges.iter().map(ExactSizeIterator::len).sum()
    }
}
