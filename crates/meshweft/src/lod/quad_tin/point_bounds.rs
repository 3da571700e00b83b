//! Errors and balls that contain those below.

use super::points::PointNode;
use super::triangle::NONE;
use crate::geometry::double::{dot, rounded_up, sub, widened};

/// Makes each vertex as bad and as far as any below it. `apexes` are those of the triangles that each vertex cuts; a vertex comes
/// after its apexes.
///
/// Then what is true of a vertex, that its error is above a limit, or above it as an eye sees it, is true of its apexes:
/// they are drawn, so the two triangles that the vertex cuts are there.
pub(super) fn contain_all_below(nodes: &mut [PointNode], apexes: &[[u32; 2]]) {
    for (vertex, apexes) in apexes.iter().enumerate().rev() {
        let below = nodes[vertex];
        let place = widened(below.position);
        for &apex in apexes.iter().filter(|&&it| it != NONE) {
            let node = &mut nodes[apex as usize];
            let away = sub(widened(node.position), place);
            let distance = dot(away, away).sqrt() * (1.0 + 8.0 * f64::EPSILON);
            node.error = node.error.max(below.error);
            let reach = (distance + f64::from(below.radius)) * (1.0 + f64::EPSILON);
            node.radius = node.radius.max(rounded_up(reach));
        }
    }
}
