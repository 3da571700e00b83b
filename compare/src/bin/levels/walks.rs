//! Walks between random levels, checked against the vertices that each level has.

use std::collections::BTreeMap;

use meshweft::Mesh;
use meshweft::order::baselines;
use meshweft::progressive::{CheckpointWalk, Checkpoints, IndexBuffer, ProgressiveMesh, Walk};

use crate::MADE;

/// The cache size of the orders.
const SIZE: u32 = 16;
/// Levels of a walk between full resolution and full resolution.
const LEGS: usize = 3;
/// Levels that walks over a mesh go to.
const GOALS: usize = 200;

pub(crate) fn print(meshes: &[(String, Mesh)], count: u64) -> Result<(), String> {
    println!(
        "Walks over {LEGS} random levels and back: at each level exactly its faces, each once, and the first bytes again in the end.\n"
    );
    println!("| mesh | walks | levels checked | wrong |");
    println!("|---|--:|--:|--:|");
    let of_each = count / (meshes.len() as u64).max(1);
    let mut is_wrong = false;
    for (name, mesh) in meshes {
        let wrong = wrong(&MADE.progressive(mesh, SIZE)?, of_each)?;
        let checked = of_each * (LEGS as u64 + 1);
        println!("| {name} | {of_each} | {checked} | {wrong} |");
        is_wrong |= wrong > 0;
    }
    match is_wrong {
        true => Err("a walk went wrong".to_owned()),
        false => Ok(()),
    }
}

/// How many levels had other faces.
fn wrong(progressive: &ProgressiveMesh, walks: u64) -> Result<usize, String> {
    let order = compare::greedy(SIZE - 1);
    let checkpoints = Checkpoints::new(progressive, MADE.ratio, |faces| order.face_order(faces));
    let checkpoints = checkpoints.map_err(|error| error.to_string())?;
    let mut walk = Walk::new(progressive);
    let mut stored = CheckpointWalk::new(&checkpoints);
    let mut buffer = IndexBuffer::new(&checkpoints);
    let mut uploaded = buffer.faces().to_vec();
    let start = uploaded.clone();
    let mut expected = BTreeMap::new();
    let (mut in_place, mut in_order) = (Vec::new(), Vec::new());

    // Random goals, the same in each run; several walks come to each.
    let random = baselines::random(progressive.last_level() + 1, 1);
    let goals = &random.new_to_old()[..GOALS.min(progressive.last_level() + 1)];
    let mut wrong = 0;
    for number in 0..walks {
        let legs = baselines::random(goals.len(), number);
        let legs = legs.new_to_old().iter().take(LEGS);
        let levels = legs.map(|&goal| goals[goal as usize] as usize);
        for level in levels.chain([0]) {
            walk.go_to(level);
            walk.emit(&mut in_place);
            stored.go_to(level);
            stored.emit(&mut in_order);
            let changed = buffer.go_to(level).to_vec();
            uploaded.resize(buffer.faces().len(), [0; 3]);
            for range in changed {
                uploaded[range.clone()].copy_from_slice(&buffer.faces()[range]);
            }

            // A face that left is degenerate in the buffer.
            let drawn = uploaded.iter().filter(|face| face[0] != face[1]);
            let is_drawn = match level {
                0 => uploaded == start,
                _ => drawn.eq(&in_order),
            };
            let expected = expected
                .entry(level)
                .or_insert_with(|| digest(&faces_of(progressive, level)));
            let are_right = [&in_place, &in_order].map(|faces| digest(faces) == *expected);
            wrong += usize::from(!is_drawn || are_right != [true; 2]);
        }
        let is_back = in_place == progressive.faces() && in_order == start && uploaded == start;
        wrong += usize::from(!is_back);
    }
    Ok(wrong)
}

/// The faces of a level, from the vertex that stands for each; one that has the same twice has left, by the first
/// records if it was so at full resolution.
fn faces_of(progressive: &ProgressiveMesh, level: usize) -> Vec<[u32; 3]> {
    if level == 0 {
        return progressive.faces().to_vec();
    }
    let coarse = progressive.fine_to_coarse(level);
    let faces = progressive.faces().iter().filter_map(|face| {
        let [a, b, c] = face.map(|vertex| coarse[vertex as usize]);
        let face = [a?, b?, c?];
        (a != b && b != c && c != a).then_some(face)
    });
    faces.collect()
}

/// The number of faces, and the sum of a hash of each: equal for the same faces in any order.
fn digest(faces: &[[u32; 3]]) -> (usize, u64) {
    let mixed = |hash: u64, corner: u32| {
        let hash = (hash ^ u64::from(corner)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^ hash >> 29
    };
    let hashes = faces
        .iter()
        .map(|face| face.iter().fold(1, |hash, &corner| mixed(hash, corner)));
    (faces.len(), hashes.fold(0, u64::wrapping_add))
}
