//! What is drawn, and from where: on a lattice, so that what a front face is can be told exactly.

use std::f64::consts::{PI, TAU};

use meshweft::Mesh;
use meshweft::culling::Eye;
use meshweft::geometry::Ball;

/// Positions and eyes are multiples of this.
const UNIT: f64 = 1.0 / 4096.0;
/// How large meshes are.
const SIZE: f64 = 8.0;

pub(crate) type Vector = [f64; 3];

pub(crate) fn widened(point: [f32; 3]) -> Vector {
    point.map(f64::from)
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scaled(v: Vector, by: f64) -> Vector {
    v.map(|x| x * by)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number from 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to below the limit"
    )]
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.share() * limit as f64) as usize
    }

    fn direction(&mut self) -> Vector {
        let (height, longitude) = (2.0 * self.share() - 1.0, TAU * self.share());
        let radius = (1.0 - height * height).sqrt();
        [radius * longitude.sin(), height, radius * longitude.cos()]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
fn narrowed(point: Vector) -> [f32; 3] {
    point.map(|x| x as f32)
}

/// The nearest point of the lattice, which `f32` holds exactly.
fn on_lattice(point: Vector) -> [f32; 3] {
    narrowed(point.map(|x| (x / UNIT).round() * UNIT))
}

fn in_units(point: [f32; 3]) -> [i128; 3] {
    point.map(|x| {
        let units = f64::from(x) / UNIT;
        assert_eq!(units, units.round(), "{x} is on the lattice");
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        let units = units as i128;
        units
    })
}

/// A mesh of the usual size, on the lattice.
pub(crate) fn fitted(positions: &[[f32; 3]], faces: Vec<[u32; 3]>) -> Mesh {
    let used = faces.as_flattened().iter();
    let ball = Ball::around(used.map(|&vertex| widened(positions[vertex as usize]))).unwrap();
    let fit = |&position: &[f32; 3]| {
        let from_center = minus(widened(position), ball.center);
        on_lattice(scaled(from_center, SIZE / ball.radius))
    };
    Mesh::new(positions.iter().map(fit).collect::<Vec<_>>(), faces).unwrap()
}

/// A closed surface by rings, rough or not; a hole through it makes it a torus.
pub(crate) fn round(rings: u32, around: u32, hole: f64, rough: f64, random: &mut Random) -> Mesh {
    let mut positions = Vec::new();
    for ring in 0..=rings {
        // Of a torus the last ring is the first one again.
        let latitude = match hole > 0.0 {
            true => TAU * f64::from(ring % rings) / f64::from(rings),
            false => PI * f64::from(ring) / f64::from(rings),
        };
        for step in 0..around {
            let longitude = TAU * f64::from(step) / f64::from(around);
            let radius = 1.0 + rough * random.share();
            let out = hole + radius * latitude.sin();
            let point = [
                out * longitude.sin(),
                radius * latitude.cos(),
                out * longitude.cos(),
            ];
            positions.push(on_lattice(point));
        }
    }
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let faces = quads.flat_map(|(ring, step)| {
        let next_ring = match hole > 0.0 {
            true => (ring + 1) % rings,
            false => ring + 1,
        };
        let at = |ring: u32, step: u32| ring * around + step % around;
        let [a, b] = [at(ring, step), at(next_ring, step)];
        let [c, d] = [at(next_ring, step + 1), at(ring, step + 1)];
        [[a, b, c], [a, c, d]]
    });
    fitted(&positions, faces.collect())
}

/// The same seen from inside: what was in front is at the back.
pub(crate) fn inside_out(mesh: &Mesh) -> Mesh {
    let faces = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]);
    Mesh::new(mesh.positions(), faces.collect::<Vec<_>>()).unwrap()
}

/// Faces anywhere, some without an area, many of them long and thin.
pub(crate) fn soup(random: &mut Random) -> Mesh {
    let positions: Vec<[f32; 3]> = (0..60).map(|_| on_lattice(random.direction())).collect();
    let face = |_| [(); 3].map(|()| u32::try_from(random.below(60)).unwrap());
    let faces: Vec<[u32; 3]> = (0..400).map(face).collect();
    fitted(&positions, faces)
}

/// Faces that are so thin that the grid turns many of them over.
pub(crate) fn needles(random: &mut Random) -> Mesh {
    let mut positions = Vec::new();
    for _ in 0..2000 {
        let (tip, end) = (random.direction(), random.direction());
        let aside = scaled(random.direction(), UNIT / SIZE);
        positions.extend([tip, end, plus(end, aside)]);
    }
    let faces = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let positions: Vec<[f32; 3]> = positions.into_iter().map(narrowed).collect();
    fitted(&positions, faces.collect())
}

/// The ball around a mesh.
pub(crate) fn ball(mesh: &Mesh) -> Ball {
    let used = mesh.faces().as_flattened().iter();
    let used = used.map(|&vertex| widened(mesh.positions()[vertex as usize]));
    Ball::around(used).unwrap()
}

/// An eye outside the ball, of which the first few kinds are the hard ones: in the plane of a face, straight in
/// front of one or at its back, along an axis; from all but touching the ball to far away.
pub(crate) fn eye(mesh: &Mesh, ball: Ball, view: usize, random: &mut Random) -> Eye {
    // From where, in which direction.
    let face = mesh.faces()[random.below(mesh.face_count())];
    let [a, b, c] = face.map(|vertex| widened(mesh.positions()[vertex as usize]));
    let (u, v) = (minus(b, a), minus(c, a));
    let normal = cross(u, v);
    let axis = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let (from, direction) = match view % 8 {
        0 => (a, u),
        1 => (a, minus(v, u)),
        2 => (a, normal),
        3 => (a, scaled(normal, -1.0)),
        4 => (ball.center, axis[random.below(4)]),
        _ => (ball.center, random.direction()),
    };
    let length = dot(direction, direction).sqrt();
    let (direction, length) = match length > 0.0 {
        true => (direction, length),
        false => ([1.0, 0.0, 0.0], 1.0),
    };

    // How far: whole steps, so that what is in a plane stays in it.
    let far = [1.05, 1.2, 1.5, 2.0, 4.0, 10.0, 60.0][random.below(7)] * ball.radius;
    let from_center = minus(from, ball.center);
    let beyond = far + dot(from_center, from_center).sqrt();
    let steps = match view % 8 {
        0 | 1 => (beyond / length).ceil(),
        _ => beyond / length,
    };
    match (view / 8).is_multiple_of(4) {
        true => {
            let far = SIZE / length;
            let steps = if view % 8 < 2 { far.ceil() } else { far };
            let [x, y, z] = on_lattice(scaled(direction, steps));
            Eye::towards([x, y, z])
        }
        false => Eye::at(on_lattice(plus(from, scaled(direction, steps)))),
    }
}

/// Whether a face is a front face, exactly.
pub(crate) fn is_front(corners: [[f32; 3]; 3], eye: Eye) -> bool {
    let [a, b, c] = corners.map(in_units);
    let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (minus(b, a), minus(c, a));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let [x, y, z, w] = eye.point;
    let point = in_units([x, y, z]);
    let way = match w == 0.0 {
        true => point,
        false => minus(point, a),
    };
    n[0] * way[0] + n[1] * way[1] + n[2] * way[2] > 0
}
