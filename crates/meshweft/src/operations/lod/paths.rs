//! Where the eye goes around a ball.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::geometry::Ball;
use crate::geometry::double::{add, scaled};
use crate::lod::Camera;

/// Where the eye is in each frame of a walk.
///
/// The first four go around the smallest ball that has the mesh in it, *y* upward, with a field of view of 45 degrees. All but
/// the flight end where they began. The first three are of the kind that the paper draws; the flight is ours, and the one that
/// tells policies apart.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum CameraPath {
    /// Once around, all of the mesh in the picture.
    #[default]
    Circle,
    /// Small turns to and fro, four times, as far away.
    Rotate,
    /// Straight in until the eye is inside of the ball, and out again.
    Zoom,
    /// Around at changing distances, mostly close, with a wandering gaze.
    Fly,
    /// These cameras, one a frame.
    Given(Arc<[Camera]>),
}

/// From the bottom of the picture to its top.
const DEGREES: f64 = 45.0;

/// Frames of a walk if nothing else is said.
const USUAL_FRAMES: usize = 1000;

impl CameraPath {
    /// Those that need no cameras.
    pub const SHAPES: [Self; 4] = [Self::Circle, Self::Rotate, Self::Zoom, Self::Fly];

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Circle => "circle",
            Self::Rotate => "rotate",
            Self::Zoom => "zoom",
            Self::Fly => "fly",
            Self::Given(_) => "given",
        }
    }

    /// How many frames there are if a number is asked for: of given cameras at most all.
    #[must_use]
    pub fn frame_count(&self, asked: Option<usize>) -> usize {
        match self {
            Self::Given(cameras) => asked.map_or(cameras.len(), |asked| asked.min(cameras.len())),
            _ => asked.unwrap_or(USUAL_FRAMES),
        }
    }

    /// The camera of a frame, around a ball, with a picture of this width and height.
    ///
    /// # Panics
    /// If cameras are given and `frame` is not below their number.
    #[must_use]
    pub fn camera(&self, ball: Ball, frame: usize, frames: usize, size: [u32; 2]) -> Camera {
        let part = frame as f64 / frames.max(1) as f64;
        let turn = TAU * part;
        let radius = ball.radius;
        let far = radius / (0.5 * DEGREES).to_radians().sin();

        // Where the eye is: an angle around the ball, a distance, and a part of it upward.
        let (angle, distance, rise) = match self {
            Self::Circle => (turn, far, 0.15),
            Self::Rotate => (0.26 * (4.0 * turn).sin(), far, 0.15),
            Self::Zoom => {
                let outward = 0.5 + 0.5 * turn.cos();
                (
                    0.0,
                    0.6 * radius + (1.5 * far - 0.6 * radius) * outward,
                    0.0,
                )
            }
            Self::Fly => (1.3 * turn, radius * (0.9 + 0.35 * (3.1 * turn).sin()), 0.15),
            Self::Given(cameras) => {
                return Camera {
                    size,
                    ..cameras[frame]
                };
            }
        };
        let way = [angle.sin(), rise, angle.cos()];

        // What it looks at.
        let aside = match self {
            Self::Fly => [
                0.5 * (9.0 * part).sin(),
                0.3 * (14.0 * part + 1.0).sin(),
                0.0,
            ],
            _ => [0.0; 3],
        };
        Camera {
            eye: add(ball.center, scaled(way, distance)),
            target: add(ball.center, scaled(aside, radius)),
            up: [0.0, 1.0, 0.0],
            field_of_view: DEGREES,
            size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distances in radii; the far one is where a ball just fits in 45 degrees.
    #[test]
    fn paths_are_where_they_should_be() {
        let center = [1.0, 2.0, 3.0];
        let ball = Ball {
            center,
            radius: 2.0,
        };
        let far = 2.613_125_929_752_753;
        let at = |path: CameraPath, frame| {
            let camera = path.camera(ball, frame, 8, [800, 600]);
            assert_eq!((camera.size, camera.field_of_view), ([800, 600], 45.0));
            [camera.eye, camera.target].map(|place| [0, 1, 2].map(|i| (place[i] - center[i]) / 2.0))
        };
        let near = |found: [f64; 3], expected: [f64; 3]| {
            let is_near = (0..3).all(|i| (found[i] - expected[i]).abs() < 1e-12);
            assert!(is_near, "{found:?}, {expected:?}");
        };
        let eye = |path, frame, expected| {
            let [eye, target] = at(path, frame);
            near(eye, expected);
            near(target, [0.0; 3]);
        };

        eye(CameraPath::Circle, 0, [0.0, 0.15 * far, far]);
        eye(CameraPath::Circle, 2, [far, 0.15 * far, 0.0]);
        let (sine, cosine) = 0.26_f64.sin_cos();
        eye(CameraPath::Rotate, 0, [0.0, 0.15 * far, far]);
        let path = CameraPath::Rotate;
        let half = path.camera(ball, 1, 16, [1, 1]).eye;
        near(
            [0, 1, 2].map(|i| (half[i] - center[i]) / 2.0),
            [far * sine, 0.15 * far, far * cosine],
        );
        eye(CameraPath::Zoom, 0, [0.0, 0.0, 1.5 * far]);
        eye(CameraPath::Zoom, 4, [0.0, 0.0, 0.6]);
        let [eye, target] = at(CameraPath::Fly, 0);
        near(eye, [0.0, 0.9 * 0.15, 0.9]);
        near(target, [0.0, 0.3 * 1.0_f64.sin(), 0.0]);
    }

    #[test]
    fn given_cameras_are_as_many_as_there_are() {
        let ball = Ball {
            center: [0.0; 3],
            radius: 1.0,
        };
        let camera = CameraPath::Fly.camera(ball, 3, 9, [7, 7]);
        let path = CameraPath::Given([camera; 5].into());
        assert_eq!(
            [None, Some(3), Some(9)].map(|asked| path.frame_count(asked)),
            [5, 3, 5]
        );
        assert_eq!(
            path.camera(ball, 4, 5, [8, 9]),
            Camera {
                size: [8, 9],
                ..camera
            }
        );
        assert_eq!(
            [None, Some(3)].map(|asked| CameraPath::Zoom.frame_count(asked)),
            [1000, 3]
        );
    }
}
