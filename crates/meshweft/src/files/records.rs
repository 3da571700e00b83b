//! What readers of record files collect: where the records stand, and the faces they hold.

use std::ops::Range;

use super::error::FileErrorKind;
use crate::limits::{Limits, MAX_FACES, MAX_VERTICES, index32};

/// Where the records of one kind stand, in rising order.
///
/// Records that follow each other without a gap and have one length (the rows of most binary
/// files) take no memory.
#[derive(Debug, Clone)]
pub(super) struct Spans {
    first: usize,
    stride: usize,
    count: usize,
    /// Once a record broke the rule: where each starts, and how long it is.
    each: Option<(Vec<usize>, Vec<u32>)>,
}

impl Spans {
    pub(super) fn new() -> Self {
        Self {
            first: 0,
            stride: 0,
            count: 0,
            each: None,
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
        if let Some((starts, lengths)) = &mut self.each {
            starts.push(span.start);
            lengths.push(length);
        } else if self.count == 0 {
            (self.first, self.stride) = (span.start, span.len());
        } else if span.len() != self.stride || span.start != self.first + self.count * self.stride {
            let mut starts: Vec<usize> = (0..self.count)
                .map(|i| self.first + i * self.stride)
                .collect();
            // The earlier records were as long as the first, whose length fitted.
            let earlier = u32::try_from(self.stride).unwrap_or(u32::MAX);
            let mut lengths = vec![earlier; self.count];
            starts.push(span.start);
            lengths.push(length);
            self.each = Some((starts, lengths));
        }
        self.count += 1;
        Ok(())
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
        if self.even_length() == Some(length) {
            self.count += more;
            return Ok(());
        }
        (1..count).try_for_each(|i| self.push(start + i * length..start + (i + 1) * length))
    }

    /// The length of every record, if all have one and stand side by side.
    pub(super) fn even_length(&self) -> Option<usize> {
        self.each.is_none().then_some(self.stride)
    }

    #[inline]
    pub(super) fn span(&self, record: usize) -> Range<usize> {
        let (start, length) = match &self.each {
            Some((starts, lengths)) => (starts[record], lengths[record] as usize),
            None => (self.first + record * self.stride, self.stride),
        };
        start..start + length
    }

    /// Where record `record` starts; past every byte if there is none.
    #[inline]
    pub(super) fn start(&self, record: usize) -> usize {
        match record < self.count {
            true => self.span(record).start,
            false => usize::MAX,
        }
    }
}

/// Collects the face records of a mesh as triangles.
#[derive(Debug, Default)]
pub(super) struct FaceRecords {
    pub(super) faces: Vec<[u32; 3]>,
    /// See [`MeshEntry::polygons`](super::MeshEntry::polygons); `None` as long as each record is one triangle.
    pub(super) polygons: Option<Vec<u32>>,
    count: usize,
    /// How many records are to come, as far as that is known.
    expected: usize,
}

impl FaceRecords {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Makes room for `count` records that take `bytes` bytes or fewer.
    pub(super) fn reserve(&mut self, count: usize, bytes: usize) {
        self.expected = count;
        // A face is its number of corners and the corners.
        self.faces.reserve(count.min(bytes / 4));
    }

    /// Counts triangles that were added to `faces` past it.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    pub(super) fn count_triangles(&mut self, limits: &Limits) -> Result<(), FileErrorKind> {
        let limit = limits.faces.min(MAX_FACES);
        if self.faces.len() > limit {
            return Err(over_limit("faces", self.faces.len(), limit));
        }
        match &mut self.polygons {
            Some(starts) => {
                let counted = starts.last().copied().unwrap_or(0);
                starts.extend(counted + 1..=index32(self.faces.len()));
                self.count = starts.len() - 1;
            }
            None => self.count = self.faces.len(),
        }
        Ok(())
    }

    /// Adds a record, cut into the fan (0, i, i + 1).
    ///
    /// # Errors
    /// More faces, or more records, than the limit.
    #[inline]
    pub(super) fn push(&mut self, corners: &[u32], limits: &Limits) -> Result<(), FileErrorKind> {
        let limit = limits.faces.min(MAX_FACES);
        let added = corners.len().saturating_sub(2);
        if self.count >= limit || self.faces.len() + added > limit {
            return Err(over_limit("faces", self.faces.len() + added.max(1), limit));
        }
        if let (&[a, b, c], None) = (corners, &self.polygons) {
            self.faces.push([a, b, c]);
            self.count += 1;
            return Ok(());
        }
        if added != 1 && self.polygons.is_none() {
            let mut starts = Vec::with_capacity(self.expected + 1);
            starts.extend(0..=index32(self.count));
            self.polygons = Some(starts);
        }
        if let [first, rest @ ..] = corners {
            let fan = rest.windows(2).map(|edge| [*first, edge[0], edge[1]]);
            self.faces.extend(fan);
        }
        if let Some(starts) = &mut self.polygons {
            starts.push(index32(self.faces.len()));
        }
        self.count += 1;
        Ok(())
    }
}

/// An error if `count` faces are more than the limit.
pub(super) fn check_face_count(count: usize, limits: &Limits) -> Result<(), FileErrorKind> {
    let limit = limits.faces.min(MAX_FACES);
    match count > limit {
        true => Err(over_limit("faces", count, limit)),
        false => Ok(()),
    }
}

/// An error if `count` vertices are more than the limit.
pub(super) fn check_vertex_count(count: usize, limits: &Limits) -> Result<(), FileErrorKind> {
    let limit = limits.vertices.min(MAX_VERTICES);
    match count > limit {
        true => Err(over_limit("vertices", count, limit)),
        false => Ok(()),
    }
}

fn over_limit(what: &'static str, found: usize, limit: usize) -> FileErrorKind {
    let (found, limit) = (found as u64, limit as u64);
    FileErrorKind::OverLimit { what, found, limit }
}

/// A face (or what `what` says) names no vertex; `number` and `corner` from 0, `index` and `last`
/// as the file counts.
pub(super) fn past_the_last_vertex(
    what: &str,
    number: usize,
    corner: usize,
    index: i64,
    last: Option<usize>,
) -> FileErrorKind {
    let but = match last {
        Some(_) if index < 0 => " is below zero".to_owned(),
        Some(last) => format!(" is past the last vertex ({last})"),
        None => ", but the file has no vertices".to_owned(),
    };
    FileErrorKind::malformed(format!(
        "{what} {number}, corner {corner}: index {index}{but}"
    ))
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
        assert!(spans.each.is_none());
        assert_eq!(spans.span(2), 16..19);
        spans.push(20..23).unwrap();
        assert!(spans.each.is_some());
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

    #[test]
    fn polygons_are_fans_and_small_ones_have_no_faces() {
        let limits = Limits::default();
        let mut records = FaceRecords::default();
        for corners in [
            &[0_u32, 1, 2] as &[u32],
            &[3, 4, 5, 6],
            &[7, 8],
            &[],
            &[9, 8, 7],
        ] {
            records.push(corners, &limits).unwrap();
        }
        let fans = [[0, 1, 2], [3, 4, 5], [3, 5, 6], [9, 8, 7]];
        assert_eq!(records.faces, fans);
        assert_eq!(records.polygons, Some(vec![0, 1, 3, 3, 3, 4]));
    }
}
