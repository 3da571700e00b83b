//! The vertices at a point, and where they go.

use super::fan::Fan;
use super::remaining::RemainingMesh;
use crate::progressive::records::SidePair;

/// Pairs each vertex at the point of a fan with the one at `to` that has a leaving face in common with it.
/// `false` where a vertex has none or two: one of its attributes would have to change.
pub(super) fn pair(
    rest: &RemainingMesh<'_>,
    fan: &Fan,
    to: u32,
    pairs: &mut Vec<SidePair>,
) -> bool {
    pairs.clear();
    for face in &fan.faces {
        let Some(other) = face.corner_at(to) else {
            continue;
        };
        let (from, to) = (rest.side(face.corner), rest.side(other));
        match pairs.iter().find(|pair| pair.from == from) {
            Some(pair) if pair.to == to => {}
            Some(_) => return false,
            None => pairs.push(SidePair { from, to }),
        }
    }
    let is_paired = |side: u32| pairs.iter().any(|pair| pair.from == side);
    rest.is_seamless()
        || fan
            .faces
            .iter()
            .all(|face| is_paired(rest.side(face.corner)))
}
