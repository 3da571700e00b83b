//! Any bytes as a GLB and as the JSON of a glTF: an error, or a scene whose faces and vertices can
//! be reversed without losing a triangle, of which some can be selected, and to which meshes can be added,
//! or nothing changes.
#![no_main]

mod compressed;
mod selection;

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use meshweft::attribute::{Attribute, Semantic};
use meshweft::culling::{CullingTable, Eye, Ranges};
use meshweft::files::{Document, Edit, Format, MeshEntry, NewMesh, NewVertices, ReadOptions};
use meshweft::{FaceOrder, Limits, Permutation, VertexOrder};

/// A new mesh of one face.
const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fuzz_target!(|data: &[u8]| {
    check(data, Format::Glb, Path::new("no such folder/scene.glb"));
    check(data, Format::Gltf, Path::new("no such folder/scene.gltf"));
});

fn check(data: &[u8], format: Format, path: &Path) {
    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    if let Ok(mut document) = Document::from_bytes(data.to_vec(), format, path, &options) {
        assert_same(&document, &written(&document));
        reverse(&mut document);
        assert_same(&document, &written(&document));
    }

    let read = Document::from_bytes(data.to_vec(), format, path, Limits::default());
    let Ok(mut document) = read else {
        return;
    };
    assert_eq!(main_bytes(&document), data);
    compressed::check(&document);
    reverse(&mut document);
    assert_same(&document, &written(&document));
    if let Ok(mut document) = Document::from_bytes(data.to_vec(), format, path, Limits::default()) {
        reverse(&mut document);
        selection::check(&mut document);
        assert_same(&document, &written(&document));
    }
    if append(&mut document) {
        assert_same(&document, &written(&document));
        reverse(&mut document);
        assert_same(&document, &written(&document));
    }
}

/// What a reader sees of the document when it is written.
fn written(document: &Document) -> Document {
    let bytes = main_bytes(document);
    let read = Document::from_bytes(bytes, document.format(), document.path(), Limits::default());
    read.expect("what was written can be read")
}

/// Reverses the faces and vertices of all meshes.
fn reverse(document: &mut Document) {
    for mesh in 0..document.meshes().len() {
        let before = triangles(document, mesh);
        check_attributes(document, mesh);
        check_table(document, mesh);
        let entry = &document.meshes()[mesh];
        let faces = reversed_in_runs(entry);
        let faces = entry.faces_movable.then_some(faces);
        let vertices = entry
            .vertices_movable
            .then(|| VertexOrder::from(reversed(entry.mesh.vertex_count())));
        document
            .edit(Edit::order(mesh, faces.as_ref(), vertices.as_ref()))
            .expect("the orders have the right lengths");
        assert_eq!(before, triangles(document, mesh));
    }
}

/// The faces of each run, such as the clusters of a culling table, the last first.
fn reversed_in_runs(entry: &MeshEntry) -> FaceOrder {
    let end = u32::try_from(entry.record_count()).expect("records have 32-bit numbers");
    let ends = entry.runs.iter().copied().skip(1).chain([end]);
    let runs = entry.runs.iter().zip(ends);
    let order: Vec<u32> = runs.flat_map(|(&start, end)| (start..end).rev()).collect();
    Permutation::new(order)
        .expect("every record comes once")
        .into()
}

/// Whatever table a mesh has, looking at it does no harm.
fn check_table(document: &Document, mesh: usize) {
    let Some(table) = document.culling(mesh) else {
        return;
    };
    assert_eq!(table.starts.len(), document.meshes()[mesh].runs.len() + 1);
    let table = CullingTable::from_parts(table.center, table.reach, table.starts, &table.planes);
    if let Ok(table) = table {
        let mut ranges = Ranges::default();
        for eye in [Eye::at([1.0, 2.0, 3.0]), Eye::towards([-1e-30, 1e30, 0.0])] {
            let drawn = table.visible_ranges(eye, &mut ranges).face_count();
            assert!(drawn <= document.meshes()[mesh].mesh.face_count());
        }
    }
}

/// Adds the faces of the first mesh once more, and a triangle; whether that was possible.
fn append(document: &mut Document) -> bool {
    let Some(first) = document.meshes().first() else {
        return false;
    };
    let faces = first.mesh.faces().to_vec();
    let before = (triangles(document, 0), main_bytes(document));
    let attributes = [Attribute::of_vertices(Semantic::Position, &CORNERS)];
    let meshes = [
        NewMesh::new("shared", NewVertices::Shared(0), &faces),
        NewMesh::new("triangle", NewVertices::Stored(&attributes), &[[0, 1, 2]]),
    ];
    if document.edit(Edit::append(&meshes)).is_err() {
        assert_eq!(main_bytes(document), before.1, "an error changes nothing");
        return false;
    }

    let last = document.meshes().len().checked_sub(2);
    match last.filter(|&last| document.meshes()[last].name == "shared") {
        Some(shared) => {
            assert_eq!(triangles(document, shared), before.0);
            let corners = document.positions(shared + 1);
            assert_eq!(corners.ok().flatten().as_deref(), Some(&CORNERS[..]));
        }
        None => assert!(!document.notes().is_empty(), "what stays is told"),
    }
    true
}

fn main_bytes(document: &Document) -> Vec<u8> {
    let bytes = document.to_main_bytes();
    bytes.expect("what was read can be written")
}

fn assert_same(document: &Document, again: &Document) {
    assert_eq!(document.meshes().len(), again.meshes().len());
    for (mesh, (written, read)) in document.meshes().iter().zip(again.meshes()).enumerate() {
        // Positions may be NaN, which differs from itself.
        assert_eq!(written.mesh.faces(), read.mesh.faces());
        assert_eq!(triangles(document, mesh), triangles(again, mesh));
    }
}

/// What each triangle's corners hold, whatever the order of faces, corners and vertices.
///
/// Where the file gives no positions only the number of triangles can be told.
fn triangles(document: &Document, mesh: usize) -> Vec<[[u32; 3]; 3]> {
    let positions = document.positions(mesh).ok().flatten().unwrap_or_default();
    let corner = |vertex: u32| {
        let position = positions.get(vertex as usize);
        position.map_or([0; 3], |position| position.map(f32::to_bits))
    };
    let faces = document.meshes()[mesh].mesh.faces().iter();
    let turned = |face: &[u32; 3]| {
        let [a, b, c] = face.map(corner);
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        turns.into_iter().min().unwrap_or_default()
    };
    let mut triangles: Vec<[[u32; 3]; 3]> = faces.map(turned).collect();
    triangles.sort_unstable();
    triangles
}

/// Every attribute can be read, or says why not; how many elements it has is known.
fn check_attributes(document: &Document, mesh: usize) {
    let mesh_entry = &document.meshes()[mesh].mesh;
    for info in document.attributes(mesh) {
        if let Ok(attribute) = document.attribute(mesh, &info) {
            assert_eq!(attribute.len(), mesh_entry.vertex_count(), "{info:?}");
        }
    }
}

fn reversed(len: usize) -> Permutation {
    let len = u32::try_from(len).expect("counts are checked when a mesh is read");
    Permutation::new((0..len).rev().collect()).expect("each number once")
}
