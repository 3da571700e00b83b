//! Hierarchies over points that are made to be difficult.

use std::ops::ControlFlow;

use super::point_sets::{self, MakePoints};
use super::point_tests::{assert_all_are_vertices, assert_no_cracks, assert_sound, drawn, over};
use super::points::PointHierarchy;
use crate::progress::Progress;
use crate::random::SplitMix64;

/// What holds of any points; how many were left out, and how deep the hierarchy is.
fn checked(points: &[[f32; 3]]) -> [u32; 2] {
    let tree = over(points);
    assert_all_are_vertices(&tree, points);
    assert_sound(&tree);
    let errors: Vec<f32> = tree.nodes.iter().map(|it| it.error).collect();
    let some = errors.iter().step_by(1 + errors.len() / 5).copied();
    for limit in some.chain([-1.0, 0.0, f32::MAX]) {
        assert_no_cracks(&tree, &drawn(&tree, limit));
    }
    [tree.counts.left_out, tree.counts.depth.into()]
}

#[test]
fn very_large_and_very_small_areas_are_cut_as_others_are() {
    // A power of two changes no sign, so the hierarchy is the same.
    let points = point_sets::scattered(2000, &mut SplitMix64(1));
    let moved: Vec<[f32; 3]> = points
        .iter()
        .map(|&[x, y, z]| [x - 6096.0, y, z - 6096.0])
        .collect();
    let usual = over(&moved);
    for exponent in [-100.0_f32, -60.0, 60.0, 100.0] {
        let scale = exponent.exp2();
        let points: Vec<[f32; 3]> = moved.iter().map(|it| it.map(|x| x * scale)).collect();
        let tree = over(&points);
        assert_eq!(tree.sources, usual.sources, "{exponent}");
        let children =
            |tree: &PointHierarchy| tree.nodes.iter().map(|it| it.children).collect::<Vec<_>>();
        assert_eq!(children(&tree), children(&usual));
        assert_eq!(checked(&points)[0], 0);
    }
}

#[test]
fn spirals_bursts_and_ladders_are_whole() {
    for (name, make) in point_sets::DIFFICULT_SETS {
        let points = make(500, &mut SplitMix64(2));
        let [left_out, depth] = checked(&points);
        println!(
            "{name}: {left_out} of {} left out, depth {depth}",
            points.len()
        );
    }
}

#[test]
fn one_point_inside_or_at_a_side_is_cut_at_once() {
    let square = [
        [0.0, 1.0, 0.0],
        [8.0, 1.0, 0.0],
        [0.0, 1.0, 8.0],
        [8.0, 1.0, 8.0],
    ];
    assert_eq!(over(&square).nodes.len(), 4);
    for (point, steiner) in [
        ([3.0, 5.0], 0),
        ([4.0, 4.0], 0),
        ([7.9, 0.1], 0),
        ([5.0, 0.0], 1),
    ] {
        let mut points = square.to_vec();
        points.push([point[0], 3.0, point[1]]);
        let tree = over(&points);
        assert_eq!(
            [tree.nodes.len(), tree.counts.steiner as usize],
            [5 + steiner, steiner],
            "{point:?}"
        );
        assert_eq!(checked(&points)[0], 0);
    }
    // Halves that become too narrow are avoided as long as there is room. That ends after this number of halvings, of the sides beside too.
    let mut points = square.to_vec();
    points.push([0.0, 3.0, 1e-30]);
    assert!(over(&points).counts.steiner < 80);
    assert_eq!(checked(&points)[0], 0);

    // Corners that are no points have the height of the nearest.
    let tree = over(&[[4.0, 5.0, 0.0], [0.0, 6.0, 9.0], [7.0, 8.0, 9.0]]);
    assert_eq!(tree.nodes[0].position, [0.0, 5.0, 0.0]);
    // With the middle of the rectangle, before a side can be cut.
    assert_eq!(tree.counts.steiner, 3);
}

#[test]
fn coordinates_with_few_digits_left_lose_few_points() {
    // Points ten metres apart, to the east in steps of 1/32 m, to the south in steps of 1/2 m; closer in clusters.
    let kinds: [(MakePoints, u32); 3] = [
        (point_sets::jittered, 0),
        (point_sets::scattered, 4),
        (point_sets::clusters, 200),
    ];
    for (make, most) in kinds {
        let mut points = make(10_000, &mut SplitMix64(4));
        for [x, _, z] in &mut points {
            *x = 500_000.0 + (*x - 4096.0) / 4.0;
            *z = 5_000_000.0 + (*z - 4096.0) / 4.0;
        }
        let [left_out, _] = checked(&points);
        println!("{left_out} left out");
        assert!(left_out <= most, "{left_out}");
    }
}

#[test]
fn what_is_not_finite_is_left_out_and_counted() {
    let mut points = point_sets::scattered(200, &mut SplitMix64(5));
    points[3][0] = f32::NAN;
    points[90][1] = f32::INFINITY;
    points[91][2] = f32::NEG_INFINITY;
    points[100] = [points[50][0], points[50][1] + 2.5, points[50][2]];
    let tree = over(&points);
    assert_all_are_vertices(&tree, &points);
    let counts = tree.counts;
    assert_eq!(
        [counts.not_finite, counts.duplicates, counts.disagreeing],
        [3, 1, 1]
    );
    assert!((counts.largest_disagreement - 2.5).abs() < 1e-3);
}

/// Stops after a number of reports.
#[derive(Debug)]
struct StopsAfter(std::sync::atomic::AtomicU32);

impl Progress for StopsAfter {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        assert!((0.0..=1.0).contains(&fraction));
        let rest = self.0.fetch_sub(1, std::sync::atomic::Ordering::Relaxed);
        if rest == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

#[test]
fn a_hierarchy_that_was_stopped_has_fewer_points_and_says_so() {
    let points = point_sets::scattered(3000, &mut SplitMix64(6));
    let mut last = u32::MAX;
    for reports in [0, 1, 5, 9] {
        let tree = PointHierarchy::over_with(&points, &StopsAfter(reports.into())).unwrap();
        assert_all_are_vertices(&tree, &points);
        assert_sound(&tree);
        assert_no_cracks(&tree, &drawn(&tree, -1.0));
        assert!(tree.counts.left_out < last && tree.counts.largest_left_out > 0.0);
        last = tree.counts.left_out;
    }
    assert!(last > 0);
}
