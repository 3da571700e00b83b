//! View-dependent detail of real meshes: what every front has to be, after each frame of random walks.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod data;
#[path = "data/files.rs"]
mod files;
#[path = "data/placed.rs"]
mod placed;
#[path = "data/placed_faces.rs"]
mod placed_faces;

use std::collections::{BTreeSet, HashMap};

use meshweft::files::Document;
use meshweft::geometry::Ball;
use meshweft::lod::fast_mesh::{FastMesh, FrameBudget, Front, VertexHierarchy};
use meshweft::lod::{Camera, CameraView};
use meshweft::operations::{CameraPath, LodVerifyOptions, lod_verify};
use meshweft::{Limits, Mesh};
use placed::open;
use placed_faces::placed_faces;

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

/// What a front has to be, looked for in each frame from nothing; memory is kept from frame to frame.
struct Surface {
    name: &'static str,
    /// The point of each vertex of the hierarchy.
    points: Vec<u32>,
    is_cut: bool,
    is_active: Vec<bool>,
    /// The edges of all faces: the lower point, the higher one, and which way.
    edges: Vec<(u32, u32, bool)>,
    is_used: Vec<bool>,
    /// Where the border goes on from a point.
    follower: Vec<u32>,
}

/// Points less edges plus faces, and how many closed lines the border has: the same at every level of detail.
type Character = (i64, usize);

impl Surface {
    fn new(name: &'static str, mesh: &Mesh, hierarchy: &VertexHierarchy) -> Self {
        let mut known = HashMap::new();
        let sources = hierarchy.source_vertices().iter();
        let points = sources.map(|&vertex| {
            let bits = mesh.positions()[vertex as usize].map(|x| (x + 0.0).to_bits());
            let next = u32::try_from(known.len()).unwrap();
            *known.entry(bits).or_insert(next)
        });
        let points: Vec<u32> = points.collect();
        let count = points.len();
        Self {
            name,
            is_cut: hierarchy.cut_points() > 0,
            is_active: vec![false; count],
            edges: Vec::new(),
            is_used: vec![false; count],
            follower: vec![NONE; count],
            points,
        }
    }

    /// No half-edge twice, all corners at active vertices, no face without an area.
    fn check(&mut self, front: &Front) -> Character {
        let name = self.name;
        self.is_active.fill(false);
        let mut active = 0;
        for vertex in front.vertices() {
            let is_twice = std::mem::replace(&mut self.is_active[vertex as usize], true);
            assert!(!is_twice, "{name}");
            active += 1;
        }
        assert_eq!(active, front.vertex_count(), "{name}");

        self.edges.clear();
        self.is_used.fill(false);
        let (mut used, mut faces) = (0, 0);
        for (_, face) in front.faces() {
            faces += 1;
            let is_active = |&vertex: &u32| self.is_active[vertex as usize];
            assert!(face.iter().all(is_active), "{name}: {face:?}");
            let [a, b, c] = face.map(|vertex| self.points[vertex as usize]);
            assert!(a != b && b != c && c != a, "{name}: a face without an area");
            for [from, to] in [[a, b], [b, c], [c, a]] {
                self.edges.push((from.min(to), from.max(to), from < to));
                used += i64::from(!std::mem::replace(&mut self.is_used[from as usize], true));
            }
        }
        assert_eq!(faces, front.face_count(), "{name}");

        // Those of one edge come together.
        self.edges.sort_unstable();
        let is_twice = self.edges.windows(2).any(|it| it[0] == it[1]);
        assert!(!is_twice || self.is_cut, "{name}: a half-edge twice");
        let same = |a: &(u32, u32, bool), b: &(u32, u32, bool)| (a.0, a.1) == (b.0, b.1);
        let edges = self.edges.chunk_by(same).count() as i64;
        let lines = if self.is_cut { 0 } else { self.border_lines() };
        (used - edges + faces as i64, lines)
    }

