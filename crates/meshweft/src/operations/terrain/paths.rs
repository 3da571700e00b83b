//! Where the eye goes over a terrain.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::source::TerrainFacts;
use crate::lod::Camera;

/// Where the eye is in each frame of a walk over a terrain.
///
/// The first four are measured in the width of the terrain, from west to east, with a field of view of 45 degrees; heights are
/// above 0, and look down a little. Over a terrain of [`TerrainPath::WIDTH`] metres the eye is 3,000 m high, 1,900 to 3,700 m in the flight; otherwise as
/// much more or less as the terrain is wider or narrower. Where 3,000 m of the first would not be a tenth of it above the highest
/// place, all of the path is lifted until they are.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum TerrainPath {
    /// Once around the middle, a quarter of the width away, looking ahead.
    #[default]
    Circle,
    /// Once around itself, above the middle.
    Rotate,
    /// From west to east.
    Straight,
    /// To and fro at changing heights, with a wandering gaze.
    Fly,
    /// These cameras, one a frame.
    Given(Arc<[Camera]>),
}

/// From the bottom of the picture to its top.
const DEGREES: f64 = 45.0;
/// How high the eye is above a terrain of the usual width.
const EYE: f64 = 3000.0;
/// Frames of a walk if nothing else is said.
const USUAL_FRAMES: usize = 3000;

impl TerrainPath {
    /// Those that need no cameras.
    pub const SHAPES: [Self; 4] = [Self::Circle, Self::Rotate, Self::Straight, Self::Fly];
    /// The width, in metres, over which the eye is as high as the paths say.
    pub const WIDTH: f64 = 92_160.0;

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Circle => "circle",
            Self::Rotate => "rotate",
            Self::Straight => "straight",
            Self::Fly => "fly",
            Self::Given(_) => "given",
        }
    }

    /// How many cameras are given; `None` if the path has a shape.
    pub(super) fn given_count(&self) -> Option<usize> {
        match self {
            Self::Given(cameras) => Some(cameras.len()),
            _ => None,
        }
    }

    /// How many frames there are if a number is asked for: of given cameras at most all.
    #[must_use]
    pub fn frame_count(&self, asked: Option<usize>) -> usize {
        match self.given_count() {
            Some(count) => asked.map_or(count, |asked| asked.min(count)),
            None => asked.unwrap_or(USUAL_FRAMES),
        }
    }

    /// The camera of a frame, over a terrain, with a picture of this width and height.
    ///
    /// # Panics
    /// If cameras are given and `frame` is not below their number.
    #[must_use]
    pub fn camera(
        &self,
        terrain: &TerrainFacts,
        frame: usize,
        frames: usize,
        size: [u32; 2],
    ) -> Camera {
        let width = terrain.width;
        let scale = width / Self::WIDTH;
        let above = 1.1 * f64::from(terrain.heights[1]).max(0.0) - EYE * scale;
        let lift = above.max(0.0);
        let part = frame as f64 / frames.max(1) as f64;
        let turn = TAU * part;

        // Where the eye is, from the middle in widths, its height, and where it looks to.
        let ([x, z], height, way) = match self {
            Self::Circle => (
                [0.25 * turn.cos(), 0.25 * turn.sin()],
                EYE,
                [-turn.sin(), -0.12, turn.cos()],
            ),
            Self::Rotate => ([0.0; 2], EYE, [turn.cos(), -0.12, turn.sin()]),
            Self::Straight => ([0.05 + 0.9 * part - 0.5, 0.0], EYE, [1.0, -0.12, 0.0]),
            Self::Fly => {
                let gaze = 1.7 * turn + 1.2 * (4.0 * turn).sin();
                (
                    [0.3 * (1.3 * turn).sin(), 0.3 * (2.1 * turn + 0.7).sin()],
                    2800.0 + 900.0 * (3.0 * turn).sin(),
                    [gaze.cos(), -0.15, gaze.sin()],
                )
            }
            Self::Given(cameras) => {
                return Camera {
                    size,
                    ..cameras[frame]
                };
            }
        };
        let eye = [x * width, height * scale + lift, z * width];
        Camera {
            eye,
            target: [0, 1, 2].map(|axis| eye[axis] + way[axis] * width),
            up: [0.0, 1.0, 0.0],
            field_of_view: DEGREES,
            size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terrain(highest: f32) -> TerrainFacts {
        TerrainFacts {
            grid_size: None,
            grid_spacing: None,
            width: TerrainPath::WIDTH,
            heights: [0.0, highest],
            vertices: 0,
            faces: 0,
        }
    }

    #[test]
    fn paths_are_where_they_should_be() {
        let near = |found: [f64; 3], expected: [f64; 3]| {
            let is_near = (0..3).all(|i| (found[i] - expected[i]).abs() < 1e-6);
            assert!(is_near, "{found:?}, {expected:?}");
        };
        let check = |path: TerrainPath, frame, eye, way: [f64; 3]| {
            let camera = path.camera(&terrain(2400.0), frame, 8, [1024, 768]);
            assert_eq!((camera.size, camera.field_of_view), ([1024, 768], 45.0));
            near(camera.eye, eye);
            let to = [0, 1, 2].map(|i| (camera.target[i] - camera.eye[i]) / 92_160.0);
            near(to, way);
        };
        check(
            TerrainPath::Circle,
            0,
            [23_040.0, 3000.0, 0.0],
            [0.0, -0.12, 1.0],
        );
        check(
            TerrainPath::Circle,
            2,
            [0.0, 3000.0, 23_040.0],
            [-1.0, -0.12, 0.0],
        );
        check(
            TerrainPath::Rotate,
            2,
            [0.0, 3000.0, 0.0],
            [0.0, -0.12, 1.0],
        );
        check(
            TerrainPath::Straight,
            0,
            [-41_472.0, 3000.0, 0.0],
            [1.0, -0.12, 0.0],
        );
        check(
            TerrainPath::Straight,
            4,
            [0.0, 3000.0, 0.0],
            [1.0, -0.12, 0.0],
        );
        let z = 27_648.0 * 0.7_f64.sin();
        check(TerrainPath::Fly, 0, [0.0, 2800.0, z], [1.0, -0.15, 0.0]);
    }

    #[test]
    fn the_eye_is_above_the_highest_place() {
        let height = |terrain: &TerrainFacts| {
            let camera = TerrainPath::Straight.camera(terrain, 3, 8, [8, 8]);
            camera.eye[1]
        };
        assert_eq!(height(&terrain(2700.0)), 3000.0);
        assert!((height(&terrain(4000.0)) - 4400.0).abs() < 1e-6);
        let half = TerrainFacts {
            width: 0.5 * TerrainPath::WIDTH,
            ..terrain(-10.0)
        };
        assert_eq!(height(&half), 1500.0);
        let path = TerrainPath::Given([TerrainPath::Fly.camera(&half, 1, 5, [4, 4]); 5].into());
        assert_eq!(
            [None, Some(2), Some(9)].map(|asked| path.frame_count(asked)),
            [5, 2, 5]
        );
        assert_eq!(TerrainPath::Fly.frame_count(None), 3000);
    }
}
