//! View-dependent detail of meshes at the edges of what there is, from cameras at the edges of what there is.

#[path = "data/placed_faces.rs"]
mod placed_faces;

use std::collections::BTreeSet;

use meshweft::Mesh;
use meshweft::lod::fast_mesh::{FastMesh, FrameBudget, Front, VertexHierarchy};
use meshweft::lod::geometry_cache::{EvictionPolicy, FrameMode, GeometryCache};
use meshweft::lod::{Camera, CameraView, ViewError};
use placed_faces::placed_faces;

const CAMERA: Camera = Camera {
    eye: [7.0, 9.0, 30.0],
    target: [10.0, 10.0, 0.0],
    up: [0.0, 1.0, 0.0],
    field_of_view: 45.0,
    size: [800, 600],
};

fn height(x: u32, y: u32) -> f32 {
    let [x, y] = [x, y].map(|it| it as f32);
    (0.7 * x).sin() + (0.9 * y).cos() + 0.3 * (2.1 * x + y).sin()
}

/// A square of bumpy cells, each cut in two.
fn hills(side: u32) -> Mesh {
    let row = side + 1;
    let places = (0..row * row).map(|it| [it % row, it / row]);
    let positions: Vec<_> = places
        .map(|[x, y]| [x as f32, y as f32, height(x, y)])
        .collect();
    let cell = |it: u32| {
        let a = it / side * row + it % side;
        [[a, a + 1, a + row], [a + row, a + 1, a + row + 1]]
    };
    let faces: Vec<_> = (0..side * side).flat_map(cell).collect();
    Mesh::new(positions, faces).unwrap()
}

fn with_positions(mesh: &Mesh, position: impl Fn(usize, [f32; 3]) -> [f32; 3]) -> Mesh {
    let positions = mesh.positions().iter().enumerate();
    let positions: Vec<_> = positions.map(|(at, &it)| position(at, it)).collect();
    Mesh::new(positions, mesh.faces().to_vec()).unwrap()
}

fn build(mesh: &Mesh) -> VertexHierarchy {
    FastMesh::default().build(mesh, &[]).unwrap()
}

/// Its faces are of active vertices, and as many as it says.
fn check(front: &Front) {
    let active: BTreeSet<u32> = front.vertices().collect();
    assert_eq!(active.len(), front.vertex_count());
    let mut numbers = BTreeSet::new();
    for (number, face) in front.faces() {
        assert!(numbers.insert(number), "face {number} twice");
        assert!(face.iter().all(|it| active.contains(it)), "{face:?}");
    }
    assert_eq!(numbers.len(), front.face_count());
}

/// From a few places it is a mesh, fully refined it is the input, and it is shallow. Returns how many faces are drawn at least and
/// at most.
fn check_all(name: &str, mesh: &Mesh, cameras: &[Camera]) -> [usize; 2] {
    let hierarchy = build(mesh);
    let most = 4.0 + 2.0 * (1.0 + mesh.vertex_count() as f64).log2();
    let depth = hierarchy.depth();
    assert!(depth as f64 <= most, "{name}: {depth} collapses deep");

    let flat: BTreeSet<u32> = hierarchy.flat_faces().iter().copied().collect();
    let mut front = Front::new(hierarchy);
    check(&front);
    let mut drawn = [front.face_count(); 2];
    for camera in cameras {
        let view = camera.view(1.0).unwrap();
        for view in [view, view.all_around(), view.with_back_faces()] {
            front.update(&view, 1.0);
            check(&front);
            drawn = [
                drawn[0].min(front.face_count()),
                drawn[1].max(front.face_count()),
            ];
            let (_, is_done) = front.update_within(&view, 1.0, FrameBudget::default());
            assert!(is_done, "{name}");
        }
    }

    front.refine_fully();
    check(&front);
    let sources = front.hierarchy().source_vertices();
    let of_input = |face: [u32; 3]| face.map(|vertex| sources[vertex as usize]);
    let found = placed_faces(mesh, front.faces().map(|(_, face)| of_input(face)));
    let kept = (0..)
        .zip(mesh.faces())
        .filter(|(number, _)| !flat.contains(number));
    assert!(
        found == placed_faces(mesh, kept.map(|(_, &face)| face)),
        "{name}: another mesh"
    );
    drawn
}

