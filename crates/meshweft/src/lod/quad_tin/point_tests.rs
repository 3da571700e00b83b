//! What every hierarchy over points has to be, by exact arithmetic and naive loops.

use std::collections::{BTreeMap, BTreeSet};

use super::point_input::PointsError;
use super::point_sets::{self, SETS, UNIT};
use super::points::PointHierarchy;
use super::triangle::{BisectionTree, NONE, TinTriangle};
use crate::geometry::double::{dot, sub, widened};
use crate::geometry::signs::turn;
use crate::index::index32;
use crate::random::{SplitMix64, from_environment};

pub(super) fn over(points: &[[f32; 3]]) -> PointHierarchy {
    PointHierarchy::over(points).unwrap()
}

/// Every triangle of the hierarchy, before those that it is cut into.
pub(super) fn all_triangles(tree: &PointHierarchy) -> Vec<TinTriangle> {
    let mut triangles = tree.roots().to_vec();
    let mut at = 0;
    while at < triangles.len() {
        let triangle = triangles[at];
        if triangle.split != NONE {
            triangles.extend(tree.halves(&triangle));
        }
        at += 1;
    }
    triangles
}

/// The triangles that are not cut where errors above a limit are.
pub(super) fn drawn(tree: &PointHierarchy, limit: f32) -> Vec<TinTriangle> {
    let mut open = tree.roots().to_vec();
    let mut drawn = Vec::new();
    while let Some(triangle) = open.pop() {
        let is_cut = |split: u32| tree.nodes[split as usize].error > limit;
        match triangle.split != NONE && is_cut(triangle.split) {
            true => open.extend(tree.halves(&triangle)),
            false => drawn.push(triangle),
        }
    }
    drawn
}

fn corners(tree: &PointHierarchy, triangle: &TinTriangle) -> [[f32; 3]; 3] {
    [triangle.apex, triangle.left, triangle.right].map(|it| tree.nodes[it as usize].position)
}

/// Each point of the input that is at a place of its own is one vertex, bit for bit.
pub(super) fn assert_all_are_vertices(tree: &PointHierarchy, points: &[[f32; 3]]) {
    let mut is_vertex = vec![false; points.len()];
    let mut steiner = 0;
    for (node, &source) in tree.nodes.iter().zip(&tree.sources) {
        if source == NONE {
            steiner += 1;
            continue;
        }
        assert!(!std::mem::replace(&mut is_vertex[source as usize], true));
        let bits = |it: [f32; 3]| it.map(f32::to_bits);
        assert_eq!(bits(node.position), bits(points[source as usize]));
    }
    let counts = tree.counts;
    let others = counts.not_finite + counts.duplicates + counts.left_out;
    let vertices = is_vertex.iter().filter(|&&it| it).count();
    assert_eq!(vertices, points.len() - others as usize);
    assert_eq!(steiner, counts.steiner);

    // The first point of a place is the one that stays.
    let mut places = BTreeSet::new();
    for (point, is_vertex) in points.iter().zip(is_vertex) {
        let [x, _, z] = point.map(|it| (it + 0.0).to_bits());
        let is_first = point.iter().all(|x| x.is_finite()) && places.insert((x, z));
        assert!(is_first || !is_vertex);
        assert!(is_vertex || !is_first || counts.left_out > 0);
    }
}

