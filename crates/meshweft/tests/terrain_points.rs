//! Terrains over real points: samples of a height map, and the vertices of a mesh.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/placed.rs"]
mod placed;

use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

use meshweft::lod::CameraView;
use meshweft::lod::quad_tin::{PointHierarchy, TinSurface};

/// Samples of a tile at random places, in metres.
fn samples(folder: &Path, count: usize) -> Vec<[f32; 3]> {
    let packed = std::fs::read(folder.join("terrain/N47W122.hgt.gz")).unwrap();
    let mut bytes = Vec::new();
    let mut decoder = flate2::read::GzDecoder::new(&packed[..]);
    decoder.read_to_end(&mut bytes).unwrap();
    let heights = bytes.as_chunks::<2>().0;
    let side = heights.len().isqrt();
    assert_eq!(side * side, heights.len());
    let mut state = 1_u64;
    let mut below = |limit: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from(state >> 33).unwrap() % limit
    };
    let sample = |_| {
        let [column, row] = [below(side), below(side)];
        let height = i16::from_be_bytes(heights[row * side + column]);
        [63.0 * column as f32, f32::from(height), 93.0 * row as f32]
    };
    (0..count).map(sample).collect()
}

/// The heights of the faces above and below a place.
fn heights<'a>(faces: &'a [[[f64; 3]; 3]], [x, _, z]: [f64; 3]) -> impl Iterator<Item = f64> + 'a {
    faces.iter().filter_map(move |&[a, b, c]| {
        let area =
            |p: [f64; 3], q: [f64; 3]| (q[2] - p[2]) * (x - p[0]) - (q[0] - p[0]) * (z - p[2]);
        let shares = [area(b, c), area(c, a), area(a, b)];
        let whole: f64 = shares.iter().sum();
        let is_inside = shares.iter().all(|&it| it >= -1e-9 * whole);
        is_inside.then(|| (shares[0] * a[1] + shares[1] * b[1] + shares[2] * c[1]) / whole)
    })
}

/// Every surface is whole, and as near to the points as it says.
fn assert_surfaces_are_near(points: &[[f32; 3]]) {
    let terrain = PointHierarchy::over(points).unwrap();
    let counts = terrain.counts();
    println!("{counts:?}");
    assert_eq!((counts.left_out, counts.not_finite), (0, 0));
    let sources = (0..terrain.vertex_count()).map(|it| terrain.source(u32::try_from(it).unwrap()));
    let used: BTreeSet<u32> = sources.flatten().collect();
    assert_eq!(used.len(), points.len() - counts.duplicates as usize);

    let height = |it: &[f32; 3]| it[1];
    let [low, high] = [f32::min, f32::max].map(|of| points.iter().map(height).reduce(of).unwrap());
    let mut surface = TinSurface::default();
    let mut last = usize::MAX;
    for part in [-1.0, 0.0, 0.003, 0.02, 0.1, 2.0] {
        let limit = f64::from(high - low) * part;
        terrain.draw(&CameraView::of_errors_above(limit).unwrap(), &mut surface);
        assert!(surface.faces().len() <= last);
        last = surface.faces().len();

        // Each side has a face on its right, unless it is part of the border.
        let mut sides = BTreeSet::new();
        for &(_, [a, b, c]) in surface.faces() {
            assert!(sides.insert((a, b)) && sides.insert((b, c)) && sides.insert((c, a)));
        }
        let open: Vec<_> = sides
            .iter()
            .filter(|it| !sides.contains(&(it.1, it.0)))
            .collect();
        for &&(from, to) in &open {
            let [a, b] = [from, to].map(|it| terrain.position(it));
            assert!(a[0] == b[0] || a[2] == b[2], "{a:?} {b:?}");
        }

        let corners = |face: &(u32, [u32; 3])| face.1.map(|it| terrain.position(it).map(f64::from));
        let faces: Vec<_> = surface.faces().iter().map(corners).collect();
        for &source in used.iter().step_by(1 + used.len() / 400) {
            let point = points[source as usize].map(f64::from);
            let distances = heights(&faces, point).map(|it| (it - point[1]).abs());
            let farthest = distances.fold(None, |most: Option<f64>, it| {
                Some(most.map_or(it, |most| most.max(it)))
            });
            let farthest = farthest.expect("a face above or below each point");
            assert!(
                farthest <= limit.max(0.0) + 1e-6 * f64::from(high - low),
                "{point:?}: {farthest} at {limit}"
            );
        }
    }
    assert_eq!(last, 2);
}

#[test]
fn surfaces_over_samples_of_a_height_map_are_near_all_of_them() {
    let Some(folder) = data::folder() else { return };
    for count in [300, 5_000, 40_000] {
        assert_surfaces_are_near(&samples(&folder, count));
    }
}

#[test]
fn surfaces_over_the_vertices_of_a_mesh_are_near_all_of_them() {
    let Some(folder) = data::folder() else { return };
    let mesh = placed::open(&folder, "mountain.obj.gz");
    assert_surfaces_are_near(mesh.positions());
}