    fn border_lines(&mut self) -> usize {
        self.follower.fill(NONE);
        let same = |a: &(u32, u32, bool), b: &(u32, u32, bool)| (a.0, a.1) == (b.0, b.1);
        for edge in self.edges.chunk_by(same) {
            if let &[(low, high, is_up)] = edge {
                let [from, to] = if is_up { [low, high] } else { [high, low] };
                let before = std::mem::replace(&mut self.follower[from as usize], to);
                assert_eq!(before, NONE, "{}: the border forks", self.name);
            }
        }
        let mut lines = 0;
        for start in 0..self.follower.len() {
            let mut at = std::mem::replace(&mut self.follower[start], NONE);
            lines += usize::from(at != NONE);
            while at != NONE {
                at = std::mem::replace(&mut self.follower[at as usize], NONE);
            }
        }
        lines
    }
}

const NONE: u32 = u32::MAX;

/// All faces by their numbers.
fn all(front: &Front, drawn: &mut Vec<Option<[u32; 3]>>) {
    drawn.clear();
    drawn.resize(front.hierarchy().face_slot_count(), None);
    for (number, face) in front.faces() {
        drawn[number as usize] = Some(face);
    }
}

/// A path with small moves, larger ones and jumps.
struct Path<'a> {
    random: &'a mut Random,
    ball: Ball,
    at: [f64; 3],
}

impl<'a> Path<'a> {
    fn new(mesh: &Mesh, random: &'a mut Random) -> Self {
        let ball = Ball::around(mesh.positions().iter().map(|p| p.map(f64::from))).unwrap();
        let at = random.vector();
        Self { random, ball, at }
    }

    fn next(&mut self) -> CameraView {
        let camera = self.next_camera();
        let tolerance = 0.3 * 40.0_f64.powf(self.random.next());
        camera.view(tolerance).unwrap()
    }

    fn next_camera(&mut self) -> Camera {
        let step = self.random.vector();
        let size = match self.random.next() {
            part if part < 0.5 => 0.02,
            part if part < 0.8 => 0.3,
            _ => 2.0,
        };
        self.at = [0, 1, 2].map(|axis| (self.at[axis] + size * step[axis]).clamp(-1.0, 1.0));
        let Ball { center, radius } = self.ball;
        let beside = self.random.vector();
        let around =
            |axis: usize, size: f64, way: [f64; 3]| center[axis] + size * radius * way[axis];
        Camera {
            eye: [0, 1, 2].map(|axis| around(axis, 3.0, self.at)),
            target: [0, 1, 2].map(|axis| around(axis, 0.5, beside)),
            up: [0.01, 1.0, 0.02],
            field_of_view: 20.0 + 60.0 * self.random.next(),
            size: [800, 600],
        }
    }
}

fn walk(surface: &mut Surface, mesh: &Mesh, hierarchy: &VertexHierarchy, random: &mut Random) {
    let name = surface.name;
    let mut front = Front::new(hierarchy.clone());
    let character = surface.check(&front);
    let (mut drawn, mut now, mut jumped_faces) = (Vec::new(), Vec::new(), Vec::new());
    all(&front, &mut drawn);
    let mut path = Path::new(mesh, random);
    for frame in 0..FRAMES {
        let view = path.next();

        // What was drawn, changed by what the update says, is what is there.
        front.update(&view, 1.0);
        let changes = front.changes();
        for &face in &changes.removed_faces {
            assert!(drawn[face as usize].take().is_some(), "{name}");
        }
        for &face in &changes.added_faces {
            let before = std::mem::replace(&mut drawn[face as usize], front.face(face));
            assert!(before.is_none(), "{name}");
        }
        for &face in &changes.changed_faces {
            let before = std::mem::replace(&mut drawn[face as usize], front.face(face));
            assert!(before.is_some(), "{name}");
        }
        all(&front, &mut now);
        assert!(drawn == now, "{name}: frame {frame}");

        let found = surface.check(&front);
        assert_eq!(found, character, "{name}: frame {frame}");
        let mut jumped = Front::new(hierarchy.clone());
        jumped.update(&view, 1.0);
        all(&jumped, &mut jumped_faces);
        assert!(jumped_faces == drawn, "{name}: frame {frame}");
    }
}

/// A thousand paths: `MESHWEFT_CASES=100 cargo test --release -p meshweft --features files --test view_dependent -- --nocapture
/// fronts_are_surfaces`, and `MESHWEFT_SEED` for others.
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
        let mut surface = Surface::new(name, &mesh, &hierarchy);
        for _ in 0..walks {
            walk(&mut surface, &mesh, &hierarchy, &mut random);
        }
    }
    eprintln!(
        "{walks} walks of {FRAMES} frames around each of {} meshes",
        MESHES.len()
    );
}

