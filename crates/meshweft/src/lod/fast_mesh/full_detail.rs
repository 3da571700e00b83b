//! What is known of the mesh at full detail, before any point of it is read.

use crate::geometry::Ball;
use crate::geometry::double::widened;
use crate::index::index32;

/// Where all points are, and how many faces there are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FullDetail {
    /// The smallest ball around all points whose coordinates are finite; `None` if there is none.
    pub(super) ball: Option<Ball>,
    pub(super) face_count: u32,
}

impl FullDetail {
    /// That of these points and a number of faces.
    pub(super) fn new(points: &[[f32; 3]], face_count: usize) -> Self {
        Self {
            ball: Ball::around(points.iter().map(|&point| widened(point))),
            face_count: index32(face_count),
        }
    }

    /// The ball as four numbers, its center and its radius; the radius is -1 where there is none.
    pub(super) fn ball_numbers(&self) -> [f64; 4] {
        match self.ball {
            Some(ball) => [ball.center[0], ball.center[1], ball.center[2], ball.radius],
            None => [0.0, 0.0, 0.0, -1.0],
        }
    }

    /// The same from numbers of a file; `None` if they cannot be those of a ball.
    pub(super) fn from_numbers(face_count: u32, numbers: [f64; 4]) -> Option<Self> {
        let [x, y, z, radius] = numbers;
        let ball = Ball {
            center: [x, y, z],
            radius,
        };
        let is_ball = numbers.iter().all(|x| x.is_finite()) && radius >= 0.0;
        let is_none = numbers == [0.0, 0.0, 0.0, -1.0];
        (is_ball || is_none).then_some(Self {
            ball: is_ball.then_some(ball),
            face_count,
        })
    }
}
