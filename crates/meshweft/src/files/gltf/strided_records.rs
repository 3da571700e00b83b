//! Records of fixed size in a storage, at equal distances: what a permutation moves.

use super::buffers::Buffers;

/// Equal-sized pieces of a storage, `stride` bytes apart.
///
/// Two accessors with the same records are the same data, whatever their numbers. So that equal data
/// compares equal, make them by [`new`](Self::new), and keep `stride` the `size` where there are
/// fewer than two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct StridedRecords {
    pub(super) storage: usize,
    pub(super) start: usize,
    pub(super) count: usize,
    pub(super) stride: usize,
    pub(super) size: usize,
}

impl StridedRecords {
    /// `count` records of `size` bytes, `stride` bytes apart (which means nothing below two).
    pub(super) fn new(
        storage: usize,
        start: usize,
        count: usize,
        stride: usize,
        size: usize,
    ) -> Self {
        debug_assert!(count < 2 || stride >= size, "records overlap");
        Self {
            storage,
            start,
            count,
            stride: if count > 1 { stride } else { size },
            size,
        }
    }

    /// The bytes from the first record to the end of the last; `None` if they are too many to count.
    pub(super) fn length(count: usize, stride: usize, size: usize) -> Option<usize> {
        match count.checked_sub(1) {
            Some(last) => last.checked_mul(stride)?.checked_add(size),
            None => Some(0),
        }
    }

    /// The byte after the last record.
    pub(super) fn end(&self) -> usize {
        match self.count {
            0 => self.start,
            count => self.start + (count - 1) * self.stride + self.size,
        }
    }

    /// Whether a byte belongs to both.
    ///
    /// Where it would take long to tell, the answer is yes: records are then left alone.
    pub(super) fn overlap(&self, other: &Self) -> bool {
        let apart = self.storage != other.storage
            || self.count == 0
            || other.count == 0
            || self.end() <= other.start
            || other.end() <= self.start;
        if apart {
            return false;
        }

        let (first, second) = match self.start <= other.start {
            true => (self, other),
            false => (other, self),
        };

        // A single record behaves as if it came again at the other's stride.
        let stride = match (first.count, second.count) {
            (1, 1) => return true,
            (1, _) => second.stride,
            (_, 1) => first.stride,
            _ if first.stride == second.stride => first.stride,
            _ => return true,
        };

        // Both repeat alike, so one stride tells all: `second` must stand in the gap after `first`.
        let distance = (second.start - first.start) % stride;
        distance < first.size || distance + second.size > stride
    }

    /// The bytes of each record, in storage order.
    pub(super) fn of<'a>(&self, buffers: &'a Buffers) -> impl Iterator<Item = &'a [u8]> {
        let bytes = &buffers.storages[self.storage].bytes;
        let Self {
            start,
            count,
            stride,
            size,
            ..
        } = *self;
        (0..count).map(move |i| &bytes[start + i * stride..][..size])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn records(start: usize, count: usize, stride: usize, size: usize) -> StridedRecords {
        StridedRecords {
            storage: 0,
            start,
            count,
            stride,
            size,
        }
    }

    #[test]
    fn overlap_is_what_counting_bytes_gives() {
        let bytes = |r: &StridedRecords| -> Vec<usize> {
            let starts = (0..r.count).map(|i| r.start + i * r.stride);
            starts.flat_map(|start| start..start + r.size).collect()
        };
        let mut all = Vec::new();
        for start in 0..9 {
            for count in 0..4 {
                for (stride, size) in [(4, 1), (4, 3), (4, 4), (5, 2)] {
                    all.push(records(start, count, stride, size));
                }
            }
        }
        for a in &all {
            for b in &all {
                let (of_a, of_b) = (bytes(a), bytes(b));
                let exact = of_a.iter().any(|byte| of_b.contains(byte));
                // Only different distances may be judged too carefully.
                let careful = a.count > 1 && b.count > 1 && a.stride != b.stride;
                match careful {
                    true => assert!(a.overlap(b) || !exact, "{a:?} {b:?}"),
                    false if exact => assert!(a.overlap(b), "{a:?} {b:?}"),
                    false => {}
                }
                assert_eq!(a.overlap(b), b.overlap(a));
            }
        }
        assert!(!records(0, 5, 8, 4).overlap(&records(4, 5, 8, 4)));
        assert!(!records(0, 5, 4, 4).overlap(&records(20, 5, 4, 4)));
    }
}
