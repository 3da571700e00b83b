//! The sides of faces, and what was said of them.

use super::PolygonOrder;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};
use crate::topology::rows::Rows;

/// Stands for a side without another face.
const NONE: u32 = u32::MAX;

/// What was said of a side of a face, and so of its edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EdgeKind {
    /// It cannot be a diagonal.
    Closed,
    /// Nothing yet.
    Open,
    Border,
    Diagonal,
}

/// The sides of all faces, three a face: the first goes from its first corner to its second.
#[derive(Debug)]
pub(super) struct FaceSides<'a> {
    faces: &'a [[u32; 3]],
    /// The other side at the same edge, where there is one, which goes the other way.
    others: Vec<u32>,
    said: Vec<EdgeKind>,
    /// The corner of each face at which its diagonals meet, where that is known.
    centres: Vec<Option<u8>>,
}

/// The next side of the same face, and the one before.
pub(super) fn next(side: u32) -> u32 {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

pub(super) fn previous(side: u32) -> u32 {
    next(next(side))
}

impl<'a> FaceSides<'a> {
    pub(super) fn new(faces: &'a [[u32; 3]], vertex_count: usize) -> Self {
        // The sides of an edge follow each other in the row of its lesser vertex.
        let sides = faces.iter().enumerate().flat_map(|(face, &[a, b, c])| {
            let is_flat = a == b || b == c || c == a;
            let sides = [(a, b), (b, c), (c, a)].into_iter().zip(0..);
            sides
                .filter(move |_| !is_flat)
                .map(move |((from, to), side)| (from.min(to), 3 * index32(face) + side))
        });
        let mut rows = Rows::by_counting(vertex_count, sides);
        let corners = faces.as_flattened();
        let ends = |side: u32| [corners[side as usize], corners[next(side) as usize]];
        let greater = |side: &u32| ends(*side).into_iter().max();
        let mut others = vec![NONE; corners.len()];
        for row in rows.rows_mut() {
            row.sort_unstable_by_key(greater);
            for sides in row.chunk_by(|a, b| greater(a) == greater(b)) {
                let &[a, b] = sides else { continue };
                if ends(a)[0] != ends(b)[0] {
                    (others[a as usize], others[b as usize]) = (b, a);
                }
            }
        }
        let said = |&other: &u32| match other {
            NONE => EdgeKind::Closed,
            _ => EdgeKind::Open,
        };
        Self {
            faces,
            said: others.iter().map(said).collect(),
            others,
            centres: vec![None; faces.len()],
        }
    }

    pub(super) fn said(&self, side: u32) -> EdgeKind {
        self.said[side as usize]
    }

    pub(super) fn other(&self, side: u32) -> u32 {
        self.others[side as usize]
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.said.len()
    }

    /// Whether it is known where the diagonals of the face of a side meet.
    pub(super) fn has_centre(&self, side: u32) -> bool {
        self.centres[side as usize / 3].is_some()
    }

    /// The vertex from which a side goes.
    fn vertex(&self, side: u32) -> u32 {
        self.faces.as_flattened()[side as usize]
    }

    /// The diagonal that the face of a side has beside that, and the corner where they meet.
    ///
    /// # Errors
    /// There are two.
    pub(super) fn diagonal_beside(&self, side: u32) -> Result<Option<[u32; 2]>, ()> {
        let [after, before] = [next(side), previous(side)];
        let is_diagonal = |side| self.said(side) == EdgeKind::Diagonal;
        match [after, before].map(is_diagonal) {
            [false, false] => Ok(None),
            [true, false] => Ok(Some([after, after])),
            [false, true] => Ok(Some([before, side])),
            [true, true] => Err(()),
        }
    }

    /// The vertex at which the diagonals of a face would meet if this side were one; no vertex if it were the only
    /// one.
    ///
    /// # Errors
    /// They would not all meet.
    fn centre_with(&self, side: u32) -> Result<Option<u32>, ()> {
        let Some([_, corner]) = self.diagonal_beside(side)? else {
            return Ok(None);
        };
        let known = self.centres[side as usize / 3];
        match known.is_none_or(|known| u32::from(known) == corner % 3) {
            true => Ok(Some(self.vertex(corner))),
            false => Err(()),
        }
    }

    /// Whether a side may be a diagonal, by those that are known.
    pub(super) fn may_be_diagonal(&self, side: u32) -> bool {
        match (self.centre_with(side), self.centre_with(self.other(side))) {
            (Ok(Some(a)), Ok(Some(b))) => a == b,
            (Ok(_), Ok(_)) => true,
            _ => false,
        }
    }

    /// Says what an edge is.
    pub(super) fn say(&mut self, side: u32, is_diagonal: bool) {
        let other = self.other(side);
        let said = match is_diagonal {
            true => EdgeKind::Diagonal,
            false => EdgeKind::Border,
        };
        if is_diagonal {
            // Where they meet, of the faces on both sides and of those beyond: farther ones know it.
            let both = [side, other];
            let centre = both.map(|side| self.centre_with(side).ok().flatten());
            let beyond = both.map(|side| self.diagonal_beside(side).ok().flatten());
            if let [Some(centre), _] | [None, Some(centre)] = centre {
                let beyond = beyond.into_iter().flatten();
                let beyond = beyond.map(|[diagonal, _]| self.other(diagonal));
                let beyond: Vec<u32> = beyond.collect();
                for side in both.into_iter().chain(beyond) {
                    self.meet(side / 3, centre);
                }
            }
        }
        self.said[side as usize] = said;
        self.said[other as usize] = said;
    }

    /// The diagonals of a face meet at a vertex of it.
    fn meet(&mut self, face: u32, vertex: u32) {
        let corners = self.faces[face as usize].into_iter().zip(0..);
        let centre = corners.filter(|&(corner, _)| corner == vertex);
        self.centres[face as usize] = centre.map(|(_, corner)| corner).next();
    }

    /// The polygons, each where its first face is.
    ///
    /// # Errors
    /// Faces go all around a vertex, so that none of them is first.
    pub(super) fn polygons(&self) -> Result<PolygonOrder, ()> {
        let mut faces = Vec::with_capacity(self.faces.len());
        let mut turns = Vec::with_capacity(self.faces.len());
        let mut starts = vec![0];
        let mut is_placed = vec![false; self.faces.len()];
        for face in 0..index32(self.faces.len()) {
            if is_placed[face as usize] {
                continue;
            }

            // The side with which its first face leaves the vertex where all diagonals meet.
            let begin = self.leaves_centre(face);
            let mut side = begin;
            while self.said(side) == EdgeKind::Diagonal {
                side = next(self.other(side));
                if side == begin {
                    return Err(());
                }
            }

            // Around that vertex.
            loop {
                faces.push(side / 3);
                turns.push(u8::try_from(side % 3).unwrap_or(0));
                is_placed[side as usize / 3] = true;
                let comes_back = previous(side);
                if self.said(comes_back) != EdgeKind::Diagonal {
                    break;
                }
                side = self.other(comes_back);
            }
            starts.push(index32(faces.len()));
        }
        let faces = FaceOrder::new(Permutation::from_algorithm(faces), turns);
        let faces = faces.map_err(|_| ())?;
        Ok(PolygonOrder::new(faces, starts))
    }

    /// The side of a face that leaves the vertex where the diagonals of its polygon meet; of two such vertices the
    /// lesser; of a face without diagonals its first side.
    fn leaves_centre(&self, face: u32) -> u32 {
        let sides = [3 * face, 3 * face + 1, 3 * face + 2];
        if let Some(corner) = self.centres[face as usize] {
            return sides[usize::from(corner)];
        }
        let diagonal = sides
            .into_iter()
            .find(|&side| self.said(side) == EdgeKind::Diagonal);
        match diagonal {
            None => sides[0],
            Some(side) if self.vertex(side) < self.vertex(next(side)) => side,
            Some(side) => next(side),
        }
    }
}
