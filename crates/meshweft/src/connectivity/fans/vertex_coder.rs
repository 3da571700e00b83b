//! What is coded with each vertex, between the faces.

use super::fan_model::{FanModel, Outlook};
use super::known_faces::{KnownFaces, NONE};
use super::model::TableModel;
use super::traversal::{FanTurn, Gap};
use crate::bits::Port;

/// Codes something with each vertex, when it is met.
pub(crate) trait VertexCoder {
    /// How likely faces are.
    type Model: FanModel;

    /// How many lanes are used beyond that of the faces.
    const LANES: usize;

    /// Codes what belongs to the next vertex: to one of the source for who writes. It lies opposite to the third
    /// of three vertices across the edge of the first and second, as far as that is known. For the first vertex of
    /// all, they are itself.
    fn code<P: Port>(&mut self, port: &mut P, source: u32, near: [u32; 3]);

    /// Codes what was put off, if anything was.
    fn settle<P: Port>(&mut self, _port: &mut P) {}

    /// About this number of vertices comes next.
    fn expect(&mut self, _vertices: usize) {}

    /// How far a vertex is from where a new one would be expected beyond an edge, as [`Outlook::reach`]. The edge's
    /// vertices come first, then the third vertex of the known face there.
    fn reach(&self, edge: [u32; 2], across: u32, vertex: u32) -> u8;

    /// How a gap's root and both ends lie, the third vertex of the known face at its edge being known or not.
    fn outlook(&self, gap: [u32; 3], across: Option<u32>) -> Outlook;
}

/// How the vertices of a gap lie, if the model asks for it.
#[inline]
pub(super) fn outlook<V: VertexCoder>(at_vertices: &V, gap: &Gap, known: &KnownFaces) -> Outlook {
    if !V::Model::LOOKS {
        return Outlook::default();
    }
    let across = Some(gap.across(known)).filter(|&across| across != NONE);
    at_vertices.outlook([gap.root, gap.from, gap.to], across)
}

/// As [`Outlook::reach`], of the neighbours on the front before and after the gap.
#[inline]
pub(super) fn beyond<V: VertexCoder>(at_vertices: &V, gap: &Gap, known: &KnownFaces) -> [u8; 2] {
    if !V::Model::LOOKS || gap.is_backward {
        return [0; 2];
    }
    let across = gap.across(known);
    let beyond = [FanTurn::Before(1), FanTurn::After(1)];
    beyond.map(|turn| reach(at_vertices, gap, across, turn.vertex(gap, known)))
}

#[inline]
fn reach<V: VertexCoder>(at_vertices: &V, gap: &Gap, across: u32, vertex: u32) -> u8 {
    match across == NONE || vertex == NONE {
        true => 0,
        false => at_vertices.reach([gap.root, gap.from], across, vertex),
    }
}

/// Faces only.
impl VertexCoder for () {
    type Model = TableModel;

    const LANES: usize = 0;

    #[inline]
    fn code<P: Port>(&mut self, _: &mut P, _: u32, _: [u32; 3]) {}

    fn reach(&self, _: [u32; 2], _: u32, _: u32) -> u8 {
        0
    }

    fn outlook(&self, _: [u32; 3], _: Option<u32>) -> Outlook {
        Outlook::default()
    }
}
