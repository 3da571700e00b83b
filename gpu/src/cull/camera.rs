//! From where meshes are seen.

use std::f64::consts::TAU;

use meshweft::Mesh;
use meshweft::culling::Eye;
use meshweft::geometry::Ball;

use super::lattice::on_lattice;
use crate::frames::View;
use crate::random::Random;

pub(super) type Vector = [f64; 3];

/// How much more than a ball is between what is near and what is far.
const ROOM: f64 = 1.02;

/// Looks from somewhere at a ball, so that all of it is in the picture, or magnified.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
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
    pub(super) fn new(eye: Eye, ball: Ball, magnified: f64) -> Self {
        let [x, y, z, w] = eye.point.map(f64::from);
        let at = (w == 1.0).then_some([x, y, z]);
        let forward = unit(match at {
            Some(at) => minus(ball.center, at),
            None => [-x, -y, -z],
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

    /// The matrix for a mesh that is moved by an offset; y points down in pictures.
    #[expect(clippy::cast_possible_truncation, reason = "matrices are f32")]
    pub(super) fn view(&self, offset: Vector) -> View {
        let Ball { center, radius } = self.ball;
        let origin = self.at.unwrap_or(center);
        let from = minus(origin, offset);
        let row = |axis: Vector, by: f64, plus: f64| {
            let [x, y, z] = axis.map(|x| x * by);
            [x, y, z, plus - by * dot(axis, from)]
        };
        let rows = match self.at {
            Some(at) => {
                let way = minus(center, at);
                let distance = dot(way, way).sqrt();
                let across =
                    self.magnified * (distance * distance - radius * radius).sqrt() / radius;
                let (near, far) = ((distance - radius) / ROOM, (distance + radius) * ROOM);
                let depth = far / (far - near);
                [
                    row(self.right, across, 0.0),
                    row(self.up, -across, 0.0),
                    row(self.forward, depth, -near * depth),
                    row(self.forward, 1.0, 0.0),
                ]
            }
            None => {
                let across = self.magnified / radius;
                [
                    row(self.right, across, 0.0),
                    row(self.up, -across, 0.0),
                    row(self.forward, 0.5 / (radius * ROOM), 0.5),
                    [0.0, 0.0, 0.0, 1.0],
                ]
            }
        };
        let mut view = [0.0; 16];
        for (place, to) in view.iter_mut().enumerate() {
            *to = rows[place % 4][place / 4] as f32;
        }
        view
    }
}

/// The ball around the faces of a mesh.
pub(super) fn ball(mesh: &Mesh) -> Option<Ball> {
    let used = mesh.faces().as_flattened().iter();
    Ball::around(used.map(|&vertex| mesh.positions()[vertex as usize].map(f64::from)))
}

/// A direction, all alike.
pub(super) fn direction(random: &mut Random) -> Vector {
    let mut share = || f64::from(random.bits()) / f64::from(u32::MAX);
    let (height, longitude) = (2.0 * share() - 1.0, TAU * share());
    let radius = (1.0 - height * height).max(0.0).sqrt();
    [radius * longitude.sin(), height, radius * longitude.cos()]
}

/// An eye outside the ball: in the plane of a face, along the normal of one, along an axis, or anywhere; from all but
/// touching the ball to far away, one in four orthographic.
pub(super) fn eye(mesh: &Mesh, ball: Ball, number: u32, random: &mut Random) -> Eye {
    // From where, in which direction.
    let count = u32::try_from(mesh.face_count()).expect("indices have 32 bits");
    let face = mesh.faces()[random.below(count) as usize];
    let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize].map(f64::from));
    let (u, v) = (minus(b, a), minus(c, a));
    let (from, way) = match number % 8 {
        0 => (a, u),
        1 => (a, minus(v, u)),
        2 => (a, cross(u, v)),
        3 => (ball.center, [0.0, 1.0, 0.0]),
        4 => (ball.center, [-1.0, 0.0, 0.0]),
        _ => (ball.center, direction(random)),
    };
    let way = match dot(way, way) > 0.0 {
        true => unit(way),
        false => [0.0, 0.0, 1.0],
    };

    // How far.
    let far = [1.05, 1.2, 1.5, 2.0, 4.0, 10.0, 50.0][random.below(7) as usize] * ball.radius;
    if (number / 8).is_multiple_of(4) {
        return Eye::towards(on_lattice(way));
    }
    let from_center = minus(from, ball.center);
    let steps = far + dot(from_center, from_center).sqrt();
    Eye::at(on_lattice([0, 1, 2].map(|i| from[i] + steps * way[i])))
}

pub(super) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a matrix puts a point: across, down, depth.
    fn placed(view: &View, point: [f64; 3]) -> [f64; 3] {
        let point = [point[0], point[1], point[2], 1.0];
        let row = |row: usize| -> f64 {
            (0..4)
                .map(|column| f64::from(view[4 * column + row]) * point[column])
                .sum()
        };
        [0, 1, 2].map(|axis| row(axis) / row(3))
    }

    #[test]
    fn the_ball_fills_the_picture_from_near_to_far() {
        let ball = Ball {
            center: [1.0, 2.0, 3.0],
            radius: 2.0,
        };
        for eye in [Eye::at([1.0, 2.0, 9.0]), Eye::towards([0.0, 0.0, 7.0])] {
            let view = Camera::new(eye, ball, 1.0).view([0.0; 3]);
            let middle = placed(&view, ball.center);
            assert!(middle[0].abs() < 1e-6 && middle[1].abs() < 1e-6);
            let [near, far] = [5.0, 1.0].map(|z| placed(&view, [1.0, 2.0, z])[2]);
            assert!((0.0..0.1).contains(&near) && (0.9..=1.0).contains(&far));
            // Up is up, and pictures point down.
            let up = placed(&view, [1.0, 3.5, 3.0]);
            assert!((-1.0..-0.7).contains(&up[1]), "{up:?}");
            let right = placed(&view, [2.5, 2.0, 3.0]);
            assert!((0.7..1.0).contains(&right[0]), "{right:?}");
            // Moved as a mesh is.
            let moved = Camera::new(eye, ball, 1.0).view([0.0, 1.5, 0.0]);
            let same = placed(&moved, ball.center);
            assert!((0..3).all(|axis| (same[axis] - up[axis]).abs() < 1e-5));
        }
    }
}
