//! What a camera sees of points, by projecting them: it shares nothing with the bounds that a front tests.

use crate::geometry::double::{cross, dot, scaled, sub, widened};
use crate::lod::Camera;

/// A camera as its axes.
#[derive(Debug, Clone, Copy)]
pub(in crate::operations) struct MeasuredView {
    eye: [f64; 3],
    /// To the right of the picture, up, and into it.
    axes: [[f64; 3]; 3],
    /// Half the picture's width and height, at distance 1.
    half: [f64; 2],
    /// How many tolerances a length of 1 is at distance 1.
    scale: f64,
}

impl MeasuredView {
    /// That of a camera which has a view.
    pub(in crate::operations) fn new(camera: &Camera, tolerance: f64) -> Self {
        let ahead = unit(sub(camera.target, camera.eye));
        let right = unit(cross(ahead, unit(camera.up)));
        let [width, height] = camera.size.map(f64::from);
        let half_height = (0.5 * camera.field_of_view).to_radians().tan();
        Self {
            eye: camera.eye,
            axes: [right, cross(right, ahead), ahead],
            half: [half_height * width / height, half_height],
            scale: height / (2.0 * half_height) / tolerance,
        }
    }

    /// Whether a point is in the picture.
    pub(in crate::operations) fn has_in_picture(&self, point: [f32; 3]) -> bool {
        let way = sub(widened(point), self.eye);
        let [x, y, depth] = self.axes.map(|axis| dot(way, axis));
        let is_inside = |at: f64, half: f64| at.abs() <= half * depth;
        depth > 0.0 && is_inside(x, self.half[0]) && is_inside(y, self.half[1])
    }

    /// Whether a point is in the picture, and its normal faces the eye.
    pub(in crate::operations) fn sees(&self, point: [f32; 3], normal: [f32; 3]) -> bool {
        let way = sub(widened(point), self.eye);
        self.has_in_picture(point) && dot(widened(normal), way) < 0.0
    }

    /// How many tolerances a length is where a point is.
    pub(in crate::operations) fn tolerances(&self, point: [f32; 3], length: f64) -> f64 {
        let way = sub(widened(point), self.eye);
        length * self.scale / dot(way, way).sqrt()
    }
}

/// The direction of a vector that has one.
fn unit(a: [f64; 3]) -> [f64; 3] {
    let largest = a.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let small = scaled(a, 1.0 / largest);
    scaled(small, 1.0 / dot(small, small).sqrt())
}
