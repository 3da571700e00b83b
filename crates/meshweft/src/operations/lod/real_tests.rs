//! Fronts of real meshes against the closure over what each point needs.

use crate::files::Document;
use crate::geometry::Ball;
use crate::limits::Limits;
use crate::lod::fast_mesh::tests::{active, closure, failing};
use crate::lod::fast_mesh::{FastMesh, Front};
use crate::lod::{Camera, CameraView};
use crate::mesh::Mesh;
use crate::operations::data_folder;
use crate::random::{SplitMix64, from_environment};

/// Closed meshes, some with borders, and one with points where it is not a manifold.
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

/// Frames of a path.
const FRAMES: usize = 10;

/// Some steps of an eye that moves a little, and sometimes jumps.
fn views(ball: Ball, random: &mut SplitMix64) -> Vec<CameraView> {
    let mut way = |size: f64| [(); 3].map(|()| (random.below(2001) as f64 / 1000.0 - 1.0) * size);
    let mut at = way(2.5);
    let mut all = Vec::new();
    for frame in 0..FRAMES {
        let step = way(if frame % 4 == 3 { 2.5 } else { 0.1 });
        at = [0, 1, 2].map(|axis| (at[axis] + step[axis]).clamp(-3.0, 3.0));
        let beside = way(0.5);
        let place = |way: [f64; 3]| [0, 1, 2].map(|i| ball.center[i] + ball.radius * way[i]);
        let camera = Camera {
            eye: place(at),
            target: place(beside),
            up: [0.01, 1.0, 0.02],
            field_of_view: 40.0,
            size: [800, 600],
        };
        // An eye at its target sees nothing.
        all.extend(camera.view([0.3, 1.5, 6.0][frame % 3]));
    }
    all
}

/// A thousand paths: `MESHWEFT_CASES=100 cargo test --release -p meshweft --all-features --lib real_fronts`, and
/// `MESHWEFT_SEED` for others.
#[test]
fn real_fronts_are_the_closure_of_what_the_view_needs() {
    let Some(folder) = data_folder::folder() else {
        return;
    };
    let paths = from_environment("MESHWEFT_CASES", 2);
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 1));
    for name in MESHES {
        let path = folder.join("meshes").join(name);
        let document = Document::open(&path, Limits::default()).unwrap();
        let positions = document.positions(0).unwrap().unwrap();
        let mesh = Mesh::new(positions, document.meshes()[0].mesh.faces().to_vec()).unwrap();
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        let ball = hierarchy.ball().unwrap();
        let mut front = Front::new(hierarchy.clone());
        let (mut needed, mut drawn) = (0, 0);
        for _ in 0..paths {
            for view in views(ball, &mut random) {
                front.update(&view, 1.0);
                let active = active(&front);
                assert!(active == closure(&hierarchy, &view), "{name}");
                needed += failing(&hierarchy, &view);
                drawn += active.len();
            }
        }
        // Few are active only because others need them; more where a CAD mesh has large flat parts.
        let ratio = drawn as f64 / needed as f64;
        eprintln!("{name}: active over those that the view needs itself {ratio:.3}");
        assert!(ratio < 2.5, "{name}: {ratio}");
    }
}