#[test]
fn cameras_without_a_picture_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut cameras = [CAMERA; 4];
            cameras[0].eye[axis] = bad;
            cameras[1].target[axis] = bad;
            cameras[2].up[axis] = bad;
            cameras[3].field_of_view = bad;
            for camera in cameras {
                assert_eq!(camera.view(1.0), Err(ViewError::NotFinite));
            }
            assert_eq!(CAMERA.view(bad), Err(ViewError::NotFinite));
        }
    }
    let at_target = Camera {
        target: CAMERA.eye,
        ..CAMERA
    };
    let up_ahead = Camera {
        up: [3.0, 1.0, -30.0],
        ..CAMERA
    };
    let no_up = Camera {
        up: [0.0; 3],
        ..CAMERA
    };
    for camera in [at_target, up_ahead, no_up] {
        assert_eq!(camera.view(1.0), Err(ViewError::NoDirection));
    }
}

#[test]
fn the_eye_may_be_anywhere() {
    let mesh = hills(40);
    let mut eyes: Vec<[f64; 3]> = vec![
        [20.0, 20.0, 0.0],
        [1e300; 3],
        [1e160, 0.0, 0.0],
        [1e-300; 3],
    ];
    // At vertices, and a hair beside them.
    for vertex in [0, 41 * 20 + 20, 41 * 41 - 1] {
        let eye = mesh.positions()[vertex].map(f64::from);
        eyes.push(eye);
        eyes.push(eye.map(f64::next_up));
    }
    let cameras: Vec<Camera> = eyes
        .iter()
        .map(|&eye| Camera {
            eye,
            target: eye.map(|x| x - 0.25 * x.abs() - 1.0),
            ..CAMERA
        })
        .collect();
    let [least, most] = check_all("hills", &mesh, &cameras);
    assert!(least * 10 < most, "{least} to {most} faces");

    // What is at the eye is as fine as it can be.
    let eye = mesh.positions()[41 * 20 + 20].map(f64::from);
    let camera = Camera {
        eye,
        target: [0.0, 0.0, 9.0],
        ..CAMERA
    };
    let mut front = Front::new(build(&mesh));
    front.update(&camera.view(1e6).unwrap().all_around(), 1.0);
    let sources = front.hierarchy().source_vertices();
    let mut active = front.vertices().map(|it| sources[it as usize]);
    assert!(active.any(|it| it == 41 * 20 + 20));
}

#[test]
fn small_and_flat_meshes() {
    let line = with_positions(&hills(30), |_, [x, _, _]| [x, 2.0 * x, 0.0]);
    let columns = with_positions(&hills(30), |at, _| [at as f32, 0.0, 0.0]);
    let one_place = with_positions(&hills(30), |_, _| [1.0; 3]);
    let plane = with_positions(&hills(30), |_, [x, y, _]| [x, y, 0.0]);
    let one = Mesh::new([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]).unwrap();
    let same = Mesh::new([[0.0; 3], [1.0; 3]], [[0, 1, 1], [0, 0, 0]]).unwrap();
    for (name, mesh) in [
        ("empty", Mesh::default()),
        ("no faces", Mesh::new([[0.0; 3]; 9], []).unwrap()),
        ("one face", one),
        ("faces of equal corners", same),
        ("a line", line),
        ("points on a line", columns),
        ("one place", one_place),
        ("a plane", plane),
    ] {
        check_all(name, &mesh, &[CAMERA]);
    }
}

#[test]
fn places_that_are_not_finite_stay() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mesh = with_positions(&hills(40), |at, position| match at % 171 {
            7 => [position[0], bad, position[2]],
            _ => position,
        });
        let count = mesh.positions().iter().filter(|it| !it[1].is_finite());
        let hierarchy = build(&mesh);
        let [points, roots] = hierarchy.point_counts();
        assert!(
            roots >= count.clone().count() && roots * 2 < points,
            "{roots} of {points} roots"
        );
        let front = Front::new(hierarchy);
        let sources = front.hierarchy().source_vertices();
        let coarse: BTreeSet<u32> = front.vertices().map(|it| sources[it as usize]).collect();
        for (vertex, position) in (0..).zip(mesh.positions()) {
            assert!(position[1].is_finite() || coarse.contains(&vertex));
        }
        check_all("not finite", &mesh, &[CAMERA]);
        let all = with_positions(&hills(9), |_, _| [bad; 3]);
        check_all("nowhere", &all, &[CAMERA]);
    }
}

