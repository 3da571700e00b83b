//! Removals by half-edge collapses, as they are stored: what leaves, and which corners change.

use crate::index::index32;

/// A vertex that leaves, and the one that takes its corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SidePair {
    /// The vertex that no face uses any more.
    pub from: u32,
    /// The vertex that its corners get.
    pub to: u32,
}

/// Removals one after the other, in four flat arrays: about 46 bytes for the removal of a vertex with six
/// faces.
#[derive(Debug, Clone, Default)]
pub(super) struct Records {
    ends: Vec<Ends>,
    /// Each with the end of its corners.
    pairs: Vec<(SidePair, u32)>,
    leaving: Vec<u32>,
    corners: Vec<u32>,
}

/// Where the parts of a record end.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Ends {
    pairs: u32,
    leaving: u32,
    error: f32,
}

/// The removal of a point: all its vertices go where one neighbour stands.
#[derive(Debug, Clone, Copy)]
pub struct Collapse<'a> {
    /// Each with the end of its corners in the list of all.
    pairs: &'a [(SidePair, u32)],
    first_corner: u32,
    corners: &'a [u32],
    leaving: &'a [u32],
    error: f32,
}

impl<'a> Collapse<'a> {
    /// The vertices that leave, each with the one that takes its corners. Several where the point has
    /// several vertices; none where a record only takes faces away.
    pub fn pairs(self) -> impl DoubleEndedIterator<Item = SidePair> + 'a {
        self.pairs.iter().map(|&(pair, _)| pair)
    }

    /// The faces that leave.
    #[must_use]
    pub fn leaving_faces(self) -> &'a [u32] {
        self.leaving
    }

    /// The corners that change, pair by pair: each is three times its face, and 0, 1 or 2.
    pub fn corners(self) -> impl Iterator<Item = (SidePair, &'a [u32])> {
        let starts =
            std::iter::once(self.first_corner).chain(self.pairs.iter().map(|&(_, end)| end));
        self.pairs
            .iter()
            .zip(starts)
            .map(move |(&(pair, end), start)| {
                let at = |corner: u32| (corner - self.first_corner) as usize;
                (pair, &self.corners[at(start)..at(end)])
            })
    }

    /// Whether a part leaves as a whole: nothing takes the corners of its vertices.
    #[must_use]
    pub fn is_of_part(self) -> bool {
        self.pairs().any(|pair| pair.from == pair.to)
    }

    /// How far the surface after this removal is from that at full resolution, as an estimate in units of
    /// the positions; never less than that of a removal before.
    #[must_use]
    pub fn error(self) -> f32 {
        self.error
    }
}

impl Records {
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn get(&self, record: usize) -> Collapse<'_> {
        let end = self.ends[record];
        let start = record
            .checked_sub(1)
            .map_or(Ends::default(), |before| self.ends[before]);
        let first_corner = (start.pairs as usize)
            .checked_sub(1)
            .map_or(0, |before| self.pairs[before].1);
        let pairs = &self.pairs[start.pairs as usize..end.pairs as usize];
        let last_corner = pairs.last().map_or(first_corner, |&(_, end)| end);
        Collapse {
            pairs,
            first_corner,
            corners: &self.corners[first_corner as usize..last_corner as usize],
            leaving: &self.leaving[start.leaving as usize..end.leaving as usize],
            error: end.error,
        }
    }

    /// How many corners change in all records.
    pub(super) fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// How many faces left in the first `records`.
    pub(super) fn left_after(&self, records: usize) -> usize {
        records
            .checked_sub(1)
            .map_or(0, |last| self.ends[last].leaving as usize)
    }

    /// The fewest records after which as many faces left.
    pub(super) fn records_for(&self, faces: usize) -> usize {
        if faces == 0 {
            return 0;
        }
        let before = self
            .ends
            .partition_point(|end| (end.leaving as usize) < faces);
        (before + 1).min(self.len())
    }

    /// The most records none of which has a larger error.
    pub(super) fn records_within(&self, error: f32) -> usize {
        self.ends.partition_point(|end| end.error <= error)
    }

    /// A corner that goes with the next pair.
    pub(super) fn push_corner(&mut self, corner: u32) {
        self.corners.push(corner);
    }

    /// A pair; the corners since the last one are its own.
    pub(super) fn push_pair(&mut self, pair: SidePair) {
        self.pairs.push((pair, index32(self.corners.len())));
    }

    /// A face that leaves.
    pub(super) fn push_leaving(&mut self, face: u32) {
        self.leaving.push(face);
    }

    /// The record is complete.
    pub(super) fn finish(&mut self, error: f32) {
        self.ends.push(Ends {
            pairs: index32(self.pairs.len()),
            leaving: index32(self.leaving.len()),
            error,
        });
    }
}
