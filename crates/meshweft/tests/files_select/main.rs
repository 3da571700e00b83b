//! Faces and vertices are left out of files: what stays keeps its bytes and its meaning.
#![cfg(feature = "files")]
#![expect(clippy::cast_possible_truncation, reason = "test meshes are small")]

#[path = "../files_gltf/builder.rs"]
mod builder;
mod choice;
#[path = "../data/folder.rs"]
mod data;
mod edges;
mod gltf;
mod gltf_edges;
mod obj;
#[path = "../files_random/mod.rs"]
mod random;
mod real;
mod records;
#[path = "../../../../fuzz/fuzz_targets/selection/mod.rs"]
mod selection;
#[path = "../files_text/simple.rs"]
mod simple;
#[path = "../files_text/simple_stl.rs"]
mod simple_stl;

use std::path::Path;

use choice::Choice;
use meshweft::Limits;
use meshweft::attribute::Domain;
use meshweft::files::{Document, Edit, FileError, Format, SelectedFaces, SelectedVertices};

pub(crate) fn name_of(format: Format) -> &'static Path {
    Path::new(match format {
        Format::Obj => "mesh.obj",
        Format::Ply => "mesh.ply",
        Format::Stl => "mesh.stl",
        Format::Glb => "mesh.glb",
        Format::Gltf => "mesh.gltf",
        _ => "mesh.off",
    })
}

pub(crate) fn open(bytes: &[u8], format: Format) -> Document {
    let limits = Limits::default();
    Document::from_bytes(bytes.to_vec(), format, name_of(format), limits).unwrap()
}

pub(crate) fn written(document: &Document) -> Vec<u8> {
    document.to_main_bytes().unwrap()
}

/// Selects these of the meshes with these numbers, each of a vertex group of its own.
pub(crate) fn select(
    document: &mut Document,
    choices: &[(usize, Choice)],
) -> Result<(), FileError> {
    let faces: Vec<SelectedFaces<'_>> = choices
        .iter()
        .map(|(mesh, choice)| SelectedFaces::new(*mesh, &choice.faces))
        .collect();
    let vertices: Vec<SelectedVertices<'_>> = choices
        .iter()
        .filter_map(|(mesh, choice)| {
            Some(SelectedVertices {
                vertex_group: document.meshes()[*mesh].vertex_group,
                vertices: choice.vertices.as_ref()?,
            })
        })
        .collect();
    document.edit(Edit::select(&faces, &vertices))
}

/// The values of all attributes of a mesh, as bits.
pub(crate) type Bits = Vec<(Domain, usize, Option<Vec<u32>>)>;

pub(crate) fn attributes(document: &Document, mesh: usize) -> Bits {
    let infos = document.attributes(mesh).into_iter();
    let read = infos.map(|info| {
        let numbers = document.attribute(mesh, &info).ok();
        let bits = numbers.map(|a| a.to_f32().into_iter().map(f32::to_bits).collect());
        (info.domain, info.components, bits)
    });
    read.collect()
}