/// No triangle is turned, two at most are cut at one vertex, and what is above is as bad and as far as what is below.
pub(super) fn assert_sound(tree: &PointHierarchy) {
    let mut cut: BTreeMap<u32, Vec<TinTriangle>> = BTreeMap::new();
    let mut ids = BTreeSet::new();
    for triangle in all_triangles(tree) {
        let [a, b, c] = corners(tree, &triangle);
        assert!(turn(a, b, c).is_gt(), "{triangle:?} {a:?} {b:?} {c:?}");
        assert!(ids.insert(triangle.id));
        if triangle.split != NONE {
            assert!(triangle.split > triangle.apex.max(triangle.left).max(triangle.right));
            cut.entry(triangle.split).or_default().push(triangle);
        }
    }
    assert_eq!(cut.len(), tree.nodes.len() - 4);
    for (vertex, mut cut) in cut {
        cut.sort_by_key(|it| it.side);
        let node = &tree.nodes[vertex as usize];
        assert_eq!(usize::from(cut[0].side), 0);
        match cut[..] {
            [near, far] => assert!((near.left, near.right, 1) == (far.right, far.left, far.side)),
            _ => assert_eq!(cut.len(), 1),
        }
        for triangle in cut {
            let above = &tree.nodes[triangle.apex as usize];
            assert!(above.error >= node.error);
            let away = sub(widened(above.position), widened(node.position));
            let reach = dot(away, away).sqrt() + f64::from(node.radius);
            assert!(f64::from(above.radius) >= reach, "{vertex}");
        }
    }
}

/// Each side of a face is that of another one the other way round, or part of the rectangle's border.
pub(super) fn assert_no_cracks(tree: &PointHierarchy, faces: &[TinTriangle]) {
    let mut sides = BTreeSet::new();
    for face in faces {
        for side in [
            (face.apex, face.left),
            (face.left, face.right),
            (face.right, face.apex),
        ] {
            assert!(sides.insert(side), "{side:?} twice");
        }
    }
    let [north_west, _, _, south_east] = [0, 1, 2, 3].map(|it: usize| tree.nodes[it].position);
    for &(from, to) in &sides {
        if !sides.contains(&(to, from)) {
            let [a, b] = [from, to].map(|it| tree.nodes[it as usize].position);
            let is_at =
                |axis: usize, corner: [f32; 3]| a[axis] == corner[axis] && b[axis] == corner[axis];
            let is_border = [0, 2]
                .iter()
                .any(|&axis| is_at(axis, north_west) || is_at(axis, south_east));
            assert!(is_border, "{a:?} {b:?}");
        }
    }
}

/// In whole units.
fn whole(point: [f32; 3]) -> [i128; 3] {
    point.map(|x| {
        let units = f64::from(x) / UNIT;
        assert_eq!(units, units.round(), "{x} is not a multiple");
        #[expect(clippy::cast_possible_truncation, reason = "a whole number")]
        let units = units as i128;
        units
    })
}

/// How far a point is from a face above or below it, times the face's area; and the area. `None` if it is elsewhere.
fn distance(face: [[i128; 3]; 3], point: [i128; 3]) -> Option<[i128; 2]> {
    for axis in [0, 2] {
        let along = face.map(|it| it[axis]);
        let [low, high] = [along.iter().min()?, along.iter().max()?];
        if point[axis] < *low || point[axis] > *high {
            return None;
        }
    }
    let area = |a: [i128; 3], b: [i128; 3], c: [i128; 3]| {
        (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])
    };
    let [a, b, c] = face;
    let shares = [area(point, b, c), area(a, point, c), area(a, b, point)];
    if shares.iter().any(|&it| it < 0) {
        return None;
    }
    let whole: i128 = shares.iter().sum();
    let height: i128 = shares
        .iter()
        .zip(face)
        .map(|(it, corner)| it * corner[1])
        .sum();
    Some([(height - point[1] * whole).abs(), whole])
}

/// Every point is at most so far from every face above or below it, exactly; and there is one.
fn assert_close(tree: &PointHierarchy, faces: &[TinTriangle], points: &[[f32; 3]], limit: f32) {
    let limit = whole([limit.max(0.0), 0.0, 0.0])[0];
    let faces: Vec<_> = faces
        .iter()
        .map(|it| corners(tree, it).map(whole))
        .collect();
    let is_first: BTreeSet<u32> = tree.sources.iter().copied().collect();
    for (source, &point) in points.iter().enumerate() {
        if !is_first.contains(&index32(source)) {
            continue;
        }
        let point = whole(point);
        let mut is_covered = false;
        for &face in &faces {
            if let Some([product, area]) = distance(face, point) {
                is_covered = true;
                assert!(product <= limit * area, "{source} {point:?}");
            }
        }
        assert!(is_covered, "{source}");
    }
}

