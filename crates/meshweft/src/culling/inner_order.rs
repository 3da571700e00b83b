//! Groups of faces, each put in an order for a cache.

use crate::first_use::FirstUse;
use crate::mesh::Mesh;
use crate::order::Optimizer;
use crate::parallel;
use crate::permutation::{FaceOrder, Permutation};

/// The faces of a mesh group by group, each group in an order of its own; the groups have each face once.
///
/// The result is the same on any number of threads.
pub(super) fn of_groups(mesh: &Mesh, groups: Vec<Vec<u32>>, optimizer: &Optimizer) -> FaceOrder {
    joined(each(mesh, groups, optimizer))
}

/// Groups of faces, each with an order of its own.
pub(super) fn each(
    mesh: &Mesh,
    groups: Vec<Vec<u32>>,
    optimizer: &Optimizer,
) -> Vec<(Vec<u32>, FaceOrder)> {
    // Some groups are one piece of work, so that few tables of all vertices are made.
    let share = (groups.len() / 64).max(1);
    let mut groups = groups.into_iter();
    let mut pieces = Vec::new();
    while groups.len() > 0 {
        pieces.push(groups.by_ref().take(share).collect());
    }
    let ordered = parallel::map(pieces, |piece: Vec<Vec<u32>>| {
        let corners = piece.iter().map(|members| 3 * members.len()).sum();
        let mut numbers = FirstUse::new(mesh.vertex_count(), corners);
        let order = |members: Vec<u32>| {
            let faces = members.iter().map(|&face| mesh.faces()[face as usize]);
            let faces: Vec<[u32; 3]> = faces
                .map(|face| face.map(|vertex| numbers.number(vertex)))
                .collect();
            numbers.finish();
            let order = optimizer.face_order(&faces);
            (members, order)
        };
        piece.into_iter().map(order).collect::<Vec<_>>()
    });
    ordered.into_iter().flatten().collect()
}

/// All groups as one order: they have each face once.
pub(super) fn joined(groups: Vec<(Vec<u32>, FaceOrder)>) -> FaceOrder {
    let count = groups.iter().map(|(members, _)| members.len()).sum();
    let mut new_to_old = Vec::with_capacity(count);
    let mut rotations = Vec::with_capacity(count);
    for (members, order) in groups {
        let places = order.new_to_old().iter();
        new_to_old.extend(places.map(|&place| members[place as usize]));
        rotations.extend((0..order.len()).map(|face| order.rotation(face)));
    }
    let order = FaceOrder::new(Permutation::from_algorithm(new_to_old), rotations);
    order.expect("a rotation for each face")
}
