//! One order for every cache: no worse than meshoptimizer's in any of them, on any mesh.

use compare::rivals::Meshopt;
use meshweft::cache::{self, nvidia};
use meshweft::files::Document;
use meshweft::order::{Effort, Optimizer, Target, baselines};
use meshweft::{Limits, Mesh};

fn optimizer(effort: Effort) -> Optimizer {
    Optimizer {
        target: Target::Universal,
        effort,
        ..Optimizer::default()
    }
}

/// Misses in each model, and setup cycles of NVIDIA cards.
fn counts(faces: &[[u32; 3]]) -> Vec<u64> {
    let mut counts = cache::misses_of(faces, &Target::UNIVERSAL);
    counts.push(nvidia::counts(faces).setup_cycles);
    counts
}

fn check(name: &str, mesh: &Mesh, effort: Effort) {
    let order = optimizer(effort).face_order(mesh);
    let ours = counts(&order.apply(mesh.faces()));
    let theirs = counts(&Meshopt::VertexCache.ordered(mesh));
    let is_worse = ours.iter().zip(&theirs).any(|(ours, theirs)| ours > theirs);
    assert!(
        !is_worse,
        "{name}, {effort}: {ours:?}, meshoptimizer's {theirs:?}"
    );

    let mut drawn = order.new_to_old().to_vec();
    drawn.sort_unstable();
    assert!((0..).zip(drawn).all(|(i, face)| face == i), "{name}");
}

#[test]
fn no_mesh_loses_to_meshoptimizer() {
    compare::for_each_mesh("universal order, fast and best", |name, mesh| {
        check(name, mesh, Effort::Fast);
        check(name, mesh, Effort::Best);
        // It takes half a minute for the largest, and the smaller ones show the same.
        if mesh.face_count() < 20_000 {
            check(name, mesh, Effort::Max);
        }
    });
}

#[test]
fn no_primitive_of_a_scene_loses() {
    let Some(data) = compare::data_folder() else {
        compare::say("universal order: skipped, no test data");
        return;
    };
    let scenes = std::fs::read_dir(data.join("gltf")).expect("the folder of scenes can be listed");
    let mut files: Vec<_> = scenes.map(|entry| entry.unwrap().path()).collect();
    files.push(data.join("meshes/sextant.wrl.gz"));
    files.sort();
    let mut meshes = 0;
    for file in &files {
        // Those that are compressed have no faces that can be read.
        let Ok(document) = Document::open(file, Limits::default()) else {
            continue;
        };
        for entry in document.meshes() {
            let name = format!("{}, {}", compare::mesh_name(file), entry.name);
            check(&name, &entry.mesh, Effort::Fast);
            check(&name, &entry.mesh, Effort::Best);
            meshes += 1;
        }
    }
    compare::say(&format!("universal order: {meshes} meshes of scenes"));
    assert!(meshes > 20, "{meshes} meshes of scenes");
}

#[test]
fn no_soup_of_ten_thousand_loses() {
    for seed in 0..10_000_u64 {
        let draws = baselines::random(1300, seed);
        let draws = draws.new_to_old();
        // Few vertices, so that faces repeat and name a vertex twice, to many.
        let vertices = 1 + draws[0] % (3 << (draws[1] % 8));
        let faces = draws[2] as usize % 400;
        let corner = |i: usize, draw: u32| match seed % 3 {
            // All at random, or near the faces drawn before.
            0 => draw % vertices,
            _ => (u32::try_from(i / 6).unwrap() + draw % 5) % vertices,
        };
        let corners = draws[3..]
            .iter()
            .enumerate()
            .map(|(i, &draw)| corner(i, draw));
        let corners: Vec<u32> = corners.take(3 * faces).collect();
        let (corners, _) = corners.as_chunks::<3>();
        let mesh = Mesh::connectivity_only(vertices as usize, corners.to_vec()).unwrap();
        let effort = [Effort::Fast, Effort::Best][usize::from(seed % 5 == 0)];
        check(&format!("soup {seed}"), &mesh, effort);
    }
}

#[test]
fn threads_change_nothing() {
    compare::for_each_mesh("universal order, one thread and four", |name, mesh| {
        if mesh.face_count() < 200_000 && mesh.face_count() % 4 != 0 {
            return;
        }
        let [one, four] = [1, 4].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| optimizer(Effort::Fast).face_order(mesh))
        });
        assert!(one == four, "{name}");
    });
}