#[test]
fn size_does_not_matter() {
    let mesh = hills(40);
    let mut fronts = vec![Front::new(build(&mesh))];
    let factors = [1.0, 2_f32.powi(100), 2_f32.powi(-100)];
    for &factor in &factors[1..] {
        let scaled = with_positions(&mesh, |_, position| position.map(|x| x * factor));
        fronts.push(Front::new(build(&scaled)));
    }
    for eye in [[20.0, 20.0, 60.0], [-3.0, 5.0, 2.0], [90.0, 400.0, 80.0]] {
        let mut faces = Vec::new();
        for (front, factor) in fronts.iter_mut().zip(factors.map(f64::from)) {
            let camera = Camera {
                eye: eye.map(|x: f64| x * factor),
                target: [20.0, 20.0, 0.0].map(|x: f64| x * factor),
                ..CAMERA
            };
            front.update(&camera.view(2.0).unwrap(), 1.0);
            check(front);
            faces.push(front.faces().collect::<BTreeSet<_>>());
        }
        assert!(faces[0].len() > 10 && faces.windows(2).all(|it| it[0] == it[1]));
    }
    for [name, factor] in [["huge", "3e38"], ["tiny", "1e-44"], ["large", "1e30"]] {
        let factor: f32 = factor.parse().unwrap();
        let mesh = with_positions(&mesh, |_, position| position.map(|x| x / 64.0 * factor));
        check_all(name, &mesh, &[CAMERA]);
    }
}

