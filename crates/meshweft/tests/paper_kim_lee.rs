//! What Kim and Lee's potentially visible sets leave out on average, as it follows from the geometry: for any mesh, and for
//! spheres as the paper says.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/placed.rs"]
mod placed;

use std::f64::consts::{PI, TAU};

use meshweft::Mesh;
use meshweft::culling::{Eye, NormalStripes, Ranges, StripedFaces};
use placed::open;

/// Closed surfaces.
const MESHES: [&str; 4] = [
    "spot.obj.gz",
    "cow_poly.obj.gz",
    "fandisk.off.gz",
    "horse_20k.off.gz",
];

/// How many directions an average is taken over.
const DIRECTIONS: u32 = 1024;

type Vector = [f64; 3];

/// A sphere by rings, with triangles at the poles.
fn sphere(rings: u32, around: u32) -> Mesh {
    let point = |ring: u32, step: u32| {
        let (latitude, longitude) = (
            PI * f64::from(ring) / f64::from(rings),
            TAU * f64::from(step) / f64::from(around),
        );
        [
            latitude.sin() * longitude.sin(),
            latitude.cos(),
            latitude.sin() * longitude.cos(),
        ]
        .map(narrowed)
    };
    let steps = (0..=rings).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let positions: Vec<[f32; 3]> = steps.map(|(ring, step)| point(ring, step)).collect();
    let mut faces = Vec::new();
    for (ring, step) in (0..rings).flat_map(|ring| (0..around).map(move |step| (ring, step))) {
        let at = |ring: u32, step: u32| ring * around + step % around;
        let [a, b, c, d] = [
            at(ring, step),
            at(ring + 1, step),
            at(ring + 1, step + 1),
            at(ring, step + 1),
        ];
        if ring + 1 < rings {
            faces.push([a, b, c]);
        }
        if ring > 0 {
            faces.push([a, c, d]);
        }
    }
    Mesh::new(positions, faces).unwrap()
}

#[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
fn narrowed(x: f64) -> f32 {
    x as f32
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Directions alike in all parts of the sphere.
fn directions() -> impl Iterator<Item = Vector> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..DIRECTIONS).map(move |_| {
        let (height, longitude) = (2.0 * random() - 1.0, TAU * random());
        let radius = (1.0 - height * height).sqrt();
        [radius * longitude.sin(), height, radius * longitude.cos()]
    })
}

/// The normals of faces with an area, and how far their planes are from a point.
fn planes(mesh: &Mesh, center: Vector) -> Vec<(Vector, f64)> {
    let plane = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize].map(f64::from));
        let (u, v) = (minus(b, a), minus(c, a));
        let n = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let length = dot(n, n).sqrt();
        let n = n.map(|x| x / length);
        (length > 0.0).then(|| (n, dot(n, minus(a, center))))
    };
    mesh.faces().iter().filter_map(plane).collect()
}

/// The mean, and how far it may be from that of all directions, three times over.
fn mean(shares: &[f64]) -> (f64, f64) {
    let count = shares.len() as f64;
    let mean = shares.iter().sum::<f64>() / count;
    let square = shares
        .iter()
        .map(|share| (share - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0);
    (mean, 3.0 * (square / count).sqrt())
}

/// An eye at a distance from the middle of the faces' ball.
fn eye(striped: &StripedFaces, direction: Vector, distance: f64) -> Eye {
    let center = striped.ball().unwrap().center;
    Eye::at([0, 1, 2].map(|axis| narrowed(center[axis] + distance * direction[axis])))
}

#[test]
fn any_mesh_has_the_same_share_beyond_the_cap_and_back_faces_by_its_offsets() {
    let Some(folder) = data::folder() else { return };
    for name in MESHES {
        let mesh = open(&folder, name);
        let striped = NormalStripes::default().order(&mesh);
        let ball = striped.ball().unwrap();
        let planes = planes(&mesh, ball.center);
        let count = planes.len() as f64;
        for times in [1.5, 4.0, 10.0] {
            let (distance, sine) = (times * ball.radius, 1.0 / times);
            let share = |of: &dyn Fn(&(Vector, f64), Vector) -> bool| {
                let shares = directions()
                    .map(|d| planes.iter().filter(|plane| of(plane, d)).count() as f64 / count);
                mean(&shares.collect::<Vec<_>>())
            };

            // A normal is in no eye's cap as often as not, but for the cap's part beyond a half.
            let (culled, error) = share(&|(n, _), d| dot(*n, d) < -sine);
            assert!(
                (culled - (1.0 - sine) / 2.0).abs() <= error,
                "{name}, {times} r: {culled}"
            );

            let offsets: f64 = planes.iter().map(|(_, offset)| offset).sum();
            let expected = 0.5 + offsets / count / (2.0 * distance);
            let (back, error) = share(&|(n, offset), d| dot(*n, d) * distance <= *offset);
            assert!(
                (back - expected).abs() <= error,
                "{name}, {times} r: {back}, {expected}"
            );
        }
    }
}

#[test]
fn sixteen_stripes_leave_out_nearly_what_ideal_ones_would() {
    let Some(folder) = data::folder() else { return };
    for name in MESHES {
        let mesh = open(&folder, name);
        let stripes = NormalStripes {
            stripe_count: Some(16),
            ..Default::default()
        };
        let striped = stripes.order(&mesh);
        let distance = 4.0 * striped.ball().unwrap().radius;
        let mut ranges = Ranges::default();
        let shares = directions().map(|direction| {
            let drawn = striped.visible_ranges(eye(&striped, direction, distance), &mut ranges);
            assert!(drawn.as_slice().len() <= 2 * 16 + 1);
            1.0 - drawn.face_count() as f64 / mesh.face_count() as f64
        });
        let (culled, error) = mean(&shares.collect::<Vec<_>>());
        assert!(
            (0.375 - 0.045..0.375 + error).contains(&culled),
            "{name}: {culled}"
        );
    }
}

#[test]
fn of_a_sphere_the_papers_share_of_back_faces_is_left_out() {
    let mesh = sphere(128, 256);
    let stripes = NormalStripes {
        stripe_count: Some(256),
        ..Default::default()
    };
    let striped = stripes.order(&mesh);
    let ball = striped.ball().unwrap();
    let planes = planes(&mesh, ball.center);
    let mut ranges = Ranges::default();
    for times in [1.5, 2.0, 3.0, 4.0, 10.0] {
        let distance = times * ball.radius;
        let (mut culled, mut back) = (0, 0);
        for direction in directions().take(64) {
            let drawn = striped.visible_ranges(eye(&striped, direction, distance), &mut ranges);
            culled += mesh.face_count() - drawn.face_count();
            let is_back = |(n, offset): &&(Vector, f64)| dot(*n, direction) * distance <= *offset;
            back += planes.iter().filter(is_back).count();
        }
        let (share, formula) = (culled as f64 / back as f64, (times - 1.0) / (times + 1.0));
        assert!(
            (formula - 0.03..formula + 0.01).contains(&share),
            "{times} r: {share}, {formula}"
        );
    }
}
