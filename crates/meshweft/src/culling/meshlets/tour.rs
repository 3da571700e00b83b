//! Cones that hide from the same eyes, one after the other.

use super::cones::NormalCone;
use super::remaining::Remaining;
use crate::geometry::double::widened;

/// The cones in an order in which each is followed by the one that is hidden from most of the same eyes, of those that are
/// left.
///
/// From far, a cone hides from a cap of directions around its axis, whose share of all is half of 1 less the cutoff. As a point it
/// stands along its axis, as far out as that share: those that never hide are all at the origin.
pub(super) fn tour(cones: &[NormalCone]) -> Vec<u32> {
    let point = |cone: &NormalCone| {
        let share = (1.0 - cone.cutoff).max(0.0);
        cone.axis.map(|x| x * share)
    };
    let points: Vec<[f32; 3]> = cones.iter().map(point).collect();
    let mut remaining = Remaining::new(&points);
    let mut order = Vec::with_capacity(cones.len());
    let mut at = [0.0; 3];
    while let Some(next) = remaining.nearest(at) {
        remaining.take(next);
        order.push(next);
        at = widened(points[next as usize]);
    }
    order
}
