//! No front face is left out, by exact signs.

use super::{CullingTable, Eye, EyeBox, NormalStripes, Ranges, ViewClusters};
use crate::geometry::Ball;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::random::{SplitMix64, from_environment};

/// Positions and eyes are multiples of this, so that signs are exact in 128 bits.
const UNIT: f32 = 1.0 / 4096.0;

fn in_units(x: f32) -> i128 {
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
fn soup(random: &mut SplitMix64) -> Mesh {
    let count = 3 + random.below(30);
    let range = [3, 50, 40_000][random.below(3)];
    let positions = (0..count).map(|_| [(); 3].map(|()| random.below(range) as f32 * UNIT));
    let positions: Vec<[f32; 3]> = positions.collect();
    let faces = (0..1 + random.below(60)).map(|_| [(); 3].map(|()| index32(random.below(count))));
    Mesh::new(positions, faces.collect::<Vec<_>>()).unwrap()
}

/// An eye: anywhere, near or far; along an axis; or, of a face, along its normal, in its plane or at a corner.
fn any_eye(mesh: &Mesh, ball: Ball, random: &mut SplitMix64) -> Eye {
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

/// How many meshes a test has, each seen from 60 eyes.
fn cases(usual: u64) -> u64 {
    from_environment("MESHWEFT_CASES", usual)
}

/// Random numbers of a test.
fn any_numbers(usual: u64) -> SplitMix64 {
    SplitMix64(from_environment("MESHWEFT_SEED", usual))
}

#[test]
fn stripes_leave_out_no_front_face() {
    let mut random = any_numbers(1);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(120) {
        let mesh = any_mesh(case, &mut random);
        let stripes = NormalStripes {
            stripe_count: Some([1, 2, 4, 16, 64][random.below(5)]),
            range_count: [1, 2, 7, 64, 512][random.below(5)],
        };
        let striped = stripes.order(&mesh);
        let around = striped.ball().unwrap();
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, around, &mut random);
            striped.visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, striped.order().new_to_old(), eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 10, "{culled} of {all} faces were culled");
}

/// A rough ball, inside out or not, or a soup.
fn any_mesh(case: u64, random: &mut SplitMix64) -> Mesh {
    match case % 3 {
        0 => soup(random),
        _ => {
            let (rings, around) = (2 + index32(random.below(12)), 3 + index32(random.below(20)));
            let rough = [0.0, 1.0, 8.0][random.below(3)];
            ball(rings, around, rough, random.below(2) == 0, random)
        }
    }
}

/// Where clusters of any size begin.
fn any_starts(face_count: usize, random: &mut SplitMix64) -> Vec<u32> {
    let largest = [1, 4, 30, 1000][random.below(4)];
    let mut starts = vec![0];
    while let left @ 1.. = face_count - *starts.last().unwrap() as usize {
        starts.push(starts.last().unwrap() + index32(1 + random.below(largest.min(left))));
    }
    starts
}

#[test]
fn clusters_leave_out_no_front_face() {
    let mut random = any_numbers(3);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(120) {
        let mesh = any_mesh(case, &mut random);
        let starts = any_starts(mesh.face_count(), &mut random);
        let table = CullingTable::new(&mesh, &starts);
        let order: Vec<u32> = (0..index32(mesh.face_count())).collect();
        let used = mesh.faces().as_flattened().iter();
        let used = used.map(|&vertex| mesh.positions()[vertex as usize].map(f64::from));
        let around = Ball::around(used).unwrap();
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, around, &mut random);
            table.visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, &order, eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 5, "{culled} of {all} faces were culled");
}

#[test]
fn clusters_by_view_leave_out_no_front_face() {
    let mut random = any_numbers(6);
    let mut culled = 0;
    let mut all = 0;
    for case in 0..cases(40) {
        let mesh = any_mesh(case, &mut random);
        let clustered = ViewClusters::default().order(&mesh);
        let order = clustered.order().new_to_old();
        let striped = NormalStripes::default().order(&mesh);
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&mesh, striped.ball().unwrap(), &mut random);
            clustered.table().visible_ranges(eye, &mut ranges);
            assert_all_front(&mesh, order, eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
            all += mesh.face_count();
        }
    }
    assert!(culled > all / 6, "{culled} of {all} faces were culled");
}

