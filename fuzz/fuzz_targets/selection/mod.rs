//! What has to hold for any document: a part of its faces can be selected, or nothing changes.

use meshweft::Limits;
use meshweft::files::{Document, Edit, MeshEntry, SelectedFace, SelectedFaces, SelectedVertices};

/// Selects every second face of each mesh, some of them with another corner, and the vertices that are
/// used; reads the output again and compares.
///
/// # Panics
/// If something else was left than was asked for, or an error has changed something.
pub(crate) fn check(document: &mut Document) {
    let chosen: Vec<Vec<SelectedFace>> = document.meshes().iter().map(every_second).collect();
    let faces = chosen
        .iter()
        .enumerate()
        .filter(|(_, faces)| !faces.is_empty());
    let faces: Vec<SelectedFaces<'_>> = faces
        .map(|(mesh, faces)| SelectedFaces::new(mesh, faces))
        .collect();

    // The vertices that are used, of each group.
    let groups = document.meshes().iter().map(|entry| entry.vertex_group);
    let mut groups: Vec<usize> = groups.collect();
    groups.sort_unstable();
    groups.dedup();
    let used = groups.iter().map(|&group| {
        let meshes = document.meshes().iter().zip(&chosen);
        let of_group = meshes.filter(|(entry, _)| entry.vertex_group == group);
        let corners = of_group.flat_map(|(_, faces)| faces.iter().flat_map(|face| face.corners));
        let mut used: Vec<u32> = corners.collect();
        used.sort_unstable();
        used.dedup();
        used
    });
    let used: Vec<Vec<u32>> = used.collect();
    let vertices = groups
        .iter()
        .zip(&used)
        .filter(|(_, used)| !used.is_empty());
    let vertices: Vec<SelectedVertices<'_>> = vertices
        .map(|(&vertex_group, vertices)| SelectedVertices {
            vertex_group,
            vertices,
        })
        .collect();

    for vertices in [vertices.as_slice(), &[]] {
        let before = main_bytes(document);
        let done = document.edit(Edit::select(&faces, vertices));
        if done.is_err() {
            assert_eq!(main_bytes(document), before, "an error changes nothing");
            continue;
        }
        for SelectedFaces { mesh, faces, .. } in &faces {
            assert_eq!(document.meshes()[*mesh].mesh.face_count(), faces.len());
        }
        let read = Document::from_bytes(
            main_bytes(document),
            document.format(),
            document.path(),
            Limits::default(),
        );
        let again = read.expect("what is written can be read");
        assert_eq!(document.meshes().len(), again.meshes().len());
        for (now, read) in document.meshes().iter().zip(again.meshes()) {
            assert_eq!(now.mesh.faces(), read.mesh.faces());
            assert_eq!(now.mesh.vertex_count(), read.mesh.vertex_count());
        }
        return;
    }
}

/// Every second face, some with another corner.
fn every_second(entry: &MeshEntry) -> Vec<SelectedFace> {
    let all = entry.mesh.faces();
    let numbered = (0_u32..).zip(all).step_by(2);
    let selected = numbered.map(|(face, &corners)| {
        let mut corners = corners;
        if face % 6 == 2 {
            corners[2] = all[face as usize / 2][0];
        }
        SelectedFace { face, corners }
    });
    selected.collect()
}

fn main_bytes(document: &Document) -> Vec<u8> {
    let bytes = document.to_main_bytes();
    bytes.expect("what was read can be written")
}