fn assert_covers_the_rectangle(tree: &PointHierarchy, faces: &[TinTriangle]) {
    let area = |face: &TinTriangle| {
        let face = corners(tree, face).map(whole);
        distance(face, face[0]).map_or(0, |it| it[1])
    };
    let [north_west, south_east] = [0, 3].map(|it: usize| whole(tree.nodes[it].position));
    let [width, depth] = [0, 2].map(|axis: usize| south_east[axis] - north_west[axis]);
    assert_eq!(faces.iter().map(area).sum::<i128>(), 2 * width * depth);
}

#[test]
fn surfaces_of_every_limit_are_whole_and_no_farther_from_any_point() {
    let mut random = SplitMix64(19);
    for round in 0..2 {
        for (name, make) in SETS {
            let points = make(600 - 250 * round, &mut random);
            let tree = over(&points);
            println!("{name}: {:?}", tree.counts);
            assert_eq!(tree.counts.left_out, 0, "{name}");
            assert_all_are_vertices(&tree, &points);
            assert_sound(&tree);
            let few = 1.0 / 8.0 + random.below(100) as f32;
            let mut last = usize::MAX;
            for limit in [-1.0, 0.0, 1.0 / 64.0, 0.5, 4.0, few, 200.0, 1e6] {
                let faces = drawn(&tree, limit);
                assert_no_cracks(&tree, &faces);
                assert_covers_the_rectangle(&tree, &faces);
                assert_close(&tree, &faces, &points, limit);
                assert!(limit == few || faces.len() <= last);
                last = faces.len();
            }
            assert_eq!(drawn(&tree, 1e6).len(), 2);
            let corners = |it: &TinTriangle| [it.apex, it.left, it.right];
            let vertices: BTreeSet<u32> = drawn(&tree, -1.0).iter().flat_map(corners).collect();
            assert_eq!(vertices.len(), tree.nodes.len());
        }
    }
}

/// The points in a triangle that are no vertices when it is cut; with those on its sides, or without.
fn points_below<'a>(
    tree: &'a PointHierarchy,
    triangle: &'a TinTriangle,
    with_sides: bool,
) -> impl Iterator<Item = ([i128; 3], f64)> + 'a {
    let face = corners(tree, triangle).map(whole);
    let later = (triangle.split as usize..tree.nodes.len()).filter(|&it| tree.sources[it] != NONE);
    later.filter_map(move |node| {
        let position = tree.nodes[node].position;
        let point = whole(position);
        let [product, area] = distance(face, point)?;
        let [a, b, c] = corners(tree, triangle);
        let is_inside = [(a, b), (b, c), (c, a)]
            .iter()
            .all(|it| turn(it.0, it.1, position).is_gt());
        (with_sides || is_inside).then(|| (point, product as f64 / area as f64 * UNIT))
    })
}

#[test]
fn errors_and_balls_are_those_of_the_points_below() {
    let mut random = SplitMix64(20);
    for (name, make) in SETS {
        let points = make(300, &mut random);
        let tree = over(&points);

        // The largest distances below each vertex, least and most: which triangle has a point of a side is left open.
        let mut bounds = vec![[0.0_f64; 2]; tree.nodes.len()];
        let triangles = all_triangles(&tree);
        for triangle in triangles.iter().filter(|it| it.split != NONE) {
            let bounds = &mut bounds[triangle.split as usize];
            let node = &tree.nodes[triangle.split as usize];
            for (bound, with_sides) in bounds.iter_mut().zip([false, true]) {
                let distances = points_below(&tree, triangle, with_sides).map(|it| it.1);
                *bound = distances.fold(*bound, f64::max);
            }
            for (point, _) in points_below(&tree, triangle, false) {
                let place = point.map(|x| x as f64 * UNIT);
                let away = sub(place, widened(node.position));
                assert!(f64::from(node.radius) >= dot(away, away).sqrt(), "{name}");
            }
        }
        let mut by_number = triangles.clone();
        by_number.retain(|it| it.split != NONE);
        by_number.sort_by_key(|it| std::cmp::Reverse(it.split));
        for triangle in by_number {
            let below = bounds[triangle.split as usize];
            let above = &mut bounds[triangle.apex as usize];
            *above = [0, 1].map(|i| above[i].max(below[i]));
        }
        for (node, [least, most]) in tree.nodes.iter().zip(bounds).skip(4) {
            let error = f64::from(node.error);
            assert!(error >= least, "{name}: {error} {least}");
            assert!(error <= most * (1.0 + 1e-6), "{name}: {error} {most}");
        }
    }
}

