//! Vertices on the screen: on the grid that pixels are split into, as cards place them.

use meshweft::culling::Eye;
use meshweft::geometry::Ball;

use crate::scene::{Vector, cross, dot, minus, scaled, widened};

/// Width and height of a picture in pixels.
pub(crate) const SIDE: i64 = 128;
/// Steps of the grid in a pixel, as on most cards.
pub(crate) const STEPS: i64 = 256;
/// The greatest depth.
const FAR: f64 = (1 << 24) as f64;

/// A vertex on the screen: right, up, and how deep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Placed {
    pub(crate) x: i64,
    pub(crate) y: i64,
    pub(crate) depth: i64,
}

/// Looks at the middle of a ball, so that all of it is in the picture, or magnified.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    right: Vector,
    up: Vector,
    forward: Vector,
    ball: Ball,
    /// The position of an eye that has one.
    at: Option<Vector>,
    magnified: f64,
}

impl Camera {
    /// The camera at an eye outside the ball.
    pub(crate) fn new(eye: Eye, ball: Ball, magnified: f64) -> Self {
        let [x, y, z, w] = eye.point;
        let point = widened([x, y, z]);
        let at = (w == 1.0).then_some(point);
        let forward = unit(match at {
            Some(at) => minus(ball.center, at),
            None => scaled(point, -1.0),
        });
        // Any axis that is not along the line of sight.
        let aside = match forward[1].abs() < 0.9 {
            true => [0.0, 1.0, 0.0],
            false => [1.0, 0.0, 0.0],
        };
        let right = unit(cross(forward, aside));
        Self {
            right,
            up: cross(right, forward),
            forward,
            ball,
            at,
            magnified,
        }
    }

    /// A vertex in the picture.
    pub(crate) fn place(&self, position: [f32; 3]) -> Placed {
        let position = widened(position);
        let Ball { center, radius } = self.ball;

        // From −1 to 1 across what is seen of the ball, from 0 to 1 through it. Depth changes evenly across the screen.
        let (across, way, depth) = match self.at {
            Some(at) => {
                let way = minus(position, at);
                let (distance, toward) = (length(minus(center, at)), dot(way, self.forward));
                let across = radius / (distance * distance - radius * radius).sqrt() * toward;
                let (near, far) = (distance - radius, distance + radius);
                let depth = (1.0 / near - 1.0 / toward) / (1.0 / near - 1.0 / far);
                (across, way, depth)
            }
            None => {
                let way = minus(position, center);
                let depth = (dot(way, self.forward) + radius) / (2.0 * radius);
                (radius, way, depth)
            }
        };
        let on_screen = |axis: Vector| {
            let share = self.magnified * dot(way, axis) / across;
            whole((1.0 + share) / 2.0 * (SIDE * STEPS) as f64)
        };
        Placed {
            x: on_screen(self.right),
            y: on_screen(self.up),
            depth: whole(depth * FAR),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "far less than 64 bits hold"
)]
fn whole(x: f64) -> i64 {
    assert!(x.abs() < 1e9, "{x} is not near the picture");
    x.round() as i64
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

fn unit(v: Vector) -> Vector {
    scaled(v, 1.0 / length(v))
}