/// Positions moved by less than an error: what was a table of the mesh before still leaves out nothing.
#[test]
fn positions_may_be_off_by_an_error_that_is_known() {
    let mut random = any_numbers(7);
    let mut culled = 0;
    for case in 0..cases(60) {
        let mesh = any_mesh(case, &mut random);
        let steps = [1, 16, 256][random.below(3)];
        let clusters = ViewClusters {
            position_error: steps as f32 * UNIT * 1.75,
            ..ViewClusters::default()
        };
        let clustered = clusters.order(&mesh);
        let moved = mesh.positions().iter();
        let moved = moved.map(|position| {
            position.map(|x| x + (random.below(2 * steps + 1) as f32 - steps as f32) * UNIT)
        });
        let moved = Mesh::new(moved.collect::<Vec<_>>(), mesh.faces().to_vec()).unwrap();
        let striped = NormalStripes::default().order(&moved);
        let mut ranges = Ranges::default();
        for _ in 0..60 {
            let eye = any_eye(&moved, striped.ball().unwrap(), &mut random);
            clustered.table().visible_ranges(eye, &mut ranges);
            assert_all_front(&moved, clustered.order().new_to_old(), eye, &ranges);
            culled += mesh.face_count() - ranges.face_count();
        }
    }
    assert!(culled > 50_000, "{culled} faces were culled");
}

#[test]
fn what_any_eye_of_a_box_sees_is_drawn() {
    let mut random = any_numbers(4);
    let mut culled = [0, 0];
    for case in 0..cases(60) {
        let mesh = any_mesh(case, &mut random);
        let starts = any_starts(mesh.face_count(), &mut random);
        let table = CullingTable::new(&mesh, &starts);
        let striped = NormalStripes::default().order(&mesh);
        let whole: Vec<u32> = (0..index32(mesh.face_count())).collect();
        let around = striped.ball().unwrap();
        let mut ranges = [Ranges::default(), Ranges::default()];
        for _ in 0..20 {
            let [x, y, z, w] = any_eye(&mesh, around, &mut random).point;
            let size = [0.0, 0.01, 0.1, 1.0][random.below(4)];
            let half = [(); 3]
                .map(|()| on_lattice(size * around.radius * random.below(1000) as f64 / 1000.0));
            let low = [x - half[0], y - half[1], z - half[2]];
            let high = [x + half[0], y + half[1], z + half[2]];
            let eyes = EyeBox { low, high, w };
            table.ranges_visible_within(eyes, &mut ranges[0]);
            striped.ranges_visible_within(eyes, &mut ranges[1]);
            for _ in 0..10 {
                let [x, y, z] =
                    [0, 1, 2].map(|i| [low[i], high[i], low[i] + half[i]][random.below(3)]);
                let eye = Eye {
                    point: [x, y, z, w],
                };
                assert_all_front(&mesh, &whole, eye, &ranges[0]);
                assert_all_front(&mesh, striped.order().new_to_old(), eye, &ranges[1]);
            }
            for (culled, ranges) in culled.iter_mut().zip(&ranges) {
                *culled += mesh.face_count() - ranges.face_count();
            }
        }
    }
    assert!(
        culled.iter().all(|&count| count > 10_000),
        "{culled:?} faces were culled"
    );
}

#[test]
fn an_eye_inside_or_no_eye_sees_everything() {
    let mesh = ball(8, 12, 0.0, false, &mut SplitMix64(2));
    let striped = NormalStripes::default().order(&mesh);
    let mut ranges = Ranges::default();
    for point in [
        [0.0, 0.0, 0.0, 1.0],
        [9.0, 0.0, 0.0, 1.0],
        [0.0; 4],
        [f32::NAN, 0.0, 0.0, 1.0],
        [99.0, 0.0, 0.0, -1.0],
        [f32::INFINITY, 0.0, 0.0, 1.0],
    ] {
        striped.visible_ranges(Eye { point }, &mut ranges);
        assert_eq!(ranges.face_count(), mesh.face_count(), "{point:?}");
    }
    // Half of a ball is hidden; the ranges at the border are drawn too.
    striped.visible_ranges(Eye::towards([1.0, 0.0, 0.0]), &mut ranges);
    assert!(ranges.face_count() < mesh.face_count() * 2 / 3);
}
