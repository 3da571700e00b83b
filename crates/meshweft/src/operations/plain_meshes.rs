//! The meshes of a document as names, positions and faces alone.

use std::collections::BTreeMap;

use crate::error::MeshError;
use crate::files::{Document, FileError, FileErrorKind, Place};
use crate::index::index32;
use crate::mesh::Mesh;

/// The meshes of a document with their positions, each with vertices of its own.
///
/// # Errors
/// Positions cannot be read.
pub(super) fn plain_meshes(document: &Document) -> Result<Vec<(String, Mesh)>, FileError> {
    let entries = document.meshes();
    let mut sharing: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, entry) in entries.iter().enumerate() {
        sharing.entry(entry.vertex_group).or_default().push(number);
    }

    let mut meshes = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        let positions = document.positions(number)?.unwrap_or_default();
        let faces = entry.mesh.faces().to_vec();
        let group = &sharing[&entry.vertex_group];
        let mesh = match group.len() {
            1 => with_positions(positions, faces, entry.mesh.vertex_count()),
            _ => {
                let all = || group.iter().flat_map(|&other| entries[other].mesh.faces());
                let count = positions.len();
                let has = |faces: &mut dyn Iterator<Item = &[u32; 3]>| {
                    let mut is_used = vec![false; count];
                    for &vertex in faces.flatten() {
                        if let Some(is_used) = is_used.get_mut(vertex as usize) {
                            *is_used = true;
                        }
                    }
                    is_used
                };
                let mut own = has(&mut faces.iter());
                if group[0] == number {
                    let of_any = has(&mut all());
                    for (own, of_any) in own.iter_mut().zip(of_any) {
                        *own |= !of_any;
                    }
                }
                only(&positions, &faces, &own)
            }
        };
        let mesh = mesh.map_err(|error| {
            let problem = FileErrorKind::Order(error).at(Place::File);
            problem.in_file(document.path(), Some(document.format()))
        })?;
        meshes.push((entry.name.clone(), mesh));
    }
    Ok(meshes)
}

/// A mesh; without positions for all its vertices, none.
fn with_positions(
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    vertex_count: usize,
) -> Result<Mesh, MeshError> {
    match positions.len() == vertex_count {
        true => Mesh::new(positions, faces),
        false => Mesh::connectivity_only(vertex_count, faces),
    }
}

/// A mesh of some of the vertices, in their order.
fn only(positions: &[[f32; 3]], faces: &[[u32; 3]], own: &[bool]) -> Result<Mesh, MeshError> {
    let mut new = vec![0; own.len()];
    let mut kept = Vec::new();
    for (vertex, _) in own.iter().enumerate().filter(|(_, own)| **own) {
        new[vertex] = index32(kept.len());
        kept.push(positions[vertex]);
    }
    let renumbered = faces.iter();
    let renumbered = renumbered.map(|face| face.map(|vertex| new[vertex as usize]));
    Mesh::new(kept, renumbered.collect::<Vec<_>>())
}
