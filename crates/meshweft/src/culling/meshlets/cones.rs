//! Cones around the normals of a few faces, from whose inside none of them is a front face.

use crate::culling::eye::Eye;
use crate::geometry::Ball;
use crate::geometry::double::{add, cross, dot, rounded_up, scaled, sub, widened};

/// What of a few faces is known from anywhere: if an eye is in the cone that opens from `apex` against `axis`, none of them is a
/// front face.
///
/// That is `dot(normalize(apex - eye), axis) >= cutoff`, or `dot(-towards_viewer, axis) >= cutoff` for an orthographic view
/// (`towards_viewer` of length 1). Either holds in a shader too, where each operation may be some units in the last place
/// off, as long as no square overflows or vanishes: the cutoff has room for 2⁻¹⁹.
///
/// **Proof.** Let all normals be at most an angle *β* < 90° from the axis, and the apex `q` behind the planes of all faces
/// (`n · q <= n · a`). With `d = w q − p` for an [`Eye`] `(p, w)`, the test says that `d` is at most 90° − *β* from the axis, so
/// at most 90° from each `n`: `n · d >= 0`. So `n · p <= w n · q <= w n · a`: not a front face. Both conditions are checked
/// for the rounded numbers that are stored, with bounds on the errors of the check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalCone {
    /// Behind the planes of all faces.
    pub apex: [f32; 3],
    /// The middle of the normals, of length 1 but for rounding.
    pub axis: [f32; 3],
    /// The sine of the angle *β*, and some room; 2 if the faces are always drawn.
    pub cutoff: f32,
}

/// A normal is known if it is at least this part of the products that it comes from: rounding turns it by less than 2⁻²³ then.
const LEAST_NORMAL: f64 = 1.0 / (1_u64 << 26) as f64;

/// How much larger than the sine the cutoff is: eight times what the test may be off in `f32`, with a normal that is.
const ROOM: f64 = 1.0 / (1_u64 << 19) as f64;

/// What rounding may do to the distance from a plane times its normal, in parts of the products in it.
const PLANE_ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

/// A sine above leaves nearly no eye that would see none of the faces.
const MOST_SINE: f64 = 0.9999;

/// So often an apex is moved back that rounding left before a plane.
const MOST_MOVES: u32 = 16;

impl NormalCone {
    /// Of faces that are always drawn.
    pub const ALWAYS_DRAWN: Self = Self {
        apex: [0.0; 3],
        axis: [0.0; 3],
        cutoff: 2.0,
    };

    /// The cone of some faces, by the positions of their corners: with the smallest angle, and its apex as far ahead on the
    /// line through the middle of the corners as it may be.
    ///
    /// Faces without an area do not count, as they are never front faces. Where rounding may have turned a normal,
    /// a corner is not finite, or no face counts, the faces are always drawn.
    ///
    /// # Complexity
    /// Time O(faces) for about ten looks at each.
    #[must_use]
    pub fn around(faces: impl IntoIterator<Item = [[f32; 3]; 3]>) -> Self {
        Self::of(faces).unwrap_or(Self::ALWAYS_DRAWN)
    }

    fn of(faces: impl IntoIterator<Item = [[f32; 3]; 3]>) -> Option<Self> {
        let mut planes = Vec::new();
        for corners in faces {
            match KnownPlane::of(corners) {
                KnownPlane::None => {}
                KnownPlane::Of(plane) => planes.push(plane),
                KnownPlane::Unsure => return None,
            }
        }

        // The axis: the middle of the smallest ball around the normals. As `f32` it is another one, so it is measured.
        let normals = planes.iter().map(|plane| plane.unit());
        let middle = Ball::around(normals)?.center;
        let length = dot(middle, middle).sqrt();
        let axis = narrowed(scaled(middle, 1.0 / length));
        let exact = widened(axis);
        let length = dot(exact, exact).sqrt();
        let mut sine: f64 = 0.0;
        for plane in &planes {
            // Also false for NaN.
            let is_before = dot(plane.unit(), exact) > 0.0;
            if !is_before {
                return None;
            }
            let across = cross(plane.unit(), exact);
            sine = sine.max(dot(across, across).sqrt());
        }
        if sine > MOST_SINE * length {
            return None;
        }
        Some(Self {
            apex: apex(&planes, exact)?,
            axis,
            cutoff: rounded_up(sine + ROOM),
        })
    }

    /// Whether none of the faces is a front face for this eye, as far as the cone knows.
    #[must_use]
    pub fn is_hidden_from(&self, eye: Eye) -> bool {
        eye.parts().is_some_and(|(point, w)| self.hides(point, w))
    }

