//! Four planes around the faces of a cluster.

use crate::geometry::Ball;
use crate::geometry::double::{add, cross, dot, scaled};
use crate::geometry::linear_program::{HalfSpace, farthest_within};

/// Planes `(x, y, z, o)`: no face of the cluster is a front face for an eye `(p, w)` if `(x, y, z) · p + o w` is below 0, by more
/// than rounding, for all four.
pub(super) type Planes = [[f32; 4]; 4];

/// Of a cluster that is always drawn.
pub(super) const ALWAYS: Planes = [[0.0, 0.0, 0.0, 1.0]; 4];

/// Whether [`around`] may have made a plane within this reach.
pub(super) fn is_within([x, y, z, offset]: [f32; 4], reach: f32) -> bool {
    let numbers = [x, y, z, offset, reach].map(f64::from);
    let [x, y, z, offset, reach] = numbers;
    // An apex is a corner of a box at most, moved back; all is rounded.
    let farthest = 2.0 * APEX_REACH * reach;
    let is_constant = [x, y, z] == [0.0; 3] && offset.abs() == 1.0;
    // Also false for NaN.
    is_constant || x * x + y * y + z * z <= 1.0 + 1e-6 && offset.abs() <= farthest
}

/// How many ways to turn the normals' rectangle are tried.
const TURNS: u32 = 8;

/// How far an apex may be from the origin, in parts of the reach of all positions.
pub(super) const APEX_REACH: f64 = 4.0;

/// Four planes around faces that can be front faces only in front of their planes, which all are at most `reach` from the
/// origin.
///
/// Lines of sight to the front of any face of a cluster begin in front of its plane. In the plane at distance 1 along an axis
/// the normals have a bounding rectangle; each normal is a sum of the four at its corners, with factors of at least 0. A point
/// behind the planes of all faces, the *apex*, is put as far along the axis as there is one. If an eye is behind the planes
/// at the apex with these four normals, it is behind each face's: `n · (p − x) <= n · (p − apex) = Σ λ m · (p − apex)`.
///
/// Of the ways to turn the rectangle that one is taken from which the fewest `eyes` see something.
///
/// # Complexity
/// Time O(planes), expected, + O(eyes); space O(planes).
pub(super) fn around(planes: &mut [HalfSpace], reach: f64, eyes: &[[f64; 4]]) -> Planes {
    // The axis, which must be in front of each face.
    if planes.is_empty() {
        return [[0.0, 0.0, 0.0, -1.0]; 4];
    }
    let normals = planes.iter().map(|plane| plane.normal);
    let Some(Ball { center, .. }) = Ball::around(normals.clone()) else {
        return ALWAYS;
    };
    let length = dot(center, center).sqrt();
    let axis = scaled(center, 1.0 / length);
    let least = |least: f64, normal| least.min(dot(normal, axis));
    if !(length > 1e-6 && normals.clone().fold(1.0, least) > 1e-4) {
        return ALWAYS;
    }

    // The apex. Wherever the search ends, it is moved back behind all planes.
    let Some(apex) = farthest_within(planes, axis, APEX_REACH * reach) else {
        return ALWAYS;
    };
    let over =
        |plane: &HalfSpace| (dot(plane.normal, apex) - plane.offset) / dot(plane.normal, axis);
    let back = planes.iter().map(over).fold(0.0, f64::max);
    if back >= reach {
        return ALWAYS;
    }
    let apex = add(apex, scaled(axis, -back));

    // The rectangle.
    let across = most_across(axis);
    let up = cross(axis, across);
    let seen_by = |planes: &Planes| eyes.iter().filter(|&&eye| is_seen(planes, eye)).count();
    let turned = (0..TURNS).map(|turn| {
        let (cosine, sine) = TURNED[turn as usize];
        let across_now = add(scaled(across, cosine), scaled(up, sine));
        let up_now = add(scaled(up, cosine), scaled(across, -sine));
        rectangle(planes, axis, [across_now, up_now], apex)
    });
    let best = turned.min_by(|(a, area_a), (b, area_b)| {
        let by_eyes = seen_by(a).cmp(&seen_by(b));
        by_eyes.then(area_a.total_cmp(area_b))
    });
    best.map_or(ALWAYS, |(planes, _)| planes)
}

/// The cosines and sines of eighths of a right angle.
const TURNED: [(f64, f64); TURNS as usize] = [
    (1.0, 0.0),
    (0.980_785_280_403_230_4, 0.195_090_322_016_128_27),
    (0.923_879_532_511_286_8, 0.382_683_432_365_089_8),
    (0.831_469_612_302_545_2, 0.555_570_233_019_602_2),
    (
        std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    ),
    (0.555_570_233_019_602_2, 0.831_469_612_302_545_2),
    (0.382_683_432_365_089_8, 0.923_879_532_511_286_8),
    (0.195_090_322_016_128_27, 0.980_785_280_403_230_4),
];

/// A direction across another.
fn most_across(axis: [f64; 3]) -> [f64; 3] {
    let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs()));
    let mut unit = [0.0; 3];
    unit[least.unwrap_or(0)] = 1.0;
    let across = cross(axis, unit);
    scaled(across, 1.0 / dot(across, across).sqrt())
}

/// The planes at the corners of the normals' rectangle, and its area.
fn rectangle(
    planes: &[HalfSpace],
    axis: [f64; 3],
    sides: [[f64; 3]; 2],
    apex: [f64; 3],
) -> (Planes, f64) {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for plane in planes {
        let along = dot(plane.normal, axis);
        for (i, side) in sides.iter().enumerate() {
            let at = dot(plane.normal, *side) / along;
            low[i] = low[i].min(at);
            high[i] = high[i].max(at);
        }
    }
    let corner = |x: f64, y: f64| {
        let normal = add(axis, add(scaled(sides[0], x), scaled(sides[1], y)));
        let [a, b, c] = scaled(normal, 1.0 / dot(normal, normal).sqrt());
        [a, b, c, -dot([a, b, c], apex)].map(rounded)
    };
    let corners = [
        corner(low[0], low[1]),
        corner(high[0], low[1]),
        corner(high[0], high[1]),
        corner(low[0], high[1]),
    ];
    (corners, (high[0] - low[0]) * (high[1] - low[1]))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is within the margin of what is compared"
)]
pub(super) fn rounded(x: f64) -> f32 {
    x as f32
}

/// Whether an eye is in front of one of the planes, or nearly so.
fn is_seen(planes: &Planes, [x, y, z, w]: [f64; 4]) -> bool {
    planes.iter().any(|plane| {
        let [a, b, c, o] = plane.map(f64::from);
        a * x + b * y + c * z + o * w >= 0.0
    })
}
