//! A GLB of the positions and faces of a document of another format.

use super::options::{CullError, CullOptions};
use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::files::{Document, FileError, Format, NewMesh};
use crate::operations::facets::says_nothing;
use crate::operations::plain_meshes::plain_meshes;

/// A GLB, and what it does not have of its source.
pub(super) struct Created {
    pub(super) document: Document,
    pub(super) lost: Vec<String>,
}

/// Makes a GLB with the names, positions and faces of the meshes.
pub(super) fn created(document: &Document, options: &CullOptions) -> Result<Created, CullError> {
    let file = || document.path().to_owned();
    let unlisted = document.unlisted();
    let mut unread = unlisted.iter().filter(|it| it.has_faces);
    let other = document.meshes().iter().find(|it| it.has_other_faces);
    let unread = unread
        .next()
        .map(|it| &it.what)
        .or(other.map(|it| &it.name));
    if let Some(mesh) = unread {
        let mesh = mesh.clone();
        return Err(CullError::UnreadFaces { file: file(), mesh });
    }

    // What is not a name, a position or a face.
    let mut lost = Vec::new();
    for (number, entry) in document.meshes().iter().enumerate() {
        for info in document.attributes(number) {
            lost.extend(loss(document, number, &info)?);
        }
        let records = 0..entry.record_count();
        if records
            .into_iter()
            .any(|record| entry.faces_of(record).len() > 1)
        {
            lost.push("polygons, which become triangles".to_owned());
        }
        if entry.mesh.face_count() == 0 {
            lost.push(format!("{}, which has no faces", entry.name));
        }
    }
    lost.extend(unlisted.into_iter().map(|it| it.what));
    let mut seen = std::collections::BTreeSet::new();
    lost.retain(|what| seen.insert(what.clone()));
    if !lost.is_empty() && !options.drop_attributes {
        let what = lost;
        return Err(CullError::Lost { file: file(), what });
    }

    // The rest.
    let plain = plain_meshes(document)?;
    let meshes = plain.iter().filter(|it| it.mesh.face_count() > 0);
    let meshes: Vec<NewMesh<'_>> = meshes
        .map(|it| NewMesh::plain(&it.name, it.mesh.positions(), it.mesh.faces()))
        .collect();
    if meshes.is_empty() {
        return Err(CullError::NoFaces { file: file() });
    }
    let name = document.path().with_extension("glb");
    let document = Document::create(Format::Glb, &name, &meshes)?;
    Ok(Created { document, lost })
}

/// What is lost of an attribute, if anything.
fn loss(
    document: &Document,
    mesh: usize,
    info: &AttributeInfo,
) -> Result<Option<String>, FileError> {
    let is_position = info.semantic == Semantic::Position && info.morph_target.is_none();
    use ComponentType::{F64, I32, U32};
    if is_position {
        let is_wide = matches!(info.component_type, F64 | I32 | U32);
        return Ok(is_wide.then(|| "bits of its positions beyond 32-bit floats".to_owned()));
    }
    if says_nothing(document, mesh, info)? {
        return Ok(None);
    }
    let of = match info.domain {
        Domain::Face => " of faces",
        Domain::Corner => " of corners",
        Domain::Vertex => "",
    };
    Ok(Some(format!("{}{of}", info.semantic)))
}