/// How far a tolerance has to go up from `low` until something holds, if it does before `high`: at most 1 % too far.
fn least_tolerance([low, high]: [f64; 2], mut holds: impl FnMut(f64) -> bool) -> Option<f64> {
    if !holds(high) {
        return None;
    }
    let (mut low, mut high) = (low, high);
    while high > 1.005 * low {
        let middle = (low * high).sqrt();
        match holds(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    Some(high)
}

/// The best mesh of a number of vertices: what it leaves out is seen at most 1.15 times as large as what the finest front of
/// one tolerance leaves out that has no more vertices. `MESHWEFT_CASES` and `MESHWEFT_SEED` give other paths.
#[test]
fn a_budget_is_kept_in_every_frame_and_spent_well() {
    let Some(folder) = data::folder() else {
        return;
    };
    let walks = from_environment("MESHWEFT_CASES", 1);
    let mut random = Random(from_environment("MESHWEFT_SEED", 2));
    let (mut worst, mut sum, mut count, mut inside) = (0.0_f64, 0.0, 0.0, 0);
    for name in MESHES {
        let mesh = open(&folder, name);
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        let mut surface = Surface::new(name, &mesh, &hierarchy);
        let mut compared = Front::new(hierarchy.clone());
        let mut worst_here = 0.0_f64;
        for _ in 0..walks {
            let mut front = Front::new(hierarchy.clone());
            let roots = front.vertex_count();
            let all = hierarchy.vertex_count() - roots;
            let mut path = Path::new(&mesh, &mut random);
            for frame in 0..FRAMES {
                let camera = path.next_camera();
                let view = |tolerance: f64| camera.view(tolerance).unwrap();
                let vertices = roots + all / [50, 10, 3][frame % 3];
                let budget = FrameBudget {
                    vertices,
                    changes: usize::MAX,
                };
                let is_done = front.update_within(&view(1e-3), 1.0, budget).1;
                assert!(
                    is_done && front.vertex_count() <= vertices,
                    "{name}: frame {frame}"
                );
                surface.check(&front);

                // The tolerance from which on nothing is missing, and that of a front within the budget.
                let range = [1e-3, 1e7];
                let left = least_tolerance(range, |tolerance| {
                    let mut finer = front.clone();
                    finer
                        .update(&view(tolerance), 1.0)
                        .added_vertices
                        .is_empty()
                });
                let same_size = least_tolerance(range, |tolerance| {
                    compared.update(&view(tolerance), 1.0);
                    compared.vertex_count() <= vertices
                });
                // Where the eye is inside of a ball no tolerance is enough.
                let (Some(left), Some(same_size)) = (left, same_size) else {
                    inside += 1;
                    continue;
                };
                let ratio = left / same_size;
                worst_here = worst_here.max(ratio);
                sum += ratio;
                count += 1.0;
            }
        }
        eprintln!("{name}: {worst_here:.3} times the error of a front of one tolerance at most");
        worst = worst.max(worst_here);
    }
    let mean = sum / count;
    eprintln!(
        "{count} frames: {mean:.3} times in the mean, {worst:.3} at most; {inside} without an end"
    );
    assert!(count > 50.0 && worst <= 1.15, "{count} frames, {worst}");
}

/// What is drawn is as near as was asked for: nearly all vertices are within the tolerance, and none is far off.
#[test]
fn errors_are_what_was_asked_for() {
    let Some(folder) = data::folder() else {
        return;
    };
    for name in ["bunny_res2.ply.gz", "elephant_holes.off.gz", "spot.obj.gz"] {
        let path = folder.join("meshes").join(name);
        let document = Document::open(&path, Limits::default()).unwrap();
        for path in CameraPath::SHAPES {
            for tolerance in [1.5, 0.12] {
                let mut options = LodVerifyOptions::default();
                options.path = path.clone();
                options.tolerance = tolerance;
                options.frames = Some(3);
                let errors = lod_verify(&document, &options, &()).unwrap().errors;
                let (share, worst) = (errors.share(), errors.worst);
                let case = format!(
                    "{name}, {}, {tolerance} px: {share} %, {worst}",
                    path.name()
                );
                assert!(share >= 99.9 && worst <= 2.5, "{case}");
            }
        }
    }
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
