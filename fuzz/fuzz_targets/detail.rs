//! Any bytes as a mesh that follows a camera: its faces are of active vertices, what changes is said, a budget is kept, few
//! slots are enough, full refinement is the mesh, and its file gives the same.
//!
//! Byte 0: vertex count less one. Byte 1: bit 0 leaves the positions to the bytes, else they are a bent grid of
//! eight columns. Byte 2 and 3: a budget. Then three bytes a vertex, if so, and three a face.
#![no_main]

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use meshweft::lod::fast_mesh::{FastMesh, FrameBudget, Front, StreamedFront};
use meshweft::lod::geometry_cache::{EvictionPolicy, FrameMode, GeometryCache};
use meshweft::lod::{Camera, CameraView};
use meshweft::{Limits, Mesh};

fuzz_target!(|data: &[u8]| {
    let Some((&[count, flags, vertices, changes], rest)) = data.split_first_chunk::<4>() else {
        return;
    };
    let mesh = mesh(rest, usize::from(count) + 1, flags & 1 != 0);
    let budget = FrameBudget {
        vertices: vertices.into(),
        changes: changes.into(),
    };
    let hierarchy = FastMesh::default()
        .build(&mesh, &[])
        .expect("any mesh will do");
    let bytes = hierarchy.to_bytes();
    let mut streamed = StreamedFront::open(Cursor::new(&bytes), Limits::default())
        .expect("what is written can be read");
    let mut front = Front::new(hierarchy);
    let roots = front.vertex_count();
    let mut drawn: BTreeMap<u32, [u32; 3]> = front.faces().collect();

    for view in views() {
        front.update(&view, 1.0);
        follow(&front, &mut drawn);
        streamed.update(&view, 1.0).expect("the bytes are whole");
        assert!(streamed.front().faces().collect::<BTreeMap<_, _>>() == drawn);
        draw_with_few_slots(&front);

        let is_done = front.update_within(&view, 1.0, budget).1;
        follow(&front, &mut drawn);
        assert!(!is_done || front.vertex_count() <= budget.vertices.max(roots));
    }
    front.refine_fully();
    follow(&front, &mut drawn);
    let sources = front.hierarchy().source_vertices();
    let of_input = |face: [u32; 3]| face.map(|vertex| sources[vertex as usize]);
    let found = drawn.values().map(|&face| of_input(face));
    let flat = front.hierarchy().flat_faces();
    let kept = (0..)
        .zip(mesh.faces())
        .filter(|(number, _)| !flat.contains(number));
    assert!(placed(&mesh, found) == placed(&mesh, kept.map(|(_, &face)| face)));
});

fn mesh(bytes: &[u8], count: usize, has_positions: bool) -> Mesh {
    let (places, corners) = bytes.split_at(match has_positions {
        true => bytes.len().min(3 * count),
        false => 0,
    });
    let number = |byte: u8| match byte {
        255 => f32::NAN,
        254 => f32::INFINITY,
        253 => 1e30,
        252 => -1e-30,
        byte => f32::from(byte) / 16.0,
    };
    let mut positions: Vec<[f32; 3]> = places
        .chunks_exact(3)
        .map(|xyz| [xyz[0], xyz[1], xyz[2]].map(number))
        .collect();
    for vertex in positions.len()..count {
        let (x, y) = ((vertex % 8) as f32, (vertex / 8) as f32);
        positions.push([x, y, (0.7 * x).sin() + (0.9 * y).cos()]);
    }
    let faces: Vec<[u32; 3]> = corners
        .chunks_exact(3)
        .map(|face| [face[0], face[1], face[2]].map(|it| u32::from(it) % count as u32))
        .collect();
    Mesh::new(positions, faces).expect("indices are in range")
}

fn views() -> Vec<CameraView> {
    let view = |eye, tolerance| {
        let camera = Camera {
            eye,
            target: [4.0, 4.0, 0.5],
            up: [0.0, 1.0, 0.0],
            field_of_view: 60.0,
            size: [800, 600],
        };
        camera.view(tolerance).expect("it looks at something")
    };
    vec![
        view([4.0, 4.0, 20.0], 1.0),
        view([4.0, 5.0, 400.0], 20.0),
        view([1.0, 2.0, 1.0], 0.1).all_around(),
        view([-9.0, 3.0, 2.0], 5.0).with_back_faces(),
    ]
}

/// What was drawn, changed by what the update says, is what is there, and of active vertices.
fn follow(front: &Front, drawn: &mut BTreeMap<u32, [u32; 3]>) {
    let changes = front.changes();
    for face in &changes.removed_faces {
        drawn.remove(face).expect("it was there");
    }
    for &face in &changes.added_faces {
        let is_new = drawn.insert(face, front.face(face).expect("it is there"));
        assert!(is_new.is_none());
    }
    for &face in &changes.changed_faces {
        let before = drawn.insert(face, front.face(face).expect("it is there"));
        before.expect("it was there");
    }
    let now: BTreeMap<u32, [u32; 3]> = front.faces().collect();
    assert!(now == *drawn);
    assert_eq!(now.len(), front.face_count());
    let active: BTreeSet<u32> = front.vertices().collect();
    assert_eq!(active.len(), front.vertex_count());
    assert!(now.values().flatten().all(|vertex| active.contains(vertex)));
}

/// Three slots draw every face once.
fn draw_with_few_slots(front: &Front) {
    let errors = vec![1.0; front.hierarchy().vertex_count()];
    let cache =
        GeometryCache::new(3, errors, EvictionPolicy::FinestFirst).expect("three are enough");
    let mut cache = cache.with_passes();
    let active: Vec<u32> = front.vertices().collect();
    let upload = cache.set_active(&active).expect("vertices that exist");
    assert_eq!(upload.mode() == FrameMode::Passes, active.len() > 3);
    let faces: Vec<[u32; 3]> = front.faces().map(|(_, face)| face).collect();
    let mut left: Vec<bool> = vec![true; faces.len()];
    let mut passes = cache.passes(&faces).expect("vertices that exist");
    while let Some(pass) = passes.next_pass() {
        for face in pass.faces() {
            assert!(std::mem::replace(&mut left[face], false));
        }
    }
    assert!(!left.contains(&true));
}

/// Faces by the bits of their corners' positions, each beginning with the least.
fn placed(mesh: &Mesh, faces: impl Iterator<Item = [u32; 3]>) -> Vec<[[u32; 3]; 3]> {
    let mut placed: Vec<_> = faces
        .map(|face| {
            let bits = |vertex: u32| mesh.positions()[vertex as usize].map(|x| (x + 0.0).to_bits());
            let mut corners = face.map(bits);
            let first = (0..3).min_by_key(|&slot| corners[slot]).unwrap_or(0);
            corners.rotate_left(first);
            corners
        })
        .collect();
    placed.sort_unstable();
    placed
}
