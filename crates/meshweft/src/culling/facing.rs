//! From where a face can be a front face.

use crate::geometry::double::{add, cross, dot, scaled, sub};
use crate::geometry::linear_program::HalfSpace;

/// A normal is known if it is at least this part of the products that it comes from: then rounding turns it by less than 2⁻²⁰.
const LEAST_NORMAL: f64 = 1.0 / (1_u64 << 30) as f64;

/// What rounding may do to an angle, to the sine of one, and to a distance in parts of what it is computed from, many times
/// over.
pub(super) const MARGIN: f64 = 4e-6;

/// The normal of length 1 of a face, if it is known.
pub(super) fn normal([a, b, c]: [[f64; 3]; 3]) -> Option<[f64; 3]> {
    let (u, v) = (sub(b, a), sub(c, a));
    let normal = cross(u, v);
    let length = dot(normal, normal).sqrt();
    let products = dot(u, u).sqrt() * dot(v, v).sqrt();
    // Also false for NaN.
    let is_known = length > LEAST_NORMAL * products && length < f64::INFINITY;
    is_known.then(|| scaled(normal, 1.0 / length))
}

/// From where a face can be a front face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Facing {
    /// From nowhere: two corners are one point.
    Never,
    /// From where the plane does not reach: `normal · x > offset`.
    Plane(HalfSpace),
    /// Rounding may have turned it, or a corner is not finite: from anywhere, for all that is known.
    Unknown,
}

impl Facing {
    /// Of a face, by its corners; the plane is relative to an origin.
    ///
    /// The normal is that of the corners where they are: moved first, short edges would be rounded.
    pub(super) fn of(corners: [[f64; 3]; 3], origin: [f64; 3]) -> Self {
        let [a, b, c] = corners;
        match normal(corners) {
            Some(normal) => {
                let offset = dot(normal, sub(a, origin));
                Self::Plane(HalfSpace { normal, offset })
            }
            None if a == b || b == c || c == a => Self::Never,
            None => Self::Unknown,
        }
    }

    /// Of a face whose corners may each be that far from where they are said to be: planes such that the face can be a
    /// front face only from in front of one of them. `None` for anywhere.
    pub(super) fn planes_within(
        corners: [[f64; 3]; 3],
        origin: [f64; 3],
        error: f64,
    ) -> Option<Vec<HalfSpace>> {
        let [a, b, c] = corners;
        match Self::of(corners, origin) {
            Self::Plane(plane) if error == 0.0 => return Some(vec![plane]),
            Self::Never if error == 0.0 => return Some(Vec::new()),
            Self::Plane(_) => {}
            _ => return None,
        }

        // The sine of how far the normal may turn.
        let (u, v) = (sub(b, a), sub(c, a));
        let product = cross(u, v);
        let length = |x: [f64; 3]| dot(x, x).sqrt();
        let turned = 2.0 * error * (length(u) + length(v) + 2.0 * error) / length(product);
        if turned.is_nan() || turned >= 0.9 {
            return None;
        }

        // A pyramid of four normals around all that it may be.
        let normal = scaled(product, 1.0 / length(product));
        let tangent = (turned + MARGIN) / ((1.0 - turned) * (1.0 + turned)).sqrt();
        let across = scaled(u, tangent / length(u));
        let up = cross(normal, across);
        let plane = |[x, y]: [f64; 2]| {
            let edge = add(normal, add(scaled(across, x), scaled(up, y)));
            let edge = scaled(edge, 1.0 / length(edge));
            let offset = dot(edge, sub(a, origin)) - error;
            HalfSpace {
                normal: edge,
                offset,
            }
        };
        let edges = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        Some(edges.map(plane).to_vec())
    }
}
