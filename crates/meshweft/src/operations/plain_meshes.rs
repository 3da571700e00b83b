//! The meshes of a document at full resolution as names, positions and faces alone.

use std::collections::BTreeMap;

use crate::error::MeshError;
use crate::files::{Document, FileError, FileErrorKind, MeshEntry, Place};
use crate::index::index32;
use crate::mesh::Mesh;

/// A mesh at full resolution, with vertices of its own.
pub(super) struct SeparateMesh {
    /// Its number in the document.
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) mesh: Mesh,
}

/// The meshes of a document at full resolution with their positions, each with vertices of its own.
///
/// # Complexity
/// Time O(vertices + faces, sorted), however many meshes share vertices.
///
/// # Errors
/// Positions cannot be read.
pub(super) fn plain_meshes(document: &Document) -> Result<Vec<SeparateMesh>, FileError> {
    let entries = document.meshes();
    let mut sharing: BTreeMap<usize, Vec<&MeshEntry>> = BTreeMap::new();
    for entry in entries.iter().filter(|entry| entry.level.is_none()) {
        sharing.entry(entry.vertex_group).or_default().push(entry);
    }

    let mut meshes = Vec::new();
    let each = entries.iter().zip(document.positions_of_each()).enumerate();
    for (number, (entry, positions)) in each {
        if entry.level.is_some() {
            continue;
        }
        let positions = positions?;
        let positions = positions.as_deref().unwrap_or_default();
        let vertex_count = entry.mesh.vertex_count();
        let group = &sharing[&entry.vertex_group];
        let mesh = if positions.len() != vertex_count {
            Mesh::connectivity_only(vertex_count, entry.mesh.faces().to_vec())
        } else if group.len() == 1 {
            Mesh::new(positions.to_vec(), entry.mesh.faces().to_vec())
        } else {
            let mut own = entry.mesh.faces().as_flattened().to_vec();
            // What no mesh has goes to the first one.
            if std::ptr::eq(group[0], entry) {
                own.extend(unused(group, vertex_count));
            }
            only(positions, entry.mesh.faces(), own)
        };
        let mesh = mesh.map_err(|error| {
            let problem = FileErrorKind::Order(error).at(Place::File);
            problem.in_file(document.path(), Some(document.format()))
        })?;
        meshes.push(SeparateMesh {
            number,
            name: entry.name.clone(),
            mesh,
        });
    }
    Ok(meshes)
}

/// The vertices that none of some meshes has a face at.
fn unused(group: &[&MeshEntry], vertex_count: usize) -> impl Iterator<Item = u32> + use<> {
    let mut is_used = vec![false; vertex_count];
    let faces = group.iter().flat_map(|entry| entry.mesh.faces());
    for &vertex in faces.flatten() {
        is_used[vertex as usize] = true;
    }
    let vertices = (0..).zip(is_used);
    vertices.filter_map(|(vertex, is_used)| (!is_used).then_some(vertex))
}

/// A mesh of some of the vertices, in their order; they may be named more than once.
fn only(positions: &[[f32; 3]], faces: &[[u32; 3]], mut own: Vec<u32>) -> Result<Mesh, MeshError> {
    own.sort_unstable();
    own.dedup();
    let kept: Vec<_> = own.iter().map(|&it| positions[it as usize]).collect();
    let new = |vertex| index32(own.partition_point(|&it| it < vertex));
    let renumbered: Vec<_> = faces.iter().map(|face| face.map(new)).collect();
    Mesh::new(kept, renumbered)
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;
    use std::path::Path;

    use super::*;
    use crate::files::{Format, ReadOptions};

    /// A GLB of primitives with a face each, whose corners are three vertices in turn, of one buffer of vertices.
    fn primitives(count: u32, vertex_count: u32) -> Document {
        let mut buffer = Vec::new();
        for vertex in 0..vertex_count {
            let position = [vertex as f32, 0.5, (vertex % 7) as f32];
            buffer.extend(position.into_iter().flat_map(f32::to_le_bytes));
        }
        let positions = buffer.len();
        buffer.extend((0..3 * count).flat_map(u32::to_le_bytes));

        let mut json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[
            {{"buffer":0,"byteLength":{positions}}},
            {{"buffer":0,"byteOffset":{positions},"byteLength":{}}}],"accessors":[
            {{"bufferView":0,"componentType":5126,"count":{vertex_count},"type":"VEC3","min":[0,0,0],"max":[9,9,9]}}"#,
            buffer.len(),
            12 * count
        );
        for primitive in 0..count {
            let offset = 12 * primitive;
            write!(json, r#",{{"bufferView":1,"byteOffset":{offset},"componentType":5125,"count":3,"type":"SCALAR"}}"#).unwrap();
        }
        json += r#"],"meshes":[{"primitives":["#;
        for indices in 1..=count {
            let comma = if indices == 1 { "" } else { "," };
            write!(
                json,
                r#"{comma}{{"attributes":{{"POSITION":0}},"indices":{indices}}}"#
            )
            .unwrap();
        }
        json += "]}]}";

        while !json.len().is_multiple_of(4) {
            json.push(' ');
        }
        let length = index32(28 + json.len() + buffer.len());
        let mut glb = b"glTF".to_vec();
        for number in [2, length, index32(json.len())] {
            glb.extend(number.to_le_bytes());
        }
        glb.extend(b"JSON");
        glb.extend(json.bytes());
        glb.extend(index32(buffer.len()).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(buffer);
        let name = Path::new("parts.glb");
        Document::from_bytes(glb, Format::Glb, name, ReadOptions::default()).unwrap()
    }

    #[test]
    fn meshes_that_share_vertices_get_their_own() {
        let meshes = plain_meshes(&primitives(3, 11)).unwrap();
        // The first one has what no other has too.
        let firsts = [0.0, 3.0, 6.0];
        for (SeparateMesh { mesh, .. }, first) in meshes.iter().zip(firsts) {
            assert_eq!(mesh.faces(), [[0, 1, 2]]);
            let found: Vec<f32> = mesh.positions().iter().map(|it| it[0]).collect();
            let mut expected = vec![first, first + 1.0, first + 2.0];
            expected.extend([9.0, 10.0].iter().filter(|_| first == 0.0));
            assert_eq!(found, expected);
        }
    }

    /// In time and memory proportional to the square this takes many minutes, and more memory than there is.
    #[test]
    fn many_meshes_may_share_vertices() {
        let count = 20_000;
        let meshes = plain_meshes(&primitives(count, 3 * count)).unwrap();
        assert_eq!(meshes.len(), count as usize);
        assert!(meshes.iter().all(|it| it.mesh.vertex_count() == 3));
    }
}