#[test]
fn a_grid_is_cut_at_the_middles_of_its_sides() {
    for levels in 1..6 {
        let side = (1 << levels) + 1;
        let tree = over(&point_sets::grid(side));
        assert_eq!(tree.nodes.len(), side * side);
        assert_eq!(
            (tree.counts.steiner, u32::from(tree.counts.depth)),
            (0, 2 * levels)
        );
        for triangle in all_triangles(&tree) {
            let [_, left, right] = corners(&tree, &triangle);
            if triangle.split != NONE {
                let [x, _, z] = tree.nodes[triangle.split as usize].position;
                assert_eq!([x, z], [0, 2].map(|axis| (left[axis] + right[axis]) / 2.0));
            }
        }
    }
}

/// `MESHWEFT_CASES=1000000 cargo test --release -p meshweft --lib -- --nocapture few_vertices_are_no_points` prints the ratios of
/// more points too.
///
/// Points are hardly ever exactly on the border, where a triangle can be cut at points of the border only: so there are vertices along it
/// that are no points, in proportion to the square root of the number of points.
#[test]
fn few_vertices_are_no_points_of_the_input() {
    let most = [0.1, 0.15, 0.2, 0.25, 2.0];
    let more = usize::try_from(from_environment("MESHWEFT_CASES", 0)).unwrap();
    let counts = [1000, 10_000, 40_000, 100_000, more];
    for ((name, make), most) in SETS.into_iter().zip(most) {
        for count in counts.into_iter().filter(|&it| it > 0) {
            for seed in [1, 5] {
                let points = make(count, &mut SplitMix64(seed));
                let tree = over(&points);
                let steiner = f64::from(tree.counts.steiner);
                let count = points.len() as f64;
                println!(
                    "{name}, {count} points: {:.3} Steiner points a point, depth {}",
                    steiner / count,
                    tree.counts.depth
                );
                assert!(steiner <= most * count + 16.0 * count.sqrt(), "{name}");
                assert!(count < 100_000.0 || steiner <= most * count, "{name}");
                assert!(tree.counts.left_out as usize <= points.len() / 1000);
            }
        }
    }
}

#[test]
fn what_has_no_area_is_said() {
    let error = |points: &[[f32; 3]]| PointHierarchy::over(points).unwrap_err();
    assert_eq!(error(&[]), PointsError::TooFew { places: 0 });
    let two = [
        [0.0; 3],
        [1.0, 0.0, 1.0],
        [-0.0, 5.0, 0.0],
        [f32::NAN, 0.0, 3.0],
    ];
    assert_eq!(error(&two), PointsError::TooFew { places: 2 });
    assert_eq!(error(&[[7.0; 3]; 100]), PointsError::TooFew { places: 1 });
    let line = |step: [f32; 3]| {
        (0..50)
            .map(|i| step.map(|x| x * i as f32))
            .collect::<Vec<_>>()
    };
    let far = 100_f32.exp2();
    for step in [
        [1.0, 2.0, 3.0],
        [0.0, 1.0, 1.0],
        [1e-30, 5.0, 0.0],
        [far, 0.0, -3.0 * far],
    ] {
        assert_eq!(error(&line(step)), PointsError::OnALine);
    }
}
