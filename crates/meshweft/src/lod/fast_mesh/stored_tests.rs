//! Hierarchies as bytes: what comes back, what is read of them, and what happens to damaged ones.

use std::io::Cursor;

use super::full_detail::FullDetail;
use super::tests::{camera, examples};
use super::{FastMesh, FrameBudget, Front, StreamedFront, VertexHierarchy};
use crate::geometry::Ball;
use crate::limits::Limits;
use crate::lod::Camera;
use crate::lod::HierarchyError;
use crate::mesh::Mesh;
use crate::random::{SplitMix64, from_environment};

fn faces(front: &Front) -> std::collections::BTreeMap<u32, [u32; 3]> {
    front.faces().collect()
}

/// The ball around all vertices that a face with three different places has.
fn ball_of_faces(mesh: &Mesh) -> Option<Ball> {
    let place = |&vertex: &u32| mesh.positions()[vertex as usize].map(f64::from);
    let is_flat = |face: &&[u32; 3]| {
        let [a, b, c] = [0, 1, 2].map(|corner| place(&face[corner]));
        a == b || b == c || c == a
    };
    let faces = mesh.faces().iter().filter(|face| !is_flat(face));
    let places: Vec<[f64; 3]> = faces.flatten().map(place).collect();
    Ball::around(places.into_iter())
}

#[test]
fn hierarchies_come_back() {
    let mut random = SplitMix64(1);
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let bytes = hierarchy.to_bytes();
        let back = VertexHierarchy::from_bytes(&bytes, Limits::default()).unwrap();
        assert!(back.to_bytes() == bytes, "{name}");
        assert_eq!(back.source_vertices(), hierarchy.source_vertices());
        assert_eq!(back.flat_faces(), hierarchy.flat_faces());
        assert_eq!(back.ball(), hierarchy.ball());
        assert_eq!(back.face_count(), hierarchy.face_count());

        let (mut one, mut other) = (Front::new(hierarchy), Front::new(back));
        for _ in 0..10 {
            let view = camera(&mut random, 25.0);
            assert_eq!(one.update(&view, 1.0), other.update(&view, 1.0), "{name}");
        }
        one.refine_fully();
        other.refine_fully();
        assert!(faces(&one) == faces(&other), "{name}");
        assert_eq!(one.face_count(), one.hierarchy().face_count());
        let found = one.hierarchy().ball().unwrap();
        let expected = ball_of_faces(&mesh).unwrap();
        // The order of the points decides how it is rounded.
        let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * expected.radius;
        assert!(is_near(found.radius, expected.radius), "{name}");
        let mut centers = found.center.into_iter().zip(expected.center);
        assert!(centers.all(|(a, b)| is_near(a, b)), "{name}");
    }
}

#[test]
fn what_is_read_when_it_is_needed_is_the_same() {
    let mut random = SplitMix64(2);
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let bytes = hierarchy.to_bytes();
        let mut whole = Front::new(hierarchy);
        let mut streamed = StreamedFront::open(Cursor::new(&bytes), Limits::default()).unwrap();
        for case in 0..20 {
            let view = camera(&mut random, 25.0);
            if case % 3 == 2 {
                let budget = FrameBudget {
                    vertices: 60 + random.below(200),
                    changes: 20 + random.below(200),
                };
                let is_done = whole.update_within(&view, 1.0, budget).1;
                let found = streamed.update_within(&view, 1.0, budget).unwrap();
                assert_eq!(found.1, is_done, "{name} {case}");
            } else {
                whole.update(&view, 1.0);
                streamed.update(&view, 1.0).unwrap();
            }
            assert!(faces(streamed.front()) == faces(&whole), "{name} {case}");
        }
        let [length, read] = streamed.bytes();
        assert_eq!(length, bytes.len() as u64);
        assert!(read <= length);
        streamed.refine_fully().unwrap();
        assert_eq!(streamed.bytes(), [length; 2], "{name}");
    }
}

