//! Where the records of a file stand.

use std::ops::Range;

use super::error::FileErrorKind;

/// Where the records of one kind stand, in rising order.
///
/// Records that touch and have one length (the rows of most binary files) take no memory.
#[derive(Debug, Clone)]
pub(super) struct Spans {
    count: usize,
    /// Where the first record starts.
    first: usize,
    /// The length of every record while all touch and have one length.
    length: usize,
    /// Once a record breaks this rule: where every record starts, and how long it is.
    uneven: Option<(Vec<usize>, Vec<u32>)>,
}

impl Spans {
    pub(super) fn new() -> Self {
        Self {
            count: 0,
            first: 0,
            length: 0,
            uneven: None,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Adds the next record.
    ///
    /// # Errors
    /// A record of 4 GiB or more.
    #[inline]
    pub(super) fn push(&mut self, span: Range<usize>) -> Result<(), FileErrorKind> {
        let length = u32::try_from(span.len()).map_err(|_| FileErrorKind::OverLimit {
            what: "bytes in one record",
            found: span.len() as u64,
            limit: u64::from(u32::MAX),
        })?;

        if let Some((starts, lengths)) = &mut self.uneven {
            starts.push(span.start);
            lengths.push(length);
        } else if self.count == 0 {
            (self.first, self.length) = (span.start, span.len());
        } else if (span.start, span.len()) != (self.even_start(self.count), self.length) {
            // The rule breaks here: from now on each record is listed.
            let starts = (0..self.count).map(|record| self.even_start(record));
            let starts = starts.chain([span.start]).collect();
            let even = u32::try_from(self.length).expect("checked when it was added");
            let mut lengths = vec![even; self.count];
            lengths.push(length);
            self.uneven = Some((starts, lengths));
        }
        self.count += 1;
        Ok(())
    }

    /// Where a record starts while all touch and have one length.
    #[inline]
    fn even_start(&self, record: usize) -> usize {
        self.first + record * self.length
    }

    /// Adds `count` records of `length` bytes, side by side from `start` on.
    ///
    /// # Errors
    /// A record of 4 GiB or more.
    pub(super) fn push_even(
        &mut self,
        start: usize,
        length: usize,
        count: usize,
    ) -> Result<(), FileErrorKind> {
        let Some(more) = count.checked_sub(1) else {
            return Ok(());
        };
        self.push(start..start + length)?;

        // All have one length so far, and so will the rest.
        if self.even_length() == Some(length) {
            self.count += more;
            return Ok(());
        }

        (1..count).try_for_each(|i| self.push(start + i * length..start + (i + 1) * length))
    }

    /// The length of every record, if all have one and touch; 0 if there are none.
    pub(super) fn even_length(&self) -> Option<usize> {
        self.uneven.is_none().then_some(self.length)
    }

    /// How many records start before `at`.
    pub(super) fn above(&self, at: usize) -> usize {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low.midpoint(high);
            match self.span(middle).start < at {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        low
    }

    /// Whether the same records stand at the same places.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let is_at = |record| self.span(record) == other.span(record);
        self.count == other.count && (0..self.count).all(is_at)
    }

    #[inline]
    pub(super) fn span(&self, record: usize) -> Range<usize> {
        let (start, length) = match &self.uneven {
            Some((starts, lengths)) => (starts[record], lengths[record] as usize),
            None => (self.even_start(record), self.length),
        };
        start..start + length
    }

    /// Where a record starts; `usize::MAX` if there is no such record.
    #[inline]
    pub(super) fn start(&self, record: usize) -> usize {
        match record < self.count {
            true => self.span(record).start,
            false => usize::MAX,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_records_take_no_memory_until_one_differs() {
        let mut spans = Spans::new();
        for span in [10..13, 13..16, 16..19] {
            spans.push(span).unwrap();
        }
        assert!(spans.uneven.is_none());
        assert_eq!(spans.span(2), 16..19);
        spans.push(20..23).unwrap();
        assert!(spans.uneven.is_some());
        let all: Vec<Range<usize>> = (0..spans.len()).map(|i| spans.span(i)).collect();
        assert_eq!(all, [10..13, 13..16, 16..19, 20..23]);
    }

    #[test]
    fn records_pushed_at_once_are_the_same() {
        for (before, after) in [(None, None), (Some(3..7), None), (None, Some(31..40))] {
            let (mut one, mut all) = (Spans::new(), Spans::new());
            for spans in [&mut one, &mut all] {
                before
                    .iter()
                    .for_each(|span| spans.push(span.clone()).unwrap());
            }
            (0..5).for_each(|i| one.push(10 + i * 4..14 + i * 4).unwrap());
            all.push_even(10, 4, 5).unwrap();
            all.push_even(10, 4, 0).unwrap();
            for spans in [&mut one, &mut all] {
                after
                    .iter()
                    .for_each(|span| spans.push(span.clone()).unwrap());
            }
            let spans = |spans: &Spans| (0..spans.len()).map(|i| spans.span(i)).collect::<Vec<_>>();
            assert_eq!(spans(&one), spans(&all));
        }
    }
}
