//! The polygons of a mesh that is stored.
//!
//! `diagonals.rs` writes and reads which edges are diagonals, by chances from `model.rs`; `sides.rs` knows what was said
//! of each side of a face, and what follows from it; `piece.rs` has the bytes as they come.

pub(super) mod diagonals;
mod model;
mod piece;
mod sides;
#[cfg(test)]
mod tests;

pub(super) use piece::PolygonPiece;

use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};

/// The faces of a mesh in an order in which those of each polygon follow each other, as a fan around its first corner:
/// (0, 1, 2), (0, 2, 3) …
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PolygonOrder {
    faces: FaceOrder,
    starts: Vec<u32>,
}

impl PolygonOrder {
    pub(super) fn new(faces: FaceOrder, starts: Vec<u32>) -> Self {
        Self { faces, starts }
    }

    /// The order of the faces, with the corner of each that is its polygon's first.
    #[must_use]
    pub fn faces(&self) -> &FaceOrder {
        &self.faces
    }

    /// Where the faces of each polygon start in that order, and where the last ones end.
    #[must_use]
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// How many polygons there are, triangles among them.
    #[must_use]
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The same polygons, each where another order of the same faces has the first of its faces.
    ///
    /// A triangle begins with the corner that is first in that order, and so does a quad if its diagonal ends there. The
    /// first corner of larger polygons follows from their faces. So a polygon that the order has as a fan stays as it is.
    ///
    /// # Panics
    /// If the order has another number of faces.
    #[must_use]
    pub fn follow(&self, order: &FaceOrder) -> Self {
        assert_eq!(
            order.len(),
            self.faces.len(),
            "face order of another length"
        );

        // The polygon of each face.
        let mut polygon_of = vec![0; order.len()];
        for (polygon, ends) in self.starts.windows(2).enumerate() {
            for &face in &self.faces.new_to_old()[ends[0] as usize..ends[1] as usize] {
                polygon_of[face as usize] = index32(polygon);
            }
        }

        // Each goes where its first face is.
        let mut new_to_old = Vec::with_capacity(order.len());
        let mut rotations = Vec::with_capacity(order.len());
        let mut starts = Vec::with_capacity(self.starts.len());
        starts.push(0);
        let mut is_placed = vec![false; self.len()];
        for (new, &old) in order.new_to_old().iter().enumerate() {
            let polygon = polygon_of[old as usize] as usize;
            if std::mem::replace(&mut is_placed[polygon], true) {
                continue;
            }
            let fan = (self.starts[polygon] as usize)..self.starts[polygon + 1] as usize;
            let fan = fan.map(|at| (self.faces.new_to_old()[at], self.faces.rotation(at)));
            let begun = new_to_old.len();
            for (face, turn) in fan {
                new_to_old.push(face);
                rotations.push(turn);
            }
            let (faces, turns) = (&mut new_to_old[begun..], &mut rotations[begun..]);
            begin_with(faces, turns, old, order.rotation(new));
            starts.push(index32(new_to_old.len()));
        }
        let faces = FaceOrder::new(Permutation::from_algorithm(new_to_old), rotations);
        let faces = faces.expect("a rotation for each face");
        Self { faces, starts }
    }
}

/// Turns the fan of a polygon so that it begins with the corner that one of its faces has first with this turn, if
/// it may begin there.
fn begin_with(faces: &mut [u32], turns: &mut [u8], face: u32, turn: u8) {
    match (faces, turns) {
        ([_], [own]) => *own = turn,
        // The first corner and the third, where the other end of the diagonal is: the last of one, the middle of the
        // other.
        (faces @ [_, _], turns @ [_, _]) => {
            let other_end = [(turns[0] + 2) % 3, (turns[1] + 1) % 3];
            let which = usize::from(faces[1] == face);
            if turn == other_end[which] {
                turns.copy_from_slice(&[other_end[1], other_end[0]]);
                faces.swap(0, 1);
            }
        }
        _ => {}
    }
}
