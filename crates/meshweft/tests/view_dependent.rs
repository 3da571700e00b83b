//! View-dependent detail of real meshes: what every front has to be, after each frame of random walks.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/files.rs"]
mod files;
#[path = "data/placed.rs"]
mod placed;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use meshweft::Mesh;
use meshweft::geometry::Ball;
use meshweft::lod::fast_mesh::{Camera, CameraView, FastMesh, Front, VertexHierarchy};
use placed::open;

/// Meshes that are walked around: closed ones, some with borders, and one with points where it is not a manifold.
const MESHES: [&str; 10] = [
    "bunny_res2.ply.gz",
    "cow_poly.obj.gz",
    "dragon_res4.ply.gz",
    "eight.off.gz",
    "elephant_holes.off.gz",
    "fandisk.off.gz",
    "mannequin.off.gz",
    "rocker_arm.obj.gz",
    "spot.obj.gz",
    "trumpet.obj.gz",
];

/// Frames of a walk.
const FRAMES: usize = 12;

/// A long run by hand gives more walks for each mesh, and another seed.
fn from_environment(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().expect("a whole number"))
}

/// Numbers that look random, the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self) -> [f64; 3] {
        [(); 3].map(|()| 2.0 * self.next() - 1.0)
    }
}

fn view(random: &mut Random, ball: Ball, eye: [f64; 3]) -> CameraView {
    let [x, y, z] = random.vector();
    let camera = Camera {
        eye,
        target: [0, 1, 2].map(|axis| ball.center[axis] + 0.5 * ball.radius * [x, y, z][axis]),
        up: [0.01, 1.0, 0.02],
        field_of_view: 20.0 + 60.0 * random.next(),
        size: [800, 600],
    };
    let tolerance = 0.3 * 40.0_f64.powf(random.next());
    camera.view(tolerance).unwrap()
}

/// No half-edge twice, all corners at active vertices, and as many points, edges and faces, with signs, as at first.
fn check_surface(name: &str, front: &Front, points: &HashMap<[u32; 3], u32>, mesh: &Mesh) -> i64 {
    let active: BTreeSet<u32> = front.vertices().collect();
    assert_eq!(active.len(), front.vertex_count(), "{name}");
    let sources = front.hierarchy().source_vertices();
    let point = |vertex: u32| {
        let source = sources[vertex as usize] as usize;
        points[&mesh.positions()[source].map(|x| (x + 0.0).to_bits())]
    };
    let mut directed = BTreeSet::new();
    let (mut used, mut edges, mut faces) = (BTreeSet::new(), BTreeSet::new(), 0);
    let is_cut = front.hierarchy().cut_points() > 0;
    for (_, face) in front.faces() {
        faces += 1;
        assert!(
            face.iter().all(|vertex| active.contains(vertex)),
            "{name}: {face:?}"
        );
        let [a, b, c] = face.map(point);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            assert_ne!(from, to, "{name}: a face without an area");
            assert!(
                directed.insert([from, to]) || is_cut,
                "{name}: {from} to {to} twice"
            );
            edges.insert([from.min(to), from.max(to)]);
            used.insert(from);
        }
    }
    assert_eq!(faces, front.face_count() as i64, "{name}");
    used.len() as i64 - edges.len() as i64 + faces
}

fn points(mesh: &Mesh) -> HashMap<[u32; 3], u32> {
    let mut points = HashMap::new();
    for (vertex, position) in (0..).zip(mesh.positions()) {
        points
            .entry(position.map(|x| (x + 0.0).to_bits()))
            .or_insert(vertex);
    }
    points
}

fn all(front: &Front) -> BTreeMap<u32, [u32; 3]> {
    front.faces().collect()
}

