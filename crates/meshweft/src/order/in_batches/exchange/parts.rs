//! Faces in parts, and how many vertices each part has.

use crate::index::index32;
use crate::topology::rows;

/// Most faces at a vertex that may move: the shares of a vertex are gone through for each move.
const MOST_AT_VERTEX: u32 = 256;

/// The corner after each one.
const NEXT_CORNER: [usize; 3] = [1, 2, 0];

/// The corners that one part has at a vertex.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    part: u16,
    corners: u16,
}

/// The shares of a vertex: a piece of [`Parts::shares`].
#[derive(Debug, Clone, Copy, Default)]
struct ShareRow {
    start: u32,
    len: u32,
}

/// What a move changes: vertices that its old part then does not have any more, and vertices that its
/// new part did not have.
#[derive(Debug, Clone, Copy)]
pub(super) struct MoveEffect {
    pub(super) gone: i32,
    pub(super) new: i32,
}

impl MoveEffect {
    /// How many vertices more there are in all parts together.
    #[inline]
    pub(super) fn added(self) -> i32 {
        self.new - self.gone
    }
}

/// A partition of faces.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    faces: &'a [[u32; 3]],
    part_of: Vec<u16>,
    /// The faces that may move.
    movable: Vec<u32>,
    /// How many faces more than at first each part has.
    excess: Vec<i32>,
    /// How many vertices each part may still take.
    room: Vec<i32>,
    /// By vertex.
    rows: Vec<ShareRow>,
    shares: Vec<Share>,
}

impl<'a> Parts<'a> {
    /// Parts of `size` consecutive faces each, none of which has more than `most` vertices. Vertices are
    /// numbered below `vertex_count`.
    ///
    /// Time and space O(vertices + faces).
    pub(super) fn new(faces: &'a [[u32; 3]], vertex_count: usize, size: usize, most: u32) -> Self {
        let starts = rows::starts(vertex_count, faces.as_flattened().iter().copied());
        let rows = starts[..vertex_count].iter();
        let mut parts = Self {
            faces,
            part_of: (0..faces.len()).map(|face| part16(face / size)).collect(),
            movable: Vec::new(),
            excess: vec![0; faces.len() / size],
            room: vec![most.cast_signed(); faces.len() / size],
            rows: rows.map(|&start| ShareRow { start, len: 0 }).collect(),
            shares: vec![Share::default(); 3 * faces.len()],
        };

        // The faces of a part come together, so its share of a vertex is the last one so far.
        for (face, &part) in faces.iter().zip(&parts.part_of.clone()) {
            for &vertex in face {
                match parts.row(vertex).last() {
                    Some(share) if share.part == part => {
                        let row = parts.rows[vertex as usize];
                        parts.shares[(row.start + row.len - 1) as usize].corners += 1;
                    }
                    _ => parts.open(vertex, part),
                }
            }
        }

        let is_few =
            |&vertex: &u32| starts[vertex as usize + 1] - starts[vertex as usize] <= MOST_AT_VERTEX;
        let may_move = |face: &u32| faces[*face as usize].iter().all(is_few);
        parts.movable = (0..index32(faces.len())).filter(may_move).collect();
        parts
    }

    /// The faces that may move, and the part of every face.
    pub(super) fn movable(&self) -> &[u32] {
        &self.movable
    }

    pub(super) fn part_of(&self) -> &[u16] {
        &self.part_of
    }

    /// How many faces more than at first each part has.
    pub(super) fn excess(&self) -> &[i32] {
        &self.excess
    }

    /// The part of a face.
    #[inline]
    pub(super) fn part(&self, face: u32) -> u16 {
        self.part_of[face as usize]
    }

    /// The parts at a vertex.
    #[inline]
    fn row(&self, vertex: u32) -> &[Share] {
        let ShareRow { start, len } = self.rows[vertex as usize];
        &self.shares[start as usize..(start + len) as usize]
    }

    /// The parts at the vertices of a face, its own among them; some more than once.
    #[inline]
    pub(super) fn around(&self, face: u32) -> impl Iterator<Item = u16> {
        let corners = self.faces[face as usize].into_iter();
        corners.flat_map(|vertex| self.row(vertex).iter().map(|share| share.part))
    }

    /// Another part that has two vertices of a face, those of a random edge: where a face has one vertex
    /// only it costs most. `None` if there is none.
    #[inline]
    pub(super) fn neighbour(&self, face: u32, random: u32) -> Option<u16> {
        let corners = self.faces[face as usize];
        let edge = (((random & 0xffff) * 3) >> 16) as usize;
        let [one, other] = [corners[edge], corners[NEXT_CORNER[edge]]].map(|v| self.row(v));
        if one.len() == 1 || other.len() == 1 {
            return None;
        }
        let own = self.part(face);
        let is_common = |&share: &&Share| {
            share.part != own && other.iter().any(|other| other.part == share.part)
        };
        // Mostly there is one; the search starts at a random place.
        let (before, from) = one.split_at(((random >> 16) as usize * one.len()) >> 16);
        let found = from.iter().chain(before).find(is_common);
        found.map(|share| share.part)
    }

    /// What a move of a face to a part changes; `None` if the part has no room.
    #[inline]
    pub(super) fn change(&self, face: u32, to: u16) -> Option<MoveEffect> {
        let from = self.part(face);
        let (mut gone, mut new) = (0, 0);
        for vertex in self.faces[face as usize] {
            new += 1;
            for share in self.row(vertex) {
                new -= i32::from(share.part == to);
                gone += i32::from(share.part == from && share.corners == 1);
            }
        }
        (new <= self.room[usize::from(to)]).then_some(MoveEffect { gone, new })
    }

    /// Moves a face.
    pub(super) fn shift(&mut self, face: u32, to: u16) {
        let from = self.part(face);
        for vertex in self.faces[face as usize] {
            self.leave(vertex, from);
            self.join(vertex, to);
        }
        self.part_of[face as usize] = to;
        self.excess[usize::from(from)] -= 1;
        self.excess[usize::from(to)] += 1;
    }

    /// Takes a corner of a part from a vertex.
    #[inline]
    fn leave(&mut self, vertex: u32, part: u16) {
        let row = &mut self.rows[vertex as usize];
        let shares = &mut self.shares[row.start as usize..(row.start + row.len) as usize];
        let Some(at) = shares.iter().position(|share| share.part == part) else {
            return;
        };
        shares[at].corners -= 1;
        if shares[at].corners == 0 {
            shares.swap(at, shares.len() - 1);
            row.len -= 1;
            self.room[usize::from(part)] += 1;
        }
    }

    /// Adds a corner of a part to a vertex.
    #[inline]
    fn join(&mut self, vertex: u32, part: u16) {
        let ShareRow { start, len } = self.rows[vertex as usize];
        let shares = &mut self.shares[start as usize..(start + len) as usize];
        match shares.iter_mut().find(|share| share.part == part) {
            Some(share) => share.corners += 1,
            None => self.open(vertex, part),
        }
    }

    /// Gives a part its first corner at a vertex.
    fn open(&mut self, vertex: u32, part: u16) {
        let row = &mut self.rows[vertex as usize];
        self.shares[(row.start + row.len) as usize] = Share { part, corners: 1 };
        row.len += 1;
        self.room[usize::from(part)] -= 1;
    }
}

/// The number of a part, of which there are few in a window.
pub(super) fn part16(part: usize) -> u16 {
    debug_assert!(part <= usize::from(u16::MAX));
    #[expect(clippy::cast_possible_truncation, reason = "a window has fewer parts")]
    {
        part as u16
    }
}
