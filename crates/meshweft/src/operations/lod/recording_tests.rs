//! A recorded walk is drawn as the walk itself is, and fits into the slots.

use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

use super::options::{LodError, LodWalkOptions};
use super::paths::CameraPath;
use super::recording::WalkRecorder;
use super::walk::lod_walk;
use crate::files::{Document, Format, ReadOptions};
use crate::lod::geometry_cache::{EvictionPolicy, GeometryCache, IndexSlots};
use crate::operations::walks::WalkFrame;
use crate::progress::Progress;

/// Waves over a square of 40 by 40 cells.
fn waves() -> Document {
    let side = 40;
    let mut text = String::new();
    for i in 0..(side + 1) * (side + 1) {
        let [x, y] = [i % (side + 1), i / (side + 1)].map(|at| f64::from(at) / 4.0);
        writeln!(text, "v {x} {} {y}", (2.1 * x).sin() * (1.7 * y).cos()).unwrap();
    }
    for i in 0..side * side {
        let corner = 1 + i / side * (side + 1) + i % side;
        let above = corner + side + 1;
        writeln!(text, "f {corner} {above} {}", corner + 1).unwrap();
        writeln!(text, "f {} {above} {}", corner + 1, above + 1).unwrap();
    }
    let name = Path::new("waves.obj");
    Document::from_bytes(text.into(), Format::Obj, name, ReadOptions::default()).unwrap()
}

fn options(path: CameraPath, slots: usize) -> LodWalkOptions {
    LodWalkOptions {
        path,
        slots,
        frames: Some(60),
        tolerance: 3.0,
        optimum: true,
        ..LodWalkOptions::default()
    }
}

#[test]
fn every_policy_is_drawn_as_on_the_walk_itself() {
    let document = waves();
    let recorder = WalkRecorder::new(&document, &|| 0.0).unwrap();
    for path in CameraPath::SHAPES {
        let most = lod_walk(&document, &options(path.clone(), 65_536), &|| 0.0, &()).unwrap();
        let most = most
            .frames
            .iter()
            .map(|frame| frame.vertices)
            .max()
            .unwrap();
        for slots in [most, 65_536] {
            let options = options(path.clone(), slots);
            let walk = recorder.record(&options, &|| 0.0, &()).unwrap();
            assert_eq!(walk.limited_frames(), 0);
            for policy in EvictionPolicy::ALL {
                let options = LodWalkOptions {
                    policy,
                    ..options.clone()
                };
                let expected = lod_walk(&document, &options, &|| 0.0, &()).unwrap();
                let replayed = walk.replay(policy, &|| 0.0).unwrap();
                let inserts = |frame: &WalkFrame| (frame.inserts, frame.vertex_bytes);
                assert!(
                    replayed
                        .frames
                        .iter()
                        .map(inserts)
                        .eq(expected.frames.iter().map(inserts))
                );
                assert_eq!(replayed.optimum, expected.optimum);
                assert_eq!(replayed.mesh, expected.mesh);
                assert_eq!(replayed.options, expected.options);
                // Faces are the same, but may be listed in another order, and so be in other places.
                for (ours, walked) in replayed.frames.iter().zip(&expected.frames) {
                    let counts = |it: &WalkFrame| (it.vertices, it.faces, it.added, it.removed);
                    assert_eq!(counts(ours), counts(walked));
                }
            }
        }
    }
}

#[test]
fn what_does_not_fit_is_the_best_mesh_that_does() {
    let recorder = WalkRecorder::new(&waves(), &|| 0.0).unwrap();
    for path in CameraPath::SHAPES {
        let usual = recorder.record(&options(path.clone(), 65_536), &|| 0.0, &());
        let most = usual.unwrap().path().most_active();
        let slots = most / 2;
        let options = options(path, slots);
        let walk = recorder.record(&options, &|| 0.0, &()).unwrap();
        assert!(walk.limited_frames() > 0);
        assert!(walk.path().most_active() <= slots);
        for policy in EvictionPolicy::ALL {
            let (mut active, mut frames) = (recorder.mesh().roots, 0);
            let mut draw = |cache: &GeometryCache, indices: &IndexSlots, row: WalkFrame| {
                active = active + row.added - row.removed;
                assert_eq!(row.vertices, active);
                assert!(row.vertices <= slots);
                assert_eq!(row.is_streamed, policy == EvictionPolicy::Nothing);
                assert!(indices.is_true_to(cache));
                let is_face = |&&[a, b, _]: &&[u32; 3]| a != b;
                assert_eq!(indices.corners().iter().filter(is_face).count(), row.faces);
                frames += 1;
            };
            walk.draw(policy, &|| 0.0, &mut draw).unwrap();
            assert_eq!(frames, 60);
        }
    }
}

#[test]
fn a_recording_can_be_stopped_and_refuses_what_a_walk_does() {
    let recorder = WalkRecorder::new(&waves(), &|| 0.0).unwrap();
    let usual = options(CameraPath::Circle, 65_536);
    let wrong = LodWalkOptions {
        slots: 2,
        ..usual.clone()
    };
    let refused = recorder.record(&wrong, &|| 0.0, &());
    assert!(matches!(refused, Err(LodError::Option(_))));

    struct Stop;
    impl Progress for Stop {
        fn report(&self, fraction: f64) -> ControlFlow<()> {
            match fraction < 0.5 {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        }
    }
    let stopped = recorder.record(&usual, &|| 0.0, &Stop).unwrap();
    let report = stopped
        .replay(EvictionPolicy::OldestFirst, &|| 0.0)
        .unwrap();
    assert_eq!((report.frames.len(), report.is_stopped), (30, true));
}
