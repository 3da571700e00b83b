//! Known distances, and brute force over all faces.

use super::*;
use crate::geometry::double::dot;
use crate::geometry::triangle::way_to_triangle;
use crate::random::SplitMix64;

/// A cube of side 1 with its lowest corner here, two faces a side.
fn cube(low: [f32; 3]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let corner = |i: u32| [0, 1, 2].map(|axis| low[axis] + ((i >> axis) & 1) as f32);
    let mut faces = Vec::new();
    for [x, y, z] in [[1, 2, 4], [2, 4, 1], [4, 1, 2]] {
        for base in [0, z] {
            faces.extend([
                [base, base + x, base + y],
                [base + x, base + x + y, base + y],
            ]);
        }
    }
    ((0..8).map(corner).collect(), faces)
}

fn assert_near(found: f64, expected: f64, within: f64) {
    let is_near = (found - expected).abs() <= within;
    assert!(is_near, "{found}, not {expected}");
}

/// Shifted by half a side along x. Of the sides across x, the outer one is .5 away, and from the inner
/// one, inside the other cube, the nearest is its rim or .5 away: mean 1/6, mean square 1/24. The other
/// four are away by .5 − x up to the middle: mean 1/8, mean square 1/24.
#[test]
fn a_shifted_cube() {
    let [a, b] = [cube([0.0; 3]), cube([0.5, 0.0, 0.0])];
    let [a, b] = [&a, &b].map(|(positions, faces)| Surface::new(positions, faces));
    let found = deviation(&a, &b, 100_000);
    for distances in [found.one_way[0], found.one_way[1], found.two_sided] {
        assert_eq!(distances.max, 0.5);
        assert_near(distances.mean, (0.5 + 1.0 / 6.0 + 4.0 / 8.0) / 6.0, 1e-4);
        let square: f64 = (0.25 + 1.0 / 24.0 + 4.0 / 24.0) / 6.0;
        assert_near(distances.rms, square.sqrt(), 1e-4);
    }
    assert_eq!(found.one_way[0].points, 100_008);
    assert_eq!(found.two_sided.points, 200_016);

    let itself = deviation(&a, &a, 1000).two_sided;
    assert!(itself.max < 1e-15, "{itself:?}");
}

/// A small square above the middle of a large one: the ways differ, and the area decides.
#[test]
fn one_way_is_not_the_other() {
    let square = |half: f32, z: f32| {
        let corner = |x: f32, y: f32| [x * half, y * half, z];
        [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| corner(x, y))
    };
    let (small, large) = (square(1.0, 3.0), square(5.0, 0.0));
    let faces = [[0, 1, 2], [2, 1, 3]];
    let [small, large] = [&small, &large].map(|positions| Surface::new(positions, &faces));
    let found = deviation(&small, &large, 50_000);
    let [up, down] = found.one_way;
    assert_near(up.max, 3.0, 1e-15);
    assert_near(up.mean, 3.0, 1e-12);
    assert_near(down.max, (16.0_f64 + 16.0 + 9.0).sqrt(), 1e-15);
    assert!(down.mean > 3.5 && down.mean < down.rms && down.rms < down.max);
    assert_eq!(found.two_sided.max, down.max);
    assert_near(
        found.two_sided.mean,
        (4.0 * up.mean + 100.0 * down.mean) / 104.0,
        1e-12,
    );
    let square = (4.0 * up.rms * up.rms + 100.0 * down.rms * down.rms) / 104.0;
    assert_near(found.two_sided.rms, square.sqrt(), 1e-12);
    let back = deviation(&large, &small, 50_000);
    assert_eq!(back.one_way, [down, up]);
    assert_near(back.two_sided.mean, found.two_sided.mean, 1e-12);
}