/// Asserts that `after`, which was selected of `before`, is what was asked for; `has_vertices` says whether
/// the file stores vertices, and not corners only.
pub(crate) fn assert_selected(
    before: &Document,
    after: &Document,
    mesh: usize,
    choice: &Choice,
    has_vertices: bool,
) {
    let (old, new) = (&before.meshes()[mesh].mesh, &after.meshes()[mesh].mesh);
    assert_eq!(new.face_count(), choice.faces.len());

    // The old vertex of each new one.
    let all: Vec<u32> = (0..old.vertex_count() as u32).collect();
    let kept = choice.vertices.as_ref().unwrap_or(&all);
    if has_vertices {
        assert_eq!(new.vertex_count(), kept.len());
        for (face, selected) in new.faces().iter().zip(&choice.faces) {
            assert_eq!(face.map(|v| kept[v as usize]), selected.corners);
        }
    }

    let (of_old, of_new) = (attributes(before, mesh), attributes(after, mesh));
    for ((domain, components, values), (_, _, found)) in of_old.iter().zip(&of_new) {
        let (Some(values), Some(found)) = (values, found) else {
            continue;
        };
        let old_of = |element: usize| &values[element * components..][..*components];
        let new_of = |element: usize| &found[element * components..][..*components];
        match domain {
            Domain::Vertex if has_vertices => {
                for (vertex, &old) in kept.iter().enumerate() {
                    assert_eq!(new_of(vertex), old_of(old as usize));
                }
            }
            // Vertices of corners have other numbers.
            Domain::Vertex => {
                for (face, selected) in new.faces().iter().zip(&choice.faces) {
                    for (new, old) in face.iter().zip(selected.corners) {
                        assert_eq!(new_of(*new as usize), old_of(old as usize));
                    }
                }
            }
            Domain::Face => {
                for (face, selected) in choice.faces.iter().enumerate() {
                    let old_face = selected.face as usize;
                    if has_vertices || same_corners(selected.corners, old.faces()[old_face]) {
                        assert_eq!(new_of(face), old_of(old_face));
                    }
                }
            }
            _ => assert_corners(old.faces(), choice, old_of, new_of),
        }
    }
}

fn same_corners(a: [u32; 3], b: [u32; 3]) -> bool {
    (0..3).any(|turn| [0, 1, 2].map(|i| a[(i + turn) % 3]) == b)
}

/// Asserts that each corner has what one of the file's corners at its vertex had: its own if its vertex is
/// still the same.
fn assert_corners<'a>(
    old: &[[u32; 3]],
    choice: &Choice,
    old_of: impl Fn(usize) -> &'a [u32],
    new_of: impl Fn(usize) -> &'a [u32],
) {
    for (face, selected) in choice.faces.iter().enumerate() {
        let of_face = old[selected.face as usize];
        for (corner, &vertex) in selected.corners.iter().enumerate() {
            let found = new_of(3 * face + corner);
            if of_face[corner] == vertex {
                assert_eq!(found, old_of(3 * selected.face as usize + corner));
                continue;
            }
            let at_vertex = old.as_flattened().iter().enumerate();
            let mut at_vertex = at_vertex.filter(|&(_, &other)| other == vertex);
            assert!(at_vertex.any(|(corner, _)| old_of(corner) == found));
        }
    }
}

/// Asserts that a reader of the written file sees the document as it is.
pub(crate) fn assert_read_again(document: &Document) {
    let bytes = written(document);
    let again = open(&bytes, document.format());
    assert_eq!(document.meshes().len(), again.meshes().len());
    for (mesh, (now, read)) in document.meshes().iter().zip(again.meshes()).enumerate() {
        assert_eq!(now.mesh.faces(), read.mesh.faces());
        assert_eq!(now.mesh.vertex_count(), read.mesh.vertex_count());
        assert_eq!(now.polygons, read.polygons);
        assert_eq!(now.vertex_group, read.vertex_group);
        assert_eq!(document.attributes(mesh), again.attributes(mesh));
        assert!(attributes(document, mesh) == attributes(&again, mesh));
    }
    assert!(written(&again) == bytes);
}

/// Selects, checks what is there then, and what a reader sees.
pub(crate) fn check(document: &mut Document, mesh: usize, choice: &Choice, has_vertices: bool) {
    let before = open(&written(document), document.format());
    select(document, &[(mesh, choice.clone())]).unwrap();
    assert_selected(&before, document, mesh, choice, has_vertices);
    assert_read_again(document);
}

/// What is wrong with a selection; nothing has changed then.
pub(crate) fn error(document: &mut Document, choices: &[(usize, Choice)]) -> String {
    let before = written(document);
    let meshes = document.meshes().to_vec();
    let error = select(document, choices).unwrap_err().to_string();
    assert!(written(document) == before);
    assert_eq!(document.meshes(), meshes);
    error
}
