//! Which way a face looks, surely: what the library leaves out is checked by this, not by its own bounds.

use meshweft::culling::Eye;

/// How a face looks to an eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Facing {
    /// It is a front face.
    Front,
    /// It is none.
    Back,
    /// Two corners are at one point: it is never seen.
    Nowhere,
    /// Rounding may have decided.
    Unsure,
}

/// What rounding may do to the sum of products, in parts of them: some 20 operations of half a unit in the last place each.
const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;

/// How a face with these corners looks to an eye. Differences of `f32` are exact in `f64`, or nearly so.
pub(crate) fn facing(corners: [[f32; 3]; 3], eye: Eye) -> Facing {
    let [a, b, c] = corners;
    if a == b || b == c || c == a {
        return Facing::Nowhere;
    }
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let [x, y, z, w] = eye.point.map(f64::from);
    let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let length = |p: [f64; 3]| dot(p, p).sqrt();
    let (u, v) = (minus(b, a), minus(c, a));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let way = minus([x, y, z], a.map(|x| w * x));
    let height = dot(normal, way);
    let error = ROUNDING * length(u) * length(v) * length(way);
    match () {
        () if height > error => Facing::Front,
        () if height < -error => Facing::Back,
        () => Facing::Unsure,
    }
}
