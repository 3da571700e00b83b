//! Which edges are diagonals of polygons, in few bits.
//!
//! An edge may be one where it has two faces that go different ways. The polygons that a reader cuts into fans have
//! all diagonals at one corner, so a face has two at most, and what is said of the first says much of the second. Edges are
//! gone through by the faces as they are stored, each at the first of its faces: what is left to say of a mesh of
//! quads is then little, as each of its faces has one diagonal.

use super::PolygonOrder;
use super::model::DiagonalModel;
use super::sides::{EdgeKind, FaceSides};
use crate::bits::{DecodeError, DecodeErrorKind, Port, RansDecoder, RansEncoder};
use crate::index::index32;
use crate::permutation::FaceOrder;

impl FaceSides<'_> {
    /// Says of each edge whether it is a diagonal, as it is read or as given by its first side.
    pub(super) fn code(&mut self, port: &mut impl Port, is_diagonal: impl Fn(u32) -> bool) {
        let mut model = DiagonalModel::new();
        for side in 0..index32(self.len()) {
            if self.said(side) == EdgeKind::Open {
                let is_diagonal =
                    self.may_be_diagonal(side) && model.code(port, self, side, is_diagonal(side));
                self.say(side, is_diagonal);
            }
        }
    }
}

/// What was written of the polygons of a mesh.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(in crate::compression) struct WrittenPolygons {
    /// Empty if there are none to be written.
    pub(in crate::compression) bytes: Vec<u8>,
    /// How many polygons of more than three corners come back.
    pub(in crate::compression) kept: usize,
    /// How many of them come back as their triangles.
    pub(in crate::compression) cut: usize,
}

/// Writes which edges of the faces, as they are stored, are diagonals of polygons: of the faces of the source, polygon
/// `i` is `starts[i]..starts[i + 1]`.
pub(in crate::compression) fn write(
    source: &[[u32; 3]],
    starts: &[u32],
    order: &FaceOrder,
    stored: &[[u32; 3]],
    vertex_count: usize,
) -> WrittenPolygons {
    let mut sides = FaceSides::new(stored, vertex_count);
    let new = order.permutation().old_to_new();
    let mut written = WrittenPolygons::default();

    // Where a corner of a source's face is stored.
    let stored_side = |old: u32, corner: u8| {
        let new = new[old as usize];
        let turn = order.rotation(new as usize);
        3 * new + u32::from((corner + 3 - turn) % 3)
    };
    let mut is_diagonal = vec![false; 3 * stored.len()];
    for ends in starts.windows(2).filter(|ends| ends[1] - ends[0] > 1) {
        let pairs = || (ends[0]..ends[1] - 1).map(|face| [face, face + 1]);
        let is_fan = |[a, b]: [u32; 2]| {
            let [a_source, b_source] = [source[a as usize], source[b as usize]];
            let (leaves, comes_back) = (stored_side(b, 0), stored_side(a, 2));
            a_source[0] == b_source[0] && sides.other(leaves) == comes_back
        };
        match pairs().all(is_fan) {
            true => written.kept += 1,
            false => {
                written.cut += 1;
                continue;
            }
        }
        for [a, b] in pairs() {
            is_diagonal[stored_side(b, 0) as usize] = true;
            is_diagonal[stored_side(a, 2) as usize] = true;
        }
    }

    if written.kept > 0 {
        let mut port = RansEncoder::new(1);
        sides.code(&mut port, |side| is_diagonal[side as usize]);
        written.bytes = port.finish();
    }
    written
}

/// The polygons of the faces, as they are stored, from what [`write()`] wrote.
pub(in crate::compression) fn read(
    bytes: &[u8],
    faces: &[[u32; 3]],
    vertex_count: usize,
) -> Result<PolygonOrder, DecodeError> {
    let mut port = RansDecoder::new(1);
    port.begin(bytes);
    let mut sides = FaceSides::new(faces, vertex_count);
    sides.code(&mut port, |_| false);
    port.finish()?;
    sides
        .polygons()
        .map_err(|()| port.error(DecodeErrorKind::Damaged))
}