#[test]
fn without_samples_the_vertices_are_measured() {
    let positions = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let surface = Surface::new(&positions, &[[0, 1, 2]]);
    let (above, point) = ([[1.0, 1.0, 2.0]], [[0, 0, 0]]);
    let point = Surface::new(&above, &point);

    // A single point has no area, so its vertex is all that is measured from it, and weighs nothing.
    let found = deviation(&point, &surface, 1000);
    let [from_point, back] = found.one_way;
    assert_eq!((from_point.points, back.points), (1, 1003));
    assert_eq!(
        (from_point.mean, from_point.rms, from_point.max),
        (2.0, 2.0, 2.0)
    );
    assert_eq!(found.two_sided.mean, back.mean);
    assert_eq!(deviation(&point, &surface, 0).one_way[1].points, 3);
    let nearer = [[1.0, 1.0, 1.0]];
    let two = deviation(&point, &Surface::new(&nearer, &[[0, 0, 0]]), 9).two_sided;
    assert_eq!((two.mean, two.rms, two.max, two.points), (1.0, 1.0, 1.0, 2));
}

#[test]
fn surfaces_without_faces() {
    let (positions, faces) = cube([0.0; 3]);
    let surface = Surface::new(&positions, &faces);
    let empty = Surface::new(&[], &[]);
    assert_eq!(deviation(&empty, &empty, 100), Deviation::default());
    for (found, to_empty) in [
        (deviation(&surface, &empty, 100), 0),
        (deviation(&empty, &surface, 100), 1),
    ] {
        let infinite = f64::INFINITY;
        for it in [found.one_way[to_empty], found.two_sided] {
            assert_eq!((it.max, it.mean, it.rms), (infinite, infinite, infinite));
        }
        assert_eq!(found.one_way[1 - to_empty], Distances::default());
    }
    let points = [[1.0; 3], [f32::NAN; 3]];
    let point = Surface::new(&points, &[[0, 0, 0], [0, 1, 0]]);
    let found = deviation(&point, &empty, 100);
    assert_eq!(
        (found.two_sided.mean, found.two_sided.points),
        (f64::INFINITY, 1)
    );
}

/// The same points, all faces for each of them.
#[test]
fn the_same_by_brute_force() {
    let mut random = SplitMix64(9);
    let mut bent = |side: u32, height: usize| {
        let mut positions = Vec::new();
        for at in 0..(side + 1) * (side + 1) {
            let [x, y] = [at % (side + 1), at / (side + 1)].map(|i| i as f32 / side as f32);
            positions.push([x, y, random.below(height) as f32 / 1000.0]);
        }
        let mut faces = Vec::new();
        for at in 0..side * side {
            let a = at / side * (side + 1) + at % side;
            faces.extend([
                [a, a + 1, a + side + 1],
                [a + 1, a + side + 2, a + side + 1],
            ]);
        }
        (positions, faces)
    };
    let meshes = [bent(12, 100), bent(5, 300)];
    let [fine, coarse] = [&meshes[0], &meshes[1]].map(|(p, f)| Surface::new(p, f));
    let found = deviation(&fine, &coarse, 20_000);
    for (it, (from, to)) in found
        .one_way
        .iter()
        .zip([(&fine, &coarse), (&coarse, &fine)])
    {
        let distance = |point: [f64; 3]| {
            let ways = to.corners().iter().map(|corners| {
                let way = way_to_triangle(point, corners.map(widened));
                dot(way, way)
            });
            ways.fold(f64::INFINITY, f64::min).sqrt()
        };
        let samples = Samples::new(from, 20_000);
        let of_area: Vec<f64> = samples.points(0..20_000).map(distance).collect();
        let of_vertices = from.used_vertices().into_iter().map(widened).map(distance);
        let mean = of_area.iter().sum::<f64>() / 20_000.0;
        let square = of_area.iter().map(|d| d * d).sum::<f64>() / 20_000.0;
        assert_near(it.mean, mean, 1e-13);
        assert_near(it.rms, square.sqrt(), 1e-13);
        let max = of_area
            .iter()
            .copied()
            .chain(of_vertices)
            .fold(0.0, f64::max);
        assert_near(it.max, max, 1e-13);
    }
    assert!(found.two_sided.mean > 0.0);
}

#[cfg(feature = "parallel")]
#[test]
fn threads_do_not_change_it() {
    let [a, b] = [cube([0.0; 3]), cube([0.3, 0.2, 0.1])];
    let [a, b] = [&a, &b].map(|(positions, faces)| Surface::new(positions, faces));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| deviation(&a, &b, 50_000))
    };
    assert_eq!(on(1), on(3));
}
