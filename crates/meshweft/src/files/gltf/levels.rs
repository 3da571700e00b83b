//! Which meshes are levels of detail of others, as nodes say by `MSFT_lod`.
//!
//! A node with that extension names others, from fine to coarse, that are drawn in its place where less
//! is enough. The mesh of the first of them is level 1 of the mesh of the node, primitive by primitive, the mesh of the
//! second level 2, and so on. What is drawn at full resolution anywhere is no level. What is not sound says nothing.

use std::collections::BTreeMap;

use super::entries::Entries;
use super::json::Value;
use super::movable::PrimitiveNumber;
use super::object::Object;
use crate::files::entry::MeshLevel;

/// The extension that names the levels of a node.
pub(super) const NAME: &str = "MSFT_lod";

/// What a mesh has in its extras where its error is known.
pub(super) const EXTRAS: &str = "MESHWEFT_level";

/// Gives meshes their levels.
///
/// # Complexity
/// Time O(n log n) in the nodes, what they name, and the primitives.
pub(super) fn add(root: &Object, entries: &mut Entries) {
    let nodes: Vec<Value<'_>> = root.elements("nodes").collect();
    let meshes: Vec<Value<'_>> = root.elements("meshes").collect();
    let levels = mesh_levels(&nodes, &meshes);
    if levels.is_empty() {
        return;
    }

    // Entries by primitive. Several primitives may have the faces of one.
    let firsts = (0_usize..).zip(&entries.first_primitives);
    let mut entry_of: BTreeMap<PrimitiveNumber, usize> =
        firsts.map(|(entry, &number)| (number, entry)).collect();
    for (&other, first) in &entries.repeated {
        entry_of.insert(other, entry_of[first]);
    }

    // The first primitive decides, unless one of them is at full resolution.
    let mut found: Vec<Option<MeshLevel>> = vec![None; entries.meshes.len()];
    let mut is_full = vec![false; entries.meshes.len()];
    for (number, &entry) in &entry_of {
        let Some(level) = levels.get(&(number.mesh as usize)) else {
            is_full[entry] = true;
            continue;
        };
        let of = PrimitiveNumber {
            mesh: level.of,
            primitive: number.primitive,
        };
        if let Some(&of) = entry_of.get(&of) {
            found[entry].get_or_insert(MeshLevel {
                number: level.number,
                of,
                error: level.error,
            });
        }
    }
    for ((mesh, level), is_full) in entries.meshes.iter_mut().zip(found).zip(is_full) {
        mesh.level = level.filter(|_| !is_full);
    }
}

/// That a mesh of the file, with all its primitives, is a level of another one.
struct StatedLevel {
    number: usize,
    of: u32,
    error: Option<f32>,
}

/// The meshes of the file that are levels. None of those that they are levels of is one itself.
fn mesh_levels(nodes: &[Value<'_>], meshes: &[Value<'_>]) -> BTreeMap<usize, StatedLevel> {
    let replaces = replacing(nodes);
    let drawn = |node: &Value<'_>| {
        let mesh = node.get("mesh").and_then(Value::whole);
        mesh.filter(|&mesh| mesh < meshes.len())
    };

    // What any other node draws is at full resolution.
    let mut is_full = vec![false; meshes.len()];
    let heads = nodes.iter().zip(&replaces);
    let heads = heads.filter_map(|(node, &replaces)| (!replaces).then_some(node));
    for mesh in heads.clone().filter_map(drawn) {
        is_full[mesh] = true;
    }

    // The first node that names a mesh decides of which it is a level.
    let mut is_named = vec![false; meshes.len()];
    let mut levels = BTreeMap::new();
    for head in heads {
        let Some(of) = drawn(head) else {
            continue;
        };
        for (number, id) in (1_usize..).zip(ids(*head)) {
            let mesh = id.and_then(|id| nodes.get(id)).and_then(drawn);
            let mesh = mesh.filter(|&mesh| !is_full[mesh]);
            let Some(mesh) = mesh.filter(|&mesh| !std::mem::replace(&mut is_named[mesh], true))
            else {
                continue;
            };
            if let Ok(of) = u32::try_from(of)
                && primitive_count(meshes[mesh]) == primitive_count(meshes[of as usize])
            {
                let error = stated_error(meshes[mesh]);
                levels.insert(mesh, StatedLevel { number, of, error });
            }
        }
    }
    levels
}

/// Which nodes are drawn in the place of others: those that are named as levels, and all below them.
pub(super) fn replacing(nodes: &[Value<'_>]) -> Vec<bool> {
    let mut replaces = vec![false; nodes.len()];
    let mut open: Vec<usize> = nodes.iter().flat_map(|&node| ids(node)).flatten().collect();
    while let Some(number) = open.pop() {
        // A file that is not sound may have a node below itself.
        if let Some(replaces @ false) = replaces.get_mut(number) {
            *replaces = true;
            let children = nodes[number].get("children").into_iter();
            let children = children.flat_map(Value::elements);
            open.extend(children.filter_map(Value::whole));
        }
    }
    replaces
}

/// The nodes that a node names as its levels, from fine to coarse; `None` for what is no number.
pub(super) fn ids(node: Value<'_>) -> impl Iterator<Item = Option<usize>> {
    let extension = node.get("extensions").and_then(|all| all.get(NAME));
    let ids = extension.and_then(|extension| extension.get("ids"));
    ids.into_iter().flat_map(Value::elements).map(Value::whole)
}

fn primitive_count(mesh: Value<'_>) -> usize {
    let primitives = mesh.get("primitives").into_iter();
    primitives.flat_map(Value::elements).count()
}

/// How far a level is off, in units of its positions.
fn stated_error(mesh: Value<'_>) -> Option<f32> {
    let stated = mesh.get("extras").and_then(|extras| extras.get(EXTRAS));
    let error: f32 = stated?.get("error")?.raw().parse().ok()?;
    (error.is_finite() && error >= 0.0).then_some(error)
}