    /// The same, of the parts of an eye: in double precision, so that no square overflows, and without a root.
    #[inline]
    pub(super) fn hides(&self, point: [f64; 3], w: f64) -> bool {
        let way = sub(scaled(widened(self.apex), w), point);
        let along = dot(way, widened(self.axis));
        let cutoff = f64::from(self.cutoff);
        along > 0.0 && along * along >= cutoff * cutoff * dot(way, way)
    }
}

/// What is known of a face's plane.
enum KnownPlane {
    /// The face has no area.
    None,
    Of(Plane),
    Unsure,
}

#[derive(Debug, Clone, Copy)]
struct Plane {
    /// The product of two edges.
    normal: [f64; 3],
    /// A corner.
    at: [f64; 3],
    /// The lengths of these edges, multiplied.
    products: f64,
}

impl KnownPlane {
    fn of(corners: [[f32; 3]; 3]) -> Self {
        let [a, b, c] = corners;
        if a == b || b == c || c == a {
            return Self::None;
        }
        let [a, b, c] = [a, b, c].map(widened);
        let (u, v) = (sub(b, a), sub(c, a));
        let plane = Plane {
            normal: cross(u, v),
            at: a,
            products: dot(u, u).sqrt() * dot(v, v).sqrt(),
        };
        let length = dot(plane.normal, plane.normal).sqrt();
        match () {
            // Also false for NaN.
            () if length > LEAST_NORMAL * plane.products && length < f64::INFINITY => {
                Self::Of(plane)
            }
            () if are_in_line([a, b, c]) => Self::None,
            () => Self::Unsure,
        }
    }
}

impl Plane {
    /// The normal of length 1.
    fn unit(&self) -> [f64; 3] {
        let length = dot(self.normal, self.normal).sqrt();
        scaled(self.normal, 1.0 / length)
    }

    /// How far a point must go against an axis to be surely behind the plane, at least; if not above 0, it is.
    fn before(&self, point: [f64; 3], axis: [f64; 3]) -> f64 {
        let way = sub(point, self.at);
        let error = PLANE_ROUNDING * self.products * dot(way, way).sqrt();
        (dot(self.normal, way) + error) / dot(self.normal, axis)
    }
}

/// Whether three points are on a line, exactly; `false` where doubles cannot say it.
fn are_in_line([a, b, c]: [[f64; 3]; 3]) -> bool {
    // The rest of a difference, and of a product, is a double too.
    let is_exact = |p: f64, q: f64| {
        let difference = p - q;
        let taken = p - difference;
        (taken - q) + (p - (difference + taken)) == 0.0
    };
    let edges = [(b, a), (c, a)];
    if !edges
        .iter()
        .all(|(p, q)| (0..3).all(|axis| is_exact(p[axis], q[axis])))
    {
        return false;
    }
    let [u, v] = edges.map(|(p, q)| sub(p, q));
    let is_same = |p: [f64; 2], q: [f64; 2]| {
        let product = p[0] * p[1];
        let other = q[0] * q[1];
        product == other && p[0].mul_add(p[1], -product) == q[0].mul_add(q[1], -other)
    };
    is_same([u[1], v[2]], [u[2], v[1]])
        && is_same([u[2], v[0]], [u[0], v[2]])
        && is_same([u[0], v[1]], [u[1], v[0]])
}

/// The last point on a line through the middle of the faces against the axis that is behind all planes, in single precision;
/// `None` if rounding does not leave one there.
fn apex(planes: &[Plane], axis: [f64; 3]) -> Option<[f32; 3]> {
    let sum = planes
        .iter()
        .fold([0.0; 3], |sum, plane| add(sum, plane.at));
    let middle = scaled(sum, 1.0 / planes.len() as f64);
    let farthest = |point: [f64; 3]| {
        let before = planes.iter().map(|plane| plane.before(point, axis));
        before.fold(f64::NEG_INFINITY, f64::max)
    };

    // Rounding may put it before a plane again.
    let mut back = farthest(middle);
    for moves in 0..MOST_MOVES {
        let apex = narrowed(sub(middle, scaled(axis, back)));
        let rest = farthest(widened(apex));
        // Also false for NaN and infinity.
        if rest <= 0.0 && apex.iter().all(|x| x.is_finite()) {
            return Some(apex);
        }
        let size = apex
            .iter()
            .fold(0.0, |most: f64, x| most.max(f64::from(*x).abs()));
        back += rest + size * f64::from(f32::EPSILON) * f64::from(1 << moves);
    }
    None
}

fn narrowed(point: [f64; 3]) -> [f32; 3] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "what is stored is measured"
    )]
    point.map(|x| x as f32)
}
