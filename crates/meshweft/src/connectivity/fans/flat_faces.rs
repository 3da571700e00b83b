//! Faces that name a vertex twice: they have no fans, and are written after all others.

use super::model::LANE;
use crate::bits::{AdaptiveTable, DecodeErrorKind, NumberCoder, Port};
use crate::faces::turned;

/// Which of its two vertices a face names twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Repeated {
    /// There is one vertex only.
    Point,
    Lesser,
    Greater,
}

impl Repeated {
    const ALL: [Self; 3] = [Self::Point, Self::Lesser, Self::Greater];
}

/// A face as it comes back, and how far the one that was given is turned: its least vertex is first, and a second time
/// if it is there twice.
pub(super) fn in_place(face: [u32; 3]) -> ([u32; 3], u8) {
    let turns = [0, 1, 2].map(|rotation| (turned(face, rotation), rotation));
    turns.into_iter().min().unwrap_or((face, 0))
}

/// Whether a face names a vertex twice.
pub(super) fn is_flat([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Codes such faces, sorted as they come back, each by the one before.
#[derive(Debug)]
pub(super) struct FlatFaces {
    last: (Repeated, [u32; 2]),
    /// Whether the last face has the least vertex of the one before it.
    stays: bool,
    /// How far it is to the least vertex, by whether it stayed the last time.
    steps: [NumberCoder; 2],
    /// By the kind of the face before.
    kinds: [AdaptiveTable; 3],
    /// How far the other vertex is from the least one, and from that of a face before of the same vertex and kind.
    others: [NumberCoder; 2],
}

impl FlatFaces {
    pub(super) fn new() -> Self {
        Self {
            last: (Repeated::Point, [0; 2]),
            stays: false,
            steps: [NumberCoder::NEW; 2],
            kinds: [AdaptiveTable::EVEN; 3],
            others: [NumberCoder::NEW; 2],
        }
    }

    /// The face that was read, or the one that was given, which is not before the last one.
    ///
    /// # Errors
    /// What was read is not such a face, or has a vertex beyond the number of vertices.
    pub(super) fn code(
        &mut self,
        port: &mut impl Port,
        [a, b, c]: [u32; 3],
        vertex_count: usize,
    ) -> Result<[u32; 3], DecodeErrorKind> {
        let is_there = |vertex: u32| match (vertex as usize) < vertex_count {
            true => Ok(vertex),
            false => Err(DecodeErrorKind::NoSuchVertex { vertex }),
        };

        // The least vertex.
        let (last_kind, [last_least, last_other]) = self.last;
        let steps = &mut self.steps[usize::from(self.stays)];
        let step = steps.code(port, a.wrapping_sub(last_least));
        let least = is_there(last_least.saturating_add(step))?;
        self.stays = step == 0;

        // Which is there twice.
        let kind = match () {
            () if a == c => Repeated::Point,
            () if a == b => Repeated::Lesser,
            () => Repeated::Greater,
        };
        let table = &mut self.kinds[last_kind as usize];
        let symbol = port.code(LANE, table, kind as usize);
        table.see(symbol);
        let kind = Repeated::ALL.get(symbol).copied();
        let kind = kind.ok_or(DecodeErrorKind::Damaged)?;

        // The other vertex.
        let mut other = least;
        if kind != Repeated::Point {
            let follows = self.stays && kind == last_kind;
            let after = least.saturating_add(1);
            let from = if follows { last_other } else { after };
            let step = self.others[usize::from(follows)].code(port, c.wrapping_sub(from));
            other = is_there(from.saturating_add(step))?;
        }
        self.last = (kind, [least, other]);
        Ok(match kind {
            Repeated::Point => [least; 3],
            Repeated::Lesser => [least, least, other],
            Repeated::Greater => [least, other, other],
        })
    }
}
