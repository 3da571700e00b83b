//! Meshes without an eye: what has an error above a length, and the best mesh of some vertices, against all nodes.

use std::collections::BTreeSet;
use std::io::Cursor;

use super::tests::examples;
use super::{FastMesh, FrameBudget, Front, StreamedFront, VertexHierarchy};
use crate::limits::Limits;
use crate::lod::{CameraView, ViewError};

/// The points whose errors are above a length, and those that these need.
fn closure(hierarchy: &VertexHierarchy, length: f64) -> BTreeSet<u32> {
    let is_above = |&point: &u32| f64::from(hierarchy.nodes[point as usize].error) > length;
    let mut stack: Vec<u32> = hierarchy.leaving_points().filter(is_above).collect();
    let mut found = BTreeSet::new();
    while let Some(point) = stack.pop() {
        if found.insert(point) {
            stack.extend(hierarchy.needed_by(point));
        }
    }
    found
}

/// Those that may leave.
fn active(front: &Front) -> BTreeSet<u32> {
    let points = front.hierarchy().leaving_points();
    points.filter(|&point| front.is_active(point)).collect()
}

fn largest_left(hierarchy: &VertexHierarchy, active: &BTreeSet<u32>) -> f32 {
    let left = hierarchy.leaving_points().filter(|it| !active.contains(it));
    let errors = left.map(|point| hierarchy.nodes[point as usize].error);
    errors.fold(0.0, f32::max)
}

#[test]
fn errors_above_a_length_are_refined_everywhere() {
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let bytes = hierarchy.to_bytes();
        let mut errors: Vec<f32> = hierarchy
            .leaving_points()
            .map(|point| hierarchy.nodes[point as usize].error)
            .collect();
        errors.sort_by(f32::total_cmp);
        let part = |part: usize| f64::from(errors[(errors.len() - 1) * part / 8]);
        // An error itself may stay.
        let lengths = [part(8), part(3), 0.0, -1.0, part(7), 0.99 * part(5), 1e30];
        let mut walked = Front::new(hierarchy.clone());
        for length in lengths {
            let expected = closure(&hierarchy, length);
            let view = CameraView::of_errors_above(length).unwrap();
            walked.update(&view, 1.0);
            assert_eq!(active(&walked), expected, "{name} {length}");
            let left = largest_left(&hierarchy, &expected);
            assert_eq!(walked.largest_error_left(), left, "{name} {length}");
            assert!(f64::from(left) <= length.max(0.0));

            let mut streamed = StreamedFront::open(Cursor::new(&bytes), Limits::default()).unwrap();
            streamed.update(&view, 1.0).unwrap();
            assert_eq!(active(streamed.front()), expected, "{name} {length}");
            assert_eq!(
                streamed.front().largest_error_left(),
                left,
                "{name} {length}"
            );
        }
        // With hysteresis a point stays until its error is a part of the length.
        let fine = closure(&hierarchy, 0.5 * part(6));
        walked.update(&CameraView::of_errors_above(0.5 * part(6)).unwrap(), 1.0);
        let coarse = CameraView::of_errors_above(part(6)).unwrap();
        walked.update(&coarse, 0.5);
        assert_eq!(active(&walked), fine, "{name}");
    }
}

#[test]
fn the_largest_errors_come_first() {
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let bytes = hierarchy.to_bytes();
        let count = |points: &BTreeSet<u32>| {
            let all = (0..hierarchy.roots).chain(points.iter().copied());
            all.map(|point| hierarchy.vertices_of(point).count())
                .sum::<usize>()
        };
        let least = count(&BTreeSet::new());
        let most = hierarchy.vertex_count();
        let mut errors: Vec<f32> = hierarchy
            .leaving_points()
            .map(|point| hierarchy.nodes[point as usize].error)
            .collect();
        errors.sort_by(|a, b| b.total_cmp(a));
        for asked in [
            least,
            least + 1,
            least + 10,
            (least + most) / 3,
            most - 1,
            most,
            usize::MAX,
        ] {
            let view = CameraView::of_errors_above(-1.0).unwrap();
            let budget = FrameBudget {
                vertices: asked,
                ..FrameBudget::default()
            };
            let mut front = StreamedFront::open(Cursor::new(&bytes), Limits::default()).unwrap();
            front.update_within(&view, 1.0, budget).unwrap();
            let found = active(front.front());
            assert_eq!(count(&found), front.front().vertex_count());
            assert!(count(&found) <= asked, "{name} {asked}");

            // All of the largest errors that fit together are there.
            let closures = errors.iter().step_by(7);
            let closures = closures.map(|&error| closure(&hierarchy, error.into()));
            let fitting = closures.take_while(|points| count(points) <= asked);
            let fitting = fitting.last().unwrap_or_default();
            assert!(found.is_superset(&fitting), "{name} {asked}");
            if asked >= most {
                assert_eq!(count(&found), most);
            }
        }
    }
}

#[test]
fn a_length_is_a_number() {
    for length in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let view = CameraView::of_errors_above(length);
        assert_eq!(view.unwrap_err(), ViewError::NotFinite);
    }
}
