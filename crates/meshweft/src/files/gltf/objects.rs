//! Which meshes are parts of one object, and may meet.
//!
//! The primitives of a glTF mesh are. Primitives with one list of indices are one mesh here, and may be of
//! several glTF meshes: then these are one object.

use std::collections::{BTreeMap, BTreeSet};

use super::movable::Draws;
use super::primitives::{Primitives, may_draw_faces};

/// For each mesh, the number of its object, and whether that has faces in no mesh. `drawn_by` has, for each
/// mesh, the numbers of the glTF meshes that it is of.
pub(super) fn objects(primitives: &Primitives, drawn_by: &[Vec<u32>]) -> Vec<(usize, bool)> {
    // The glTF meshes that have faces elsewhere.
    let movable = primitives.movable.iter();
    let movable = movable.filter_map(|primitive| match primitive.draws {
        Draws::Other(why) => Some((why, primitive.number)),
        Draws::Faces | Draws::FacesInOrder => None,
    });
    let staying = primitives.staying.iter();
    let staying = staying.map(|staying| (&*staying.why, staying.number));
    let others = movable.chain(staying);
    let others = others.filter(|(why, _)| may_draw_faces(why));
    let others: BTreeSet<u32> = others.map(|(_, number)| number.mesh).collect();

    // Objects, joined where a mesh is of several.
    let mut joined: BTreeMap<u32, u32> = BTreeMap::new();
    for meshes in drawn_by {
        for pair in meshes.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|mesh| root_of(&mut joined, mesh));
            // One that is its own parent would have no root.
            if a != b {
                joined.insert(a.max(b), a.min(b));
            }
        }
    }
    let mut others_of = BTreeSet::new();
    for &mesh in &others {
        others_of.insert(root_of(&mut joined, mesh));
    }
    let mut numbers = BTreeMap::new();
    let of_mesh = drawn_by.iter().map(|meshes| {
        let root = root_of(&mut joined, meshes[0]);
        let next = numbers.len();
        let number = *numbers.entry(root).or_insert(next);
        (number, others_of.contains(&root))
    });
    of_mesh.collect()
}

/// The root of a set; paths are halved on the way. What has no entry is its own root.
fn root_of(joined: &mut BTreeMap<u32, u32>, mut mesh: u32) -> u32 {
    while let Some(&parent) = joined.get(&mesh) {
        if let Some(&above) = joined.get(&parent) {
            joined.insert(mesh, above);
        }
        mesh = parent;
    }
    mesh
}
