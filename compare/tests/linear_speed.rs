//! Our linear-speed optimisation draws the faces exactly as meshoptimizer's `optimizeVertexCache` does,
//! so that no cache of any kind can tell the two apart.

use compare::rivals::Meshopt;
use meshweft::files::Document;
use meshweft::order::{Target, baselines};
use meshweft::{Limits, Mesh, cache};

fn check(name: &str, mesh: &Mesh) {
    let order = baselines::linear_speed(mesh);
    let ours = order.apply(mesh.faces());
    let theirs = Meshopt::VertexCache.ordered(mesh);
    let differing = ours.iter().zip(&theirs).position(|(a, b)| a != b);
    assert_eq!(differing, None, "{name}");
    assert_eq!(ours.len(), theirs.len(), "{name}");
}

#[test]
fn faces_come_in_the_same_order() {
    let (mut sum, mut worst, mut meshes) = (0.0, 0.0_f64, 0);
    compare::for_each_mesh("linear-speed", |name, mesh| {
        check(name, mesh);
        let ours = baselines::linear_speed(mesh).apply(mesh.faces());
        let theirs = Meshopt::VertexCache.ordered(mesh);
        for model in Target::UNIVERSAL {
            let [ours, theirs] = [&ours, &theirs].map(|faces| cache::misses(faces, model) as f64);
            sum += ours / theirs / Target::UNIVERSAL.len() as f64;
            worst = worst.max(ours / theirs);
        }
        meshes += 1;
    });
    if meshes > 0 {
        let mean = sum / f64::from(meshes);
        compare::say(&format!(
            "linear-speed: misses over meshoptimizer's in nine caches: mean {mean:.3}, worst {worst:.3}"
        ));
        assert_eq!(worst, 1.0);
    }
}

#[test]
fn of_every_primitive_of_scenes() {
    let Some(data) = compare::data_folder() else {
        compare::say("linear-speed: skipped, no test data");
        return;
    };
    let scenes = std::fs::read_dir(data.join("gltf")).expect("the folder of scenes can be listed");
    let mut files: Vec<_> = scenes.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "glb"));
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
            check(&name, &entry.mesh);
            meshes += 1;
        }
    }
    compare::say(&format!("linear-speed: {meshes} meshes of scenes"));
    assert!(meshes > 20, "{meshes} meshes of scenes");
}

#[test]
fn of_ten_thousand_soups() {
    for seed in 0..10_000_u64 {
        let draws = baselines::random(3200, seed);
        let draws = draws.new_to_old();
        // Few vertices, so that faces repeat and name a vertex twice, to many.
        let vertices = 1 + draws[0] % (3 << (draws[1] % 8));
        let faces = draws[2] as usize % 1000;
        let corners: Vec<_> = draws[3..]
            .chunks_exact(3)
            .take(faces)
            .map(|c| [c[0], c[1], c[2]].map(|v| v % vertices))
            .collect();
        let mesh = Mesh::connectivity_only(vertices as usize, corners).unwrap();
        check(&format!("soup {seed}"), &mesh);
    }
    compare::say("linear-speed: 10000 soups");
}

/// Their vertices have more faces than are gone through one by one.
#[test]
fn around_hubs() {
    for (rim, rows) in [(300, 2), (1000, 0), (2000, 5), (700, 40)] {
        let drum = drum(rim, rows);
        let vertices = drum.as_flattened().iter().max().unwrap() + 1;
        for (seed, turns) in (0..4).zip(0..) {
            let mut faces = drum.clone();
            if seed > 0 {
                faces = baselines::random(faces.len(), seed).apply(&faces);
            }
            // Turned in a way that is another for each face.
            for (face, turn) in faces.iter_mut().zip((0..).map(|i| i * turns / 2)) {
                face.rotate_left(turn % 3);
            }
            let mesh = Mesh::connectivity_only(vertices as usize, faces).unwrap();
            check(&format!("drum of {rim}, {rows} rows, {seed}"), &mesh);
        }
    }
    // Index buffers that are filled up, and few vertices that all are hubs.
    for vertices in [3, 5, 20] {
        let draws = baselines::random(9000, u64::from(vertices));
        let corners: &[[u32; 3]] = draws.new_to_old().as_chunks().0;
        let drawn = corners.iter().map(|face| face.map(|v| v % vertices));
        let padding = (0..1000).map(|i| [1, 1, i % 2]);
        let mesh = Mesh::connectivity_only(20, drawn.chain(padding).collect::<Vec<_>>()).unwrap();
        check(&format!("{vertices} hubs"), &mesh);
    }
}

/// A wall of `rows` rings of `rim` vertices, and a fan at each end of it.
fn drum(rim: u32, rows: u32) -> Vec<[u32; 3]> {
    let at = |row: u32, i: u32| 2 + row * rim + i % rim;
    let mut faces = Vec::new();
    for i in 0..rim {
        faces.push([0, at(0, i + 1), at(0, i)]);
        faces.push([1, at(rows, i), at(rows, i + 1)]);
        for row in 0..rows {
            faces.push([at(row, i), at(row, i + 1), at(row + 1, i)]);
            faces.push([at(row + 1, i), at(row, i + 1), at(row + 1, i + 1)]);
        }
    }
    faces
}
