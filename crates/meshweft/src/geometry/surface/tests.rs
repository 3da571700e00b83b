//! The nearest point by brute force over all faces.

use super::*;
use crate::random::SplitMix64;

/// Faces at random on a coarse lattice, which gives flat ones, equal distances and shared points.
fn soup(random: &mut SplitMix64, faces: usize) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let vertices = faces.div_ceil(2) + 3;
    let mut coordinate = || random.below(9) as f32 * 0.25 - 1.0;
    let positions = (0..vertices).map(|_| [(); 3].map(|()| coordinate()));
    let positions = positions.collect();
    let mut corner = || index32(random.below(vertices));
    let faces = (0..faces).map(|_| [(); 3].map(|()| corner())).collect();
    (positions, faces)
}

fn by_brute_force(positions: &[[f32; 3]], faces: &[[u32; 3]], point: [f64; 3]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (number, face) in faces.iter().enumerate() {
        let corners = face.map(|v| widened(positions[v as usize]));
        let way = way_to_triangle(point, corners);
        if dot(way, way) < best.1 {
            best = (number, dot(way, way));
        }
    }
    best
}

#[test]
fn the_nearest_of_all_faces() {
    let mut random = SplitMix64(5);
    for faces in [1, 2, 4, 5, 9, 33, 300] {
        let (positions, faces) = soup(&mut random, faces);
        let surface = Surface::new(&positions, &faces);
        for _ in 0..200 {
            let point = [(); 3].map(|()| random.below(33) as f64 / 8.0 - 2.0);
            let (face, square) = by_brute_force(&positions, &faces, point);
            let found = surface.nearest(point).unwrap();
            assert_eq!(found.distance, square.sqrt());
            assert_eq!(found.face as usize, face);
            let way = sub(found.point, point);
            assert!((dot(way, way).sqrt() - found.distance).abs() < 1e-12);

            // From any start the same.
            let start = random.below(faces.len());
            assert_eq!(surface.search(point, start).square, square);
        }
        for corner in faces.as_flattened() {
            let corner = widened(positions[*corner as usize]);
            let found = surface.nearest(corner).unwrap();
            assert_eq!((found.distance, found.point), (0.0, corner));
        }
    }
}

#[test]
fn what_is_not_finite_is_left_out() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [f32::NAN, 0.0, 0.0],
        [0.0, f32::INFINITY, 0.0],
    ];
    let faces = [[0, 1, 3], [4, 1, 2], [0, 1, 2]];
    let surface = Surface::new(&positions, &faces);
    assert_eq!(surface.len(), 1);
    assert_eq!(surface.nearest([0.0, 0.0, 7.0]).unwrap().face, 2);
    assert_eq!(surface.used_vertices(), positions[..3]);
    assert_eq!(surface.nearest([0.0, f64::NAN, 7.0]), None);
    assert_eq!(surface.nearest([0.0, f64::INFINITY, 7.0]), None);
    assert_eq!(
        Surface::new(&positions, &faces[..2]).nearest([0.0; 3]),
        None
    );
    assert_eq!(Surface::new(&[], &[]).nearest([0.0; 3]), None);
}

#[test]
fn the_largest_and_smallest_coordinates() {
    let [most, least] = [f32::MAX, f32::from_bits(1)];
    for size in [most, least] {
        let positions = [
            [-size, -size, 0.0],
            [size, -size, 0.0],
            [-size, size, 0.0],
            [size, size, 0.0],
        ];
        let surface = Surface::new(&positions, &[[0, 1, 2], [2, 1, 3]]);
        let wide = f64::from(size);
        let found = surface.nearest([wide / 2.0, wide / 4.0, wide]).unwrap();
        assert_eq!((found.face, found.distance), (1, wide));
    }

    let positions = [[most, 0.0, 0.0], [0.0, most, 0.0], [0.0, 0.0, -most]];
    let surface = Surface::new(&positions, &[[0, 1, 2]]);
    for far in [[1e100; 3], [-1e100, 0.0, 1e100], [1e100, 3.0, -1e100]] {
        let found = surface.nearest(far).unwrap();
        let distance = dot(far, far).sqrt();
        assert!((found.distance / distance - 1.0).abs() < 1e-12, "{found:?}");
    }
    assert_eq!(surface.nearest([0.0, -2e100, 0.0]), None);
}

/// Many faces whose centres are the same cannot be told apart by their centres.
#[test]
fn faces_at_one_place() {
    let positions = [[0.0; 3], [1.0; 3], [2.0, 0.0, 1.0]];
    let faces = vec![[0, 1, 2]; 10_000];
    let surface = Surface::new(&positions, &faces);
    assert_eq!(surface.nearest([0.0, 5.0, 0.0]).unwrap().face, 0);
}