#[test]
fn from_afar_little_is_read() {
    let (_, mesh, _) = examples().into_iter().find(|it| it.0 == "sphere").unwrap();
    let bytes = FastMesh::default().build(&mesh, &[]).unwrap().to_bytes();
    let mut streamed = StreamedFront::open(Cursor::new(&bytes), Limits::default()).unwrap();
    let camera = Camera {
        eye: [0.0, 0.0, 3000.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        field_of_view: 45.0,
        size: [800, 600],
    };
    streamed.update(&camera.view(1.0).unwrap(), 1.0).unwrap();
    let [length, read] = streamed.bytes();
    assert!(read * 2 < length, "{read} of {length}");
}

#[test]
fn an_empty_mesh_has_a_hierarchy() {
    for mesh in [
        Mesh::default(),
        Mesh::new([[0.0; 3]; 3], []).unwrap(),
        Mesh::new([[0.0; 3]; 3], [[0, 1, 2]]).unwrap(),
        Mesh::new([[0.0; 3], [1.0; 3], [2.0; 3]], [[0, 1, 2]]).unwrap(),
        Mesh::new([[f32::NAN; 3], [1.0; 3], [f32::INFINITY; 3]], [[0, 1, 2]]).unwrap(),
    ] {
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        let bytes = hierarchy.to_bytes();
        let back = VertexHierarchy::from_bytes(&bytes, Limits::default()).unwrap();
        assert!(back.to_bytes() == bytes);
        let mut front = Front::new(back);
        front.refine_fully();
        let flat = front.hierarchy().flat_faces().len();
        assert_eq!(front.face_count() + flat, mesh.face_count());
        assert_eq!(front.face_count(), front.hierarchy().face_count());
    }
    let hierarchy = FastMesh::default().build(&Mesh::default(), &[]).unwrap();
    assert_eq!(hierarchy.ball(), None);
    let back = VertexHierarchy::from_bytes(&hierarchy.to_bytes(), Limits::default()).unwrap();
    assert_eq!((back.ball(), back.face_count()), (None, 0));
}

#[test]
fn numbers_that_are_not_a_ball_are_refused() {
    let numbers = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(
        FullDetail::from_numbers(7, numbers).unwrap().ball_numbers(),
        numbers
    );
    for (place, number) in [(3, -2.0), (3, f64::NAN), (0, f64::INFINITY), (3, -1.0)] {
        let mut wrong = numbers;
        wrong[place] = number;
        assert_eq!(FullDetail::from_numbers(7, wrong), None);
    }
}

/// Bytes with the checksums that they should have: damage that no checksum finds.
fn resealed(bytes: &mut [u8]) {
    super::stored::reseal(bytes);
}

/// Files of the first faces of the examples, as a million small ones are read in minutes.
fn small_files() -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for (_, mesh, attributes) in examples() {
        for most_faces in [1, 30, 120, 800] {
            let faces: Vec<_> = mesh.faces().iter().copied().take(most_faces).collect();
            let part = Mesh::new(mesh.positions().to_vec(), faces).unwrap();
            let hierarchy = FastMesh::default().build(&part, &attributes).unwrap();
            let hierarchy = hierarchy.with_attributes(&attributes).unwrap();
            files.push(hierarchy.to_bytes());
        }
    }
    files
}

fn damaged(file: &[u8], random: &mut SplitMix64) -> Vec<u8> {
    let mut bytes = file.to_vec();
    match random.below(8) {
        0 => bytes.truncate(random.below(bytes.len() + 1)),
        1 => bytes.extend([0; 3]),
        // Numbers of the head.
        2 => bytes[random.below(90)] = u8::try_from(random.below(256)).unwrap(),
        _ => {
            for _ in 0..1 + random.below(4) {
                let at = random.below(bytes.len());
                bytes[at] = match random.below(3) {
                    0 => u8::try_from(random.below(256)).unwrap(),
                    1 => bytes[at] ^ 1 << random.below(8),
                    _ => bytes[random.below(bytes.len())],
                };
            }
        }
    }
    bytes
}

/// All that can be done with bytes that may be a hierarchy.
fn use_all(bytes: &[u8], random: &mut SplitMix64) -> Result<(), HierarchyError> {
    let mut front = StreamedFront::open(Cursor::new(bytes), Limits::default())?;
    let check = |front: &Front| {
        let vertices = front.hierarchy().vertex_count();
        let is_there = |face: [u32; 3]| face.iter().all(|&it| (it as usize) < vertices);
        assert!(front.faces().all(|(_, face)| is_there(face)));
        assert!(front.vertices().all(|it| (it as usize) < vertices));
    };
    front.update(&camera(random, 25.0), 1.0)?;
    check(front.front());
    let budget = FrameBudget {
        vertices: random.below(200),
        changes: random.below(300),
    };
    front.update_within(&camera(random, 25.0), 0.9, budget)?;
    check(front.front());
    front.update_within(&camera(random, 5.0), 1.0, FrameBudget::default())?;
    front.update(&camera(random, 25.0), 0.7)?;
    check(front.front());
    front.refine_fully()?;
    check(front.front());
    front.update(&camera(random, 400.0), 1.0)?;
    check(front.front());

    let whole = VertexHierarchy::from_bytes(bytes, Limits::default())?;
    let again = VertexHierarchy::from_bytes(&whole.to_bytes(), Limits::default())?;
    assert!(again.to_bytes() == whole.to_bytes());
    let _ = (whole.depth(), whole.point_counts());
    Ok(())
}

/// `MESHWEFT_CASES=1000000 cargo test --release -p meshweft --lib -- --nocapture damage_is_an_error_or_some_mesh` takes
/// minutes; `MESHWEFT_SEED` gives others.
#[test]
fn damage_is_an_error_or_some_mesh_and_never_a_panic() {
    let cases = from_environment("MESHWEFT_CASES", 2000);
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 3));
    let files = small_files();
    // Of bytes with wrong checksums, and of such with right ones.
    let (mut errors, mut meshes) = ([0; 2], [0; 2]);
    for case in 0..cases {
        let mut bytes = damaged(&files[random.below(files.len())], &mut random);
        let is_sealed = case % 4 != 0;
        if is_sealed {
            resealed(&mut bytes);
        }
        match use_all(&bytes, &mut random) {
            Ok(()) => meshes[usize::from(is_sealed)] += 1,
            Err(HierarchyError::Read(error)) => panic!("all was in memory: {error}"),
            Err(HierarchyError::Decode(_)) => errors[usize::from(is_sealed)] += 1,
        }
    }
    eprintln!(
        "{cases} files; with wrong and right checksums: {errors:?} errors, {meshes:?} meshes"
    );
    assert!(errors[0] > cases / 8 && errors[1] > cases / 8, "{errors:?}");
    assert!(meshes[1] > cases / 8, "{meshes:?}");
}
