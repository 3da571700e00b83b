//! Any bytes as a vertex hierarchy, whatever their checksums: no panic, no face of a vertex that does not exist, memory
//! in proportion to the bytes, and what was read is written and read again.
#![no_main]

use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use meshweft::Limits;
use meshweft::lod::HierarchyError;
use meshweft::lod::fast_mesh::{FrameBudget, Front, StreamedFront, VertexHierarchy};
use meshweft::lod::{Camera, CameraView};

#[path = "../../compare/src/counting.rs"]
mod counting;

#[global_allocator]
static ALLOCATOR: counting::Counting = counting::Counting;

fuzz_target!(|data: &[u8]| {
    let (_, peak) = counting::with_peak(|| walk(data));
    assert!(
        peak < (1 << 20) + 64 * data.len(),
        "{peak} bytes for {}",
        data.len()
    );
    let (whole, peak) =
        counting::with_peak(|| VertexHierarchy::from_bytes(data, Limits::default()));
    assert!(
        peak < (1 << 20) + 64 * data.len(),
        "{peak} bytes for {}",
        data.len()
    );
    if let Ok(whole) = whole {
        let bytes = whole.to_bytes();
        let again = VertexHierarchy::from_bytes(&bytes, Limits::default());
        assert!(again.expect("what is written can be read").to_bytes() == bytes);
        assert!(whole.depth() <= whole.point_counts()[0]);
    }
});

fn walk(data: &[u8]) -> Result<(), HierarchyError> {
    let mut front = StreamedFront::open(Cursor::new(data), Limits::default())?;
    check(front.front());
    for (frame, view) in views().into_iter().enumerate() {
        front.update(&view, if frame % 2 == 0 { 1.0 } else { 0.5 })?;
        check(front.front());
        for vertices in [0, 100, usize::MAX] {
            let changes = 1000;
            front.update_within(&view, 1.0, FrameBudget { vertices, changes })?;
            check(front.front());
        }
    }
    front.refine_fully()?;
    check(front.front());
    for view in views() {
        front.update(&view, 1.0)?;
    }
    check(front.front());
    Ok(())
}

/// Close, far, inside, and all around.
fn views() -> Vec<CameraView> {
    let view = |eye, tolerance| {
        let camera = Camera {
            eye,
            target: [0.5, 0.25, 0.0],
            up: [0.0, 1.0, 0.125],
            field_of_view: 45.0,
            size: [800, 600],
        };
        camera.view(tolerance).expect("it looks at something")
    };
    vec![
        view([3.0, 2.0, 5.0], 4.0),
        view([0.0, 0.0, 0.0], 0.01).all_around(),
        view([1e6, 1.0, -1e6], 1.0),
        view([0.5, 0.25, 1e-9], 1.0).with_back_faces(),
        view([-40.0, 9.0, 3.0], 0.1),
    ]
}

fn check(front: &Front) {
    let vertices = front.hierarchy().vertex_count();
    let is_there = |vertex: u32| (vertex as usize) < vertices;
    assert!(
        front
            .faces()
            .all(|(_, face)| face.into_iter().all(is_there))
    );
    assert!(front.vertices().all(is_there));
}
