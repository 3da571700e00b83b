//! Points that are tested in every frame, with what the test needs side by side.

use crate::index::index32;
use crate::lod::view::DetailBound;
use crate::topology::half_edges::NONE;

/// A list of points in any order, from which each can be taken while the list is gone through.
///
/// Going through it is reading memory in order: what a test needs is here, not with the point.
/// Where a point is in it is kept by the caller, in an array of the places of all points.
#[derive(Debug, Clone)]
pub(super) struct TestedPoints {
    entries: Vec<(DetailBound, u32)>,
    /// The place of the first entry.
    first_place: u32,
    /// Entries before this one were gone through.
    seen: usize,
}

impl TestedPoints {
    /// An empty list, whose places begin with a number.
    pub(super) fn new(first_place: u32) -> Self {
        Self {
            entries: Vec::new(),
            first_place,
            seen: 0,
        }
    }

    pub(super) fn points(&self) -> impl ExactSizeIterator<Item = u32> {
        self.entries.iter().map(|&(_, point)| point)
    }

    /// What the test needs of the point at a place.
    pub(super) fn bound(&self, place: u32) -> &DetailBound {
        &self.entries[(place - self.first_place) as usize].0
    }

    /// What the test needs of the point at a place is known better.
    pub(super) fn set_bound(&mut self, place: u32, bound: DetailBound) {
        self.entries[(place - self.first_place) as usize].0 = bound;
    }

    /// Begins again.
    pub(super) fn rewind(&mut self) {
        self.seen = 0;
    }

    /// The next point for which a test holds, which stays in the list; those added meanwhile come last.
    #[inline]
    pub(super) fn next(&mut self, test: impl Fn(&DetailBound) -> bool) -> Option<u32> {
        let rest = &self.entries[self.seen..];
        match rest.iter().position(|(bound, _)| test(bound)) {
            Some(skipped) => {
                self.seen += skipped + 1;
                Some(self.entries[self.seen - 1].1)
            }
            None => {
                self.seen = self.entries.len();
                None
            }
        }
    }

    /// Adds a point; `places` has the place of each.
    pub(super) fn add(&mut self, point: u32, bound: DetailBound, places: &mut [u32]) {
        places[point as usize] = self.place(self.entries.len());
        self.entries.push((bound, point));
    }

    /// Takes a point out. What was not gone through is still to come.
    pub(super) fn take(&mut self, point: u32, places: &mut [u32]) {
        let mut hole = (places[point as usize] - self.first_place) as usize;
        places[point as usize] = NONE;

        // The last one that was gone through takes its place, and the last one of all that one's.
        if hole < self.seen {
            self.seen -= 1;
            self.entries[hole] = self.entries[self.seen];
            if self.entries[hole].1 != point {
                places[self.entries[hole].1 as usize] = self.place(hole);
            }
            hole = self.seen;
        }
        self.entries.swap_remove(hole);
        if let Some(&(_, moved)) = self.entries.get(hole) {
            places[moved as usize] = self.place(hole);
        }
    }

    /// The place of an entry.
    fn place(&self, entry: usize) -> u32 {
        self.first_place + index32(entry)
    }
}