#[test]
fn faces_around_one_vertex() {
    let count = 100_000;
    let rim = |at: u32| {
        let angle = 1e-4 * at as f32;
        [angle.cos(), angle.sin(), 0.1 * (9.0 * angle).sin()]
    };
    let mut positions: Vec<[f32; 3]> = (0..count).map(rim).collect();
    positions.extend([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
    let open: Vec<[u32; 3]> = (1..count).map(|at| [count, at - 1, at]).collect();
    let mut closed: Vec<[u32; 3]> = (0..count).map(|at| [count, at, (at + 1) % count]).collect();
    for (name, has_both) in [("open fan", false), ("two cones", true)] {
        if has_both {
            closed.extend((0..count).map(|at| [count + 1, (at + 1) % count, at]));
        }
        let faces = if has_both {
            closed.clone()
        } else {
            open.clone()
        };
        let mesh = Mesh::new(positions.clone(), faces).unwrap();
        let far = Camera {
            eye: [0.0, 3.0, 4000.0],
            target: [0.0; 3],
            ..CAMERA
        };
        let [least, most] = check_all(name, &mesh, &[CAMERA, far]);
        assert!(least < most, "{name}: {least} to {most}");
    }
}

#[test]
fn many_parts() {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for part in 0..20_000_u32 {
        let first = 4 * part;
        let [x, y] = [part % 141, part / 141].map(|it| 2.0 * it as f32);
        let corners = [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-1.0, -1.0, 0.0],
        ];
        positions.extend(corners.map(|[a, b, c]: [f32; 3]| [x + a, y + b, c]));
        let tetrahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        faces.extend(tetrahedron.map(|face: [u32; 3]| face.map(|it| first + it)));
        if part % 3 == 0 {
            faces.truncate(faces.len() - 3);
        }
    }
    let mesh = Mesh::new(positions, faces).unwrap();
    check_all("parts", &mesh, &[CAMERA]);
}

#[test]
fn what_is_not_a_manifold() {
    let hills = hills(20);
    // Fins at edges, a second sheet that meets the first one at points, each face from both sides, each face twice.
    let mut positions = hills.positions().to_vec();
    let mut fins = hills.faces().to_vec();
    for edge in (0..400).step_by(7) {
        let [a, b, _] = hills.faces()[edge];
        let tip = u32::try_from(positions.len()).unwrap();
        positions.push([edge as f32 * 0.05, 3.0, 5.0]);
        fins.extend([[a, b, tip], [b, a, tip]]);
    }
    let fins = Mesh::new(positions, fins).unwrap();
    let mut sheets = hills.positions().to_vec();
    sheets.extend((0..).zip(hills.positions()).map(|(at, &[x, y, z])| {
        let lift = if at % 13 == 0 { 0.0 } else { 1.0 };
        [x, y, z + lift]
    }));
    let mut faces = hills.faces().to_vec();
    faces.extend(hills.faces().iter().map(|face| face.map(|it| it + 441)));
    let sheets = Mesh::new(sheets, faces).unwrap();
    let with = |other: fn(&[u32; 3]) -> [u32; 3]| {
        let mut faces = hills.faces().to_vec();
        faces.extend(hills.faces().iter().map(other));
        Mesh::new(hills.positions().to_vec(), faces).unwrap()
    };
    let two_sided = with(|&[a, b, c]| [a, c, b]);
    let twice = with(|&face| face);
    for (name, mesh) in [
        ("fins", fins),
        ("sheets", sheets),
        ("two-sided", two_sided),
        ("twice", twice),
    ] {
        check_all(name, &mesh, &[CAMERA]);
    }
}

fn walk(frames: u32) -> impl Iterator<Item = CameraView> {
    (0..frames).map(|frame| {
        let way = f64::from(frame * frame % 23);
        let camera = Camera {
            eye: [way, 20.0 - way, 3.0 + 3.0 * way],
            ..CAMERA
        };
        camera.view([0.3, 1.0, 3.0][frame as usize % 3]).unwrap()
    })
}

#[test]
fn budgets_from_nothing_to_everything() {
    let mesh = hills(30);
    let mut exact = Front::new(build(&mesh));
    let roots = exact.vertex_count();
    for vertices in [0, 1, roots, roots + 1, 100, usize::MAX] {
        for changes in [0, 1, 50, usize::MAX] {
            let budget = FrameBudget { vertices, changes };
            let mut front = Front::new(build(&mesh));
            for view in walk(12) {
                let (_, is_done) = front.update_within(&view, 1.0, budget);
                assert!(front.vertex_count() <= vertices.max(roots), "{budget:?}");
                assert!(is_done || changes < usize::MAX, "{budget:?}");
                check(&front);
                exact.update(&view, 1.0);
                if vertices == usize::MAX && is_done {
                    let [all, drawn] =
                        [&exact, &front].map(|it| it.faces().collect::<BTreeSet<_>>());
                    assert!(all == drawn, "{budget:?}");
                }
            }
            assert!(changes > 0 || front.vertex_count() == roots);
        }
    }
}

/// The vertex that a card has in each slot.
struct Card(Vec<Option<u32>>);

impl Card {
    fn write(&mut self, cache: &GeometryCache) {
        for insert in cache.upload().inserts() {
            self.0[insert.slot as usize] = Some(insert.vertex);
        }
    }
}

/// Every face is drawn once with its vertices, however few slots there are.
#[test]
fn few_slots_draw_a_front() {
    let hierarchy = build(&hills(16));
    let errors: Vec<f32> = (0..u32::try_from(hierarchy.vertex_count()).unwrap())
        .map(|vertex| hierarchy.error(vertex))
        .collect();
    for slots in [3, 4, 17, 90, 2000] {
        for has_passes in [false, true] {
            let cache =
                GeometryCache::new(slots, errors.clone(), EvictionPolicy::FinestFirst).unwrap();
            let mut cache = if has_passes {
                cache.with_passes()
            } else {
                cache
            };
            let mut front = Front::new(hierarchy.clone());
            let roots: Vec<u32> = front.vertices().collect();
            let mut card = Card(vec![None; slots]);
            let (mut added, mut removed) = (roots, Vec::new());
            let mut modes = BTreeSet::new();
            for view in walk(24) {
                let mode = cache.change(&added, &removed).unwrap().mode();
                modes.insert(format!("{mode:?}"));
                let faces: Vec<[u32; 3]> = front.faces().map(|(_, face)| face).collect();
                match mode {
                    FrameMode::Passes => draw_passes(&mut cache, &faces, &mut card),
                    FrameMode::Streamed => {
                        // An array of its own.
                        let mut stream = Card(vec![None; front.vertex_count()]);
                        stream.write(&cache);
                        assert!(draws(&cache, &faces, &stream));
                    }
                    _ => {
                        card.write(&cache);
                        assert!(draws(&cache, &faces, &card));
                    }
                }
                let changes = front.update(&view, 1.0);
                added.clone_from(&changes.added_vertices);
                removed.clone_from(&changes.removed_vertices);
            }
            let expected = match (slots, has_passes) {
                (2000, _) => "Cached",
                (_, true) => "Passes",
                (_, false) => "Streamed",
            };
            assert!(modes.contains(expected), "{slots}: {modes:?}");
        }
    }
}

fn draws(cache: &GeometryCache, faces: &[[u32; 3]], card: &Card) -> bool {
    let vertex_on_card = |vertex| card.0[cache.slot(vertex).unwrap() as usize];
    let mut corners = faces.as_flattened().iter();
    corners.all(|&vertex| vertex_on_card(vertex) == Some(vertex))
}

fn draw_passes(cache: &mut GeometryCache, faces: &[[u32; 3]], card: &mut Card) {
    let mut is_drawn = vec![false; faces.len()];
    let mut passes = cache.passes(faces).unwrap();
    while let Some(pass) = passes.next_pass() {
        assert_eq!(pass.upload().mode(), FrameMode::Passes);
        for insert in pass.upload().inserts() {
            card.0[insert.slot as usize] = Some(insert.vertex);
        }
        for (face, slots) in pass.faces().zip(pass.indices()) {
            assert!(!std::mem::replace(&mut is_drawn[face], true));
            assert_eq!(
                slots.map(|slot| card.0[slot as usize]),
                faces[face].map(Some)
            );
        }
    }
    assert!(is_drawn.into_iter().all(|it| it));
}
