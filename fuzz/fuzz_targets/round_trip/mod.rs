//! What has to hold for any bytes that a text reader accepts: the faces last first within their
//! runs, the vertices last first, read again, are the same triangles, in each mesh. Then some of the
//! faces are selected.

#[path = "../compressed/mod.rs"]
mod compressed;
#[path = "../selection/mod.rs"]
mod selection;

use std::path::Path;

use meshweft::attribute::Domain;
use meshweft::files::{Document, Edit, Format, MeshEntry};
use meshweft::{FaceOrder, Limits, Permutation, VertexOrder};

/// Reads `data`, permutes it, reads the output again and compares.
///
/// # Panics
/// If anything was lost, added or changed.
pub(crate) fn check(data: &[u8], format: Format, name: &str) {
    let path = Path::new(name);
    let limits = Limits::default();
    let read = |bytes: Vec<u8>| Document::from_bytes(bytes, format, path, limits);
    let Ok(mut document) = read(data.to_vec()) else {
        return;
    };
    let unchanged = document.to_main_bytes().expect("a name of the same format");
    assert_eq!(unchanged, data, "a file is written as it was read");
    compressed::check(&document);
    let mut before = Vec::new();
    for mesh in 0..document.meshes().len() {
        let entry = &document.meshes()[mesh];
        before.push(triangles(entry, false));
        check_attributes(&document, mesh);
        let faces = last_first_within_runs(entry);
        let vertices = entry
            .vertices_movable
            .then(|| last_first(entry.mesh.vertex_count()));
        document
            .edit(Edit::order(mesh, &faces, vertices.as_ref()))
            .expect("an order that the entry allows");
    }
    let output = document.to_main_bytes().expect("a name of the same format");
    let again = read(output).expect("what is written can be read");
    assert_eq!(document.meshes().len(), again.meshes().len());
    for ((before, entry), now) in before.iter().zip(again.meshes()).zip(document.meshes()) {
        // What was moved may stay from now on, where it could be read in two ways.
        let after = triangles(entry, now.vertices_movable);
        assert_eq!(*before, after, "the triangles by their old vertex numbers");
        assert_eq!(now.mesh.faces(), entry.mesh.faces());
    }
    selection::check(&mut document);
}

/// Every attribute can be read, or says why not; how many elements it has is known.
fn check_attributes(document: &Document, mesh: usize) {
    let entry = &document.meshes()[mesh];
    for info in document.attributes(mesh) {
        let count = match info.domain {
            Domain::Vertex => entry.mesh.vertex_count(),
            Domain::Corner => 3 * entry.mesh.face_count(),
            _ => entry.mesh.face_count(),
        };
        if let Ok(attribute) = document.attribute(mesh, &info) {
            assert_eq!(attribute.len(), count, "{info:?}");
        }
    }
}

fn last_first(vertex_count: usize) -> VertexOrder {
    let count = u32::try_from(vertex_count).expect("vertices are counted in 32 bits");
    let order = Permutation::new((0..count).rev().collect());
    order.expect("each number once").into()
}

fn last_first_within_runs(entry: &MeshEntry) -> FaceOrder {
    let count = u32::try_from(entry.record_count()).expect("records are counted in 32 bits");
    let ends = entry.runs.iter().skip(1).copied().chain([count]);
    let runs = entry.runs.iter().zip(ends);
    let order = match entry.faces_movable {
        true => runs.flat_map(|(&start, end)| (start..end).rev()).collect(),
        false => (0..count).collect(),
    };
    Permutation::new(order).expect("each number once").into()
}

/// The triangles, sorted, by the numbers their vertices had before.
fn triangles(entry: &MeshEntry, is_reversed: bool) -> Vec<[usize; 3]> {
    let old_of = |vertex: u32| match is_reversed {
        true => entry.mesh.vertex_count() - 1 - vertex as usize,
        false => vertex as usize,
    };
    let faces = entry.mesh.faces().iter();
    let mut triangles: Vec<[usize; 3]> = faces.map(|face| face.map(old_of)).collect();
    triangles.sort_unstable();
    triangles
}
