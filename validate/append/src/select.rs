//! Some of the faces of a scene, with the vertices that they use.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Edit, MeshEntry, SelectedFace, SelectedFaces, SelectedVertices};

/// Leaves every second face of each mesh, last first where that is possible, and of vertices that can
/// leave those that are used, unless lines or strips need others; prints how many faces there were and are.
pub(crate) fn select(from: &Path, to: &Path) -> Result<(), Box<dyn Error>> {
    let mut document = Document::open(from, Limits::default())?;
    let chosen: Vec<Vec<SelectedFace>> = document.meshes().iter().map(every_second).collect();
    let mut used: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (entry, faces) in document.meshes().iter().zip(&chosen) {
        if entry.vertices_movable {
            let of_group = used.entry(entry.vertex_group).or_default();
            of_group.extend(faces.iter().flat_map(|face| face.corners));
        }
    }
    for vertices in used.values_mut() {
        vertices.sort_unstable();
        vertices.dedup();
    }

    let faces = chosen
        .iter()
        .enumerate()
        .filter(|(_, faces)| !faces.is_empty());
    let faces: Vec<SelectedFaces<'_>> = faces
        .map(|(mesh, faces)| SelectedFaces::new(mesh, faces))
        .collect();
    let vertices = used.iter().filter(|(_, vertices)| !vertices.is_empty());
    let vertices: Vec<SelectedVertices<'_>> = vertices
        .map(|(&vertex_group, vertices)| SelectedVertices {
            vertex_group,
            vertices,
        })
        .collect();
    let count = |document: &Document| -> usize {
        let meshes = document.meshes().iter();
        meshes.map(|entry| entry.mesh.face_count()).sum()
    };
    let before = count(&document);
    if document.edit(Edit::select(&faces, &vertices)).is_err() {
        document.edit(Edit::select(&faces, &[]))?;
    }
    println!("{before}\t{}", count(&document));
    document.write(to)?;
    Ok(())
}

fn every_second(entry: &MeshEntry) -> Vec<SelectedFace> {
    let numbered = (0_u32..).zip(entry.mesh.faces()).step_by(2);
    let selected = numbered.map(|(face, &corners)| SelectedFace { face, corners });
    let mut selected: Vec<SelectedFace> = selected.collect();
    if entry.faces_movable {
        selected.reverse();
    }
    selected
}
