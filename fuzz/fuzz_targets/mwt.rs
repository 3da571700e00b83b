//! Any bytes as a terrain, whatever their checksums: no panic, no face of a vertex that does not exist, memory in proportion to
//! the bytes and the faces that are drawn, and what was read is written and read again.
#![no_main]

use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use meshweft::Limits;
use meshweft::lod::quad_tin::{QuadTin, StreamedTin, TinLimit, TinSurface};
use meshweft::lod::{Camera, CameraView, HierarchyError};

#[path = "../../compare/src/counting.rs"]
mod counting;

#[global_allocator]
static ALLOCATOR: counting::Counting = counting::Counting;

fuzz_target!(|data: &[u8]| {
    let (_, peak) = counting::with_peak(|| draw(data));
    assert!(
        peak < (1 << 20) + 64 * data.len(),
        "{peak} bytes for {}",
        data.len()
    );
    if let Ok(whole) = read(data) {
        let mut bytes = Vec::new();
        whole.write("", &mut bytes).expect("memory can be written");
        let mut again = Vec::new();
        let whole = read(&bytes).expect("what is written can be read");
        whole.write("", &mut again).expect("memory can be written");
        assert!(again == bytes);
    }
});

fn read(data: &[u8]) -> Result<QuadTin, HierarchyError> {
    StreamedTin::open(Cursor::new(data), Limits::default())?.into_tin()
}

fn draw(data: &[u8]) -> Result<(), HierarchyError> {
    let mut terrain = StreamedTin::open(Cursor::new(data), Limits::default())?;
    let mut surface = TinSurface::default();
    for view in views() {
        terrain.draw_within(TinLimit::Vertices(50), &view, &mut surface)?;
        terrain.draw(&view, &mut surface)?;
        let count = terrain.tin().vertex_count();
        let corners = || surface.faces().iter().flat_map(|it| it.1);
        assert!(corners().all(|it| (it as usize) < count));
        assert!(corners().all(|it| terrain.tin().position(it).iter().all(|x| x.is_finite())));
        assert!(surface.strip().len() >= surface.faces().len());
    }
    Ok(())
}

fn views() -> Vec<CameraView> {
    let camera = |eye: [f64; 3]| Camera {
        eye,
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        field_of_view: 60.0,
        size: [200, 100],
    };
    let seen = [[40.0, 30.0, 20.0], [1e-9, 0.0, 0.0]].map(|eye| camera(eye).view(1.0));
    let all = [
        CameraView::of_errors_above(1.0),
        CameraView::of_errors_above(-1.0),
    ];
    seen.into_iter()
        .chain(all)
        .map(|it| it.expect("the camera has a view"))
        .collect()
}
