//! No front face is left out, by exact signs: what tests of all orders share.

use super::{Eye, Ranges};
use crate::geometry::Ball;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::random::{SplitMix64, from_environment};

/// Positions and eyes are multiples of this, so that signs are exact in 128 bits.
pub(super) const UNIT: f32 = 1.0 / 4096.0;

pub(super) fn in_units(x: f32) -> i128 {
    let units = f64::from(x / UNIT);
    assert_eq!(units, units.round(), "{x} is not a multiple");
    #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
    let units = units as i128;
    units
}

/// Whether a face is a front face, exactly.
pub(super) fn is_front(corners: [[f32; 3]; 3], eye: Eye) -> bool {
    let [a, b, c] = corners.map(|corner| corner.map(in_units));
    let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (minus(b, a), minus(c, a));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let [x, y, z, w] = eye.point;
    let p = [x, y, z].map(in_units);
    let way = match w == 0.0 {
        true => p,
        false => minus(p, a),
    };
    n[0] * way[0] + n[1] * way[1] + n[2] * way[2] > 0
}

pub(super) fn on_lattice(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
    let units = (x / f64::from(UNIT)).round() as f32;
    units * UNIT
}

/// A closed ball of faces with a rough surface, turned inside out or not.
pub(super) fn ball(
    rings: u32,
    around: u32,
    rough: f64,
    is_inside_out: bool,
    random: &mut SplitMix64,
) -> Mesh {
    let mut positions = Vec::new();
    for ring in 0..=rings {
        for step in 0..around {
            let (latitude, longitude) = (
                std::f64::consts::PI * f64::from(ring) / f64::from(rings),
                std::f64::consts::TAU * f64::from(step) / f64::from(around),
            );
            let radius = 10.0 + rough * random.below(1000) as f64 / 1000.0;
            let point = [
                latitude.sin() * longitude.sin(),
                latitude.cos(),
                latitude.sin() * longitude.cos(),
            ];
            positions.push(point.map(|x| on_lattice(radius * x)));
        }
    }
    let mut faces = Vec::new();
    for ring in 0..rings {
        for step in 0..around {
            let at = |ring: u32, step: u32| ring * around + step % around;
            let [a, b, c, d] = [
                at(ring, step),
                at(ring + 1, step),
                at(ring + 1, step + 1),
                at(ring, step + 1),
            ];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    if is_inside_out {
        faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    Mesh::new(positions, faces).unwrap()
}

/// Faces anywhere, some without an area.
pub(super) fn soup(random: &mut SplitMix64) -> Mesh {
    let count = 3 + random.below(30);
    let range = [3, 50, 40_000][random.below(3)];
    let positions = (0..count).map(|_| [(); 3].map(|()| random.below(range) as f32 * UNIT));
    let positions: Vec<[f32; 3]> = positions.collect();
    let faces = (0..1 + random.below(60)).map(|_| [(); 3].map(|()| index32(random.below(count))));
    Mesh::new(positions, faces.collect::<Vec<_>>()).unwrap()
}

/// An eye: anywhere, near or far; along an axis; or, of a face, along its normal, in its plane or at a corner.
pub(super) fn any_eye(mesh: &Mesh, ball: Ball, random: &mut SplitMix64) -> Eye {
    let wide = |random: &mut SplitMix64| random.below(2001) as f64 / 1000.0 - 1.0;
    let mut direction = [wide(random), wide(random), wide(random)];
    let mut from = ball.center;
    match random.below(5) {
        // On the border of ranges, for all numbers of them that divide 64.
        4 => {
            let longitude = std::f64::consts::TAU * random.below(64) as f64 / 64.0;
            direction[0] = longitude.sin();
            direction[2] = longitude.cos();
        }
        0 => {
            direction = [
                [0.0, 1.0, 0.0],
                [0.0, -1.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 0.0, 1.0],
            ][random.below(4)]
        }
        1 | 2 => {
            let face = mesh.faces()[random.below(mesh.face_count())];
            let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize].map(f64::from));
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let normal = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            direction = [normal, u, v, normal.map(|x| -x)][random.below(4)];
            if random.below(2) == 0 {
                from = a;
            }
        }
        _ => {}
    }
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    if random.below(4) == 0 {
        let eye = direction.map(|x| on_lattice(1000.0 * x / length.max(1e-9)));
        return Eye::towards(eye);
    }
    let far = ball.radius * [0.5, 1.0001, 1.01, 1.5, 4.0, 10.0, 100.0][random.below(7)];
    Eye::at([0, 1, 2].map(|i| on_lattice(from[i] + far * direction[i] / length.max(1e-9))))
}

/// Asserts that all front faces are in the ranges.
pub(super) fn assert_all_front(mesh: &Mesh, order: &[u32], eye: Eye, ranges: &Ranges) {
    let mut is_drawn = vec![false; mesh.face_count()];
    for range in ranges.as_slice() {
        for place in range.clone() {
            is_drawn[order[place as usize] as usize] = true;
        }
    }
    for (face, is_drawn) in mesh.faces().iter().zip(is_drawn) {
        let corners = face.map(|vertex| mesh.positions()[vertex as usize]);
        assert!(
            is_drawn || !is_front(corners, eye),
            "{corners:?} from {eye:?}"
        );
    }
}

/// A rough ball, inside out or not, or a soup.
pub(super) fn any_mesh(case: u64, random: &mut SplitMix64) -> Mesh {
    match case % 3 {
        0 => soup(random),
        _ => {
            let (rings, around) = (2 + index32(random.below(12)), 3 + index32(random.below(20)));
            let rough = [0.0, 1.0, 8.0][random.below(3)];
            ball(rings, around, rough, random.below(2) == 0, random)
        }
    }
}

/// How many meshes a test has, each seen from 60 eyes.
pub(super) fn cases(usual: u64) -> u64 {
    from_environment("MESHWEFT_CASES", usual)
}

/// Random numbers of a test.
pub(super) fn any_numbers(usual: u64) -> SplitMix64 {
    SplitMix64(from_environment("MESHWEFT_SEED", usual))
}
