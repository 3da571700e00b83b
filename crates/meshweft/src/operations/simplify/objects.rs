//! Which meshes of a file are simplified together, and how what is left of them is selected.

use std::collections::BTreeMap;

use super::reduced_mesh::ReducedMesh;
use crate::files::{Document, Edit, FileError, MeshEntry, SelectedFaces, SelectedVertices};
use crate::index::index32;

/// The meshes of each object: those of one number, and those that share their vertices. Meshes rise, and
/// objects by their first one.
pub(in crate::operations) fn objects(entries: &[MeshEntry]) -> Vec<Vec<usize>> {
    let mut parents: Vec<usize> = (0..entries.len()).collect();
    let (mut by_object, mut by_group) = (BTreeMap::new(), BTreeMap::new());
    for (mesh, entry) in entries.iter().enumerate() {
        let first_of_object = *by_object.entry(entry.object).or_insert(mesh);
        let first_of_group = *by_group.entry(entry.vertex_group).or_insert(mesh);
        for first in [first_of_object, first_of_group] {
            let [a, b] = [first, mesh].map(|mesh| root_of(&mut parents, mesh));
            parents[a.max(b)] = a.min(b);
        }
    }
    let mut objects: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for mesh in 0..entries.len() {
        let root = root_of(&mut parents, mesh);
        objects.entry(root).or_default().push(mesh);
    }
    objects.into_values().collect()
}

/// The root of a set; paths are halved on the way.
fn root_of(parents: &mut [usize], mut mesh: usize) -> usize {
    while parents[mesh] != mesh {
        parents[mesh] = parents[parents[mesh]];
        mesh = parents[mesh];
    }
    mesh
}

/// How an object was put into the document.
pub(in crate::operations) enum Applied {
    /// Faces and vertices as planned.
    Whole,
    /// Its faces, but all vertices stay: why.
    WithoutVertices(String),
    /// Not at all: why.
    Refused(String),
}

/// Selects what is left of objects; how each of them came in.
///
/// All at once. Where that is refused, one after the other, so that one does not keep the others.
pub(in crate::operations) fn apply(
    document: &mut Document,
    reduced: &[&[ReducedMesh]],
    vertex_orders: &mut BTreeMap<usize, Vec<u32>>,
) -> Vec<Applied> {
    let all: Vec<&ReducedMesh> = reduced.iter().copied().flatten().collect();
    if all.is_empty() || select(document, &all, true, vertex_orders).is_ok() {
        return reduced.iter().map(|_| Applied::Whole).collect();
    }
    let mut apply_one = |reduced: &&[ReducedMesh]| {
        let meshes: Vec<&ReducedMesh> = reduced.iter().collect();
        let text = |error: FileError| error.kind.to_string();
        match select(document, &meshes, true, vertex_orders) {
            Ok(()) => Applied::Whole,
            Err(error) => match select(document, &meshes, false, vertex_orders) {
                Ok(()) => Applied::WithoutVertices(text(error)),
                Err(error) => Applied::Refused(text(error)),
            },
        }
    };
    reduced.iter().map(&mut apply_one).collect()
}

/// Selects the faces of meshes, and the vertices that are then left if these may leave. `vertex_orders` has,
/// for each group whose vertices did, which stay.
fn select(
    document: &mut Document,
    meshes: &[&ReducedMesh],
    with_vertices: bool,
    vertex_orders: &mut BTreeMap<usize, Vec<u32>>,
) -> Result<(), FileError> {
    let entries = document.meshes();
    let kept = match with_vertices {
        true => kept_vertices(entries, meshes),
        false => BTreeMap::new(),
    };
    let faces: Vec<SelectedFaces<'_>> = meshes
        .iter()
        .map(|reduced| SelectedFaces {
            mesh: reduced.mesh,
            faces: &reduced.faces,
            corner_sources: &reduced.corner_sources,
        })
        .collect();
    let vertices: Vec<SelectedVertices<'_>> = kept
        .iter()
        .map(|(&vertex_group, vertices)| SelectedVertices {
            vertex_group,
            vertices,
        })
        .collect();
    document.edit(Edit::select(&faces, &vertices))?;
    vertex_orders.extend(kept);
    Ok(())
}

/// Which vertices of each group stay, for groups of which some leave: those that faces used and use no more
/// do.
fn kept_vertices(entries: &[MeshEntry], meshes: &[&ReducedMesh]) -> BTreeMap<usize, Vec<u32>> {
    let mut leaves: BTreeMap<usize, Vec<bool>> = BTreeMap::new();
    for reduced in meshes {
        let entry = &entries[reduced.mesh];
        let count = entry.mesh.vertex_count();
        let leaves = leaves
            .entry(entry.vertex_group)
            .or_insert_with(|| vec![false; count]);
        // Members of a group may have different numbers of vertices.
        leaves.resize(leaves.len().max(count), false);
        for &vertex in entry.mesh.faces().as_flattened() {
            leaves[vertex as usize] = true;
        }
    }
    for reduced in meshes {
        let group = entries[reduced.mesh].vertex_group;
        let Some(leaves) = leaves.get_mut(&group) else {
            continue;
        };
        for vertex in reduced.faces.iter().flat_map(|face| face.corners) {
            leaves[vertex as usize] = false;
        }
    }
    let some_leave = leaves
        .into_iter()
        .filter(|(_, leaves)| leaves.iter().any(|&leaves| leaves));
    some_leave
        .map(|(group, leaves)| {
            let numbers = 0..index32(leaves.len());
            (group, numbers.filter(|&v| !leaves[v as usize]).collect())
        })
        .collect()
}
