//! How likely an edge is a diagonal.

use super::sides::{EdgeKind, FaceSides, next, previous};
use crate::bits::{AdaptiveBit, Lane, Port};

/// How many kinds of a face there are by its diagonals: none; one; several, which meet at a known corner.
const KINDS: usize = 3;
/// How many things may be known of the edge at one end of a side.
const AROUND: usize = 6;
/// How many ways there are by the faces at an edge and what is left to say of them.
const COARSE: usize = KINDS * KINDS * 3 * 3;
const FINE: usize = COARSE * AROUND * AROUND * 3;

/// How many bits tell more about what is around an edge than the faces at it alone.
const ENOUGH: u16 = 2;

/// How likely an edge is a diagonal, by the faces at it, and by what is around it as well.
pub(super) struct DiagonalModel {
    coarse: Vec<AdaptiveBit>,
    fine: Vec<AdaptiveBit>,
}

impl DiagonalModel {
    pub(super) fn new() -> Self {
        Self {
            coarse: vec![AdaptiveBit::EVEN; COARSE],
            fine: vec![AdaptiveBit::EVEN; FINE],
        }
    }

    /// Whether a side is a diagonal, as it was read or given.
    pub(super) fn code(
        &mut self,
        port: &mut impl Port,
        sides: &FaceSides<'_>,
        side: u32,
        is_diagonal: bool,
    ) -> bool {
        let [coarse, fine] = contexts(sides, side);
        let [coarse, fine] = [&mut self.coarse[coarse], &mut self.fine[fine]];
        let by = if fine.seen() < ENOUGH {
            &*coarse
        } else {
            &*fine
        };
        let is_diagonal = by.code(port, Lane::ALL[0], is_diagonal);
        coarse.see(is_diagonal);
        fine.see(is_diagonal);
        is_diagonal
    }
}

/// The places of the chances of a side.
fn contexts(sides: &FaceSides<'_>, side: u32) -> [usize; 2] {
    let other = sides.other(side);

    // The faces at it, and how much is left to say of them.
    let kind = |side: u32| match (sides.has_centre(side), sides.diagonal_beside(side)) {
        (true, _) => 2,
        (false, Ok(None)) => 0,
        (false, _) => 1,
    };
    let left = |side: u32| {
        let beside = [next(side), previous(side)].into_iter();
        beside
            .filter(|&it| sides.said(it) == EdgeKind::Open)
            .count()
    };
    let mut coarse = 0;
    for (of_side, count) in [
        (kind(side), KINDS),
        (kind(other), KINDS),
        (left(side), 3),
        (left(other), 3),
    ] {
        coarse = coarse * count + of_side;
    }

    // The edges beside it, and those beyond around the same vertex.
    let beyond = |beside: u32, turn: fn(u32) -> u32| match sides.said(beside) {
        EdgeKind::Closed => 0,
        EdgeKind::Open => 1,
        EdgeKind::Diagonal => 2,
        EdgeKind::Border => match sides.said(turn(sides.other(beside))) {
            EdgeKind::Diagonal => 3,
            EdgeKind::Border => 4,
            EdgeKind::Closed | EdgeKind::Open => 5,
        },
    };
    let mut fine = coarse;
    for (of_side, count) in [
        (beyond(previous(side), previous), AROUND),
        (beyond(next(side), next), AROUND),
        (side as usize % 3, 3),
    ] {
        fine = fine * count + of_side;
    }
    [coarse, fine]
}