fn walk(name: &str, mesh: &Mesh, hierarchy: &VertexHierarchy, random: &mut Random) {
    let ball = Ball::around(mesh.positions().iter().map(|p| p.map(f64::from))).unwrap();
    let points = points(mesh);
    let mut front = Front::new(hierarchy.clone());
    let character = check_surface(name, &front, &points, mesh);
    let mut drawn = all(&front);
    let mut at = random.vector();
    for frame in 0..FRAMES {
        let step = random.vector();
        at = [0, 1, 2].map(|axis| (at[axis] + 0.3 * step[axis]).clamp(-1.0, 1.0));
        let eye = [0, 1, 2].map(|axis| ball.center[axis] + 3.0 * ball.radius * at[axis]);
        let view = view(random, ball, eye);

        // What was drawn, changed by what the update says, is what is there.
        let changes = front.update(&view, 1.0);
        for face in &changes.removed_faces {
            assert!(drawn.remove(face).is_some(), "{name}");
        }
        let [added, changed] = [&changes.added_faces, &changes.changed_faces].map(Clone::clone);
        for face in added {
            assert!(
                drawn.insert(face, front.face(face).unwrap()).is_none(),
                "{name}"
            );
        }
        for face in changed {
            assert!(
                drawn.insert(face, front.face(face).unwrap()).is_some(),
                "{name}"
            );
        }
        assert!(drawn == all(&front), "{name}: frame {frame}");

        let found = check_surface(name, &front, &points, mesh);
        assert_eq!(found, character, "{name}: frame {frame}");
        let mut jumped = Front::new(hierarchy.clone());
        jumped.update(&view, 1.0);
        assert!(all(&jumped) == drawn, "{name}: frame {frame}");
    }
}

#[test]
fn fronts_are_surfaces_that_follow_from_the_view() {
    let Some(folder) = data::folder() else {
        return;
    };
    let walks = from_environment("MESHWEFT_CASES", 3);
    let mut random = Random(from_environment("MESHWEFT_SEED", 1));
    for name in MESHES {
        let mesh = open(&folder, name);
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        for _ in 0..walks {
            walk(name, &mesh, &hierarchy, &mut random);
        }
    }
    eprintln!(
        "{walks} walks of {FRAMES} frames around each of {} meshes",
        MESHES.len()
    );
}

/// Faces by the positions of their corners, each beginning with the least.
fn placed_faces(mesh: &Mesh, faces: impl Iterator<Item = [u32; 3]>) -> Vec<[[u32; 3]; 3]> {
    let bits = |vertex: u32| mesh.positions()[vertex as usize].map(|x| (x + 0.0).to_bits());
    let mut placed: Vec<_> = faces
        .map(|face| {
            let mut corners = face.map(bits);
            let first = (0..3).min_by_key(|&slot| corners[slot]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    placed.sort_unstable();
    placed
}

/// The large ones by hand, with `MESHWEFT_CASES`.
const MOST_FACES: usize = 40_000;

#[test]
fn every_mesh_comes_back_by_full_refinement() {
    let Some(folder) = data::folder() else {
        return;
    };
    let is_long = std::env::var_os("MESHWEFT_CASES").is_some();
    let (mut count, mut deepest, mut cut) = (0, (0.0, String::new()), 0);
    for path in files::mesh_files(&folder) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let mesh = open(&folder, &name);
        if mesh.face_count() > MOST_FACES && !is_long {
            continue;
        }
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        let depth = hierarchy.depth() as f64 / (hierarchy.vertex_count() as f64).log2();
        if depth > deepest.0 && hierarchy.vertex_count() > 100 {
            deepest = (depth, name.clone());
        }
        cut += usize::from(hierarchy.cut_points() > 0);
        let flat: BTreeSet<u32> = hierarchy.flat_faces().iter().copied().collect();
        let mut front = Front::new(hierarchy);
        front.refine_fully();

        let sources = front.hierarchy().source_vertices();
        let found = front
            .faces()
            .map(|(_, face)| face.map(|it| sources[it as usize]));
        let kept = (0..)
            .zip(mesh.faces())
            .filter(|(number, _)| !flat.contains(number));
        let expected = placed_faces(&mesh, kept.map(|(_, &face)| face));
        assert!(placed_faces(&mesh, found) == expected, "{name}");
        count += 1;
    }
    eprintln!(
        "{count} meshes, {cut} of them cut at some points; depth at most {:.2} log2 V ({})",
        deepest.0, deepest.1
    );
    assert!(count > 30, "{count} meshes");
    assert!(deepest.0 <= 1.5, "{deepest:?}");
}
