//! The points inside of each triangle, level by level.

use std::ops::Range;

use crate::index::index32;

/// An input point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ListedPoint {
    pub(super) position: [f32; 3],
    /// Its number in the input.
    pub(super) source: u32,
}

/// The lists of the triangles of one level, one after the other, and those of the next level.
///
/// Triangles of earlier levels that are still whole have no points: so two arrays are enough, written and read from start to end.
#[derive(Debug, Clone, Default)]
pub(super) struct PointLists {
    now: Vec<ListedPoint>,
    next: Vec<ListedPoint>,
    /// The points of four triangles that are made.
    parts: [Vec<ListedPoint>; 4],
}

/// Where the points of a triangle are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct ListRange {
    start: u32,
    count: u32,
}

impl ListRange {
    pub(super) fn len(self) -> usize {
        self.count as usize
    }

    fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.count as usize
    }
}

impl PointLists {
    /// One list for each part of the coarsest triangles; `part` says in which a point is.
    pub(super) fn new(
        points: Vec<ListedPoint>,
        part: impl Fn(&ListedPoint) -> usize,
    ) -> (Self, [ListRange; 4]) {
        let all = ListRange {
            start: 0,
            count: index32(points.len()),
        };
        let mut lists = Self {
            now: points,
            ..Self::default()
        };
        let ranges = lists.divide([all, ListRange::default()], part);
        lists.go_on();
        (lists, ranges)
    }

    /// The points of a triangle of this level.
    pub(super) fn points(&self, list: ListRange) -> &[ListedPoint] {
        &self.now[list.range()]
    }

    /// Writes the points of two triangles to the lists of four of the next level. Points whose part is none of these are left out.
    pub(super) fn divide(
        &mut self,
        lists: [ListRange; 2],
        part: impl Fn(&ListedPoint) -> usize,
    ) -> [ListRange; 4] {
        for list in lists {
            for point in &self.now[list.range()] {
                if let Some(points) = self.parts.get_mut(part(point)) {
                    points.push(*point);
                }
            }
        }
        let next = &mut self.next;
        self.parts.each_mut().map(|points| {
            // Empty lists stay valid on every later level.
            let start = if points.is_empty() { 0 } else { next.len() };
            let list = ListRange {
                start: index32(start),
                count: index32(points.len()),
            };
            next.append(points);
            list
        })
    }

    /// The next level becomes this one.
    pub(super) fn go_on(&mut self) {
        std::mem::swap(&mut self.now, &mut self.next);
        self.next.clear();
    }
}
