//! Meshes that a file does not have yet.

use std::collections::BTreeSet;

use super::error::FileErrorKind;
use crate::attribute::{Attribute, ComponentType, Domain, Semantic};
use crate::faces::Faces;

/// A mesh to be added to a document, or to make one of: see
/// [`Document::create`](super::Document::create).
#[derive(Debug, Clone, Copy)]
pub struct NewMesh<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Its vertices.
    pub vertices: NewVertices<'a>,
    /// The three vertices of each face.
    pub faces: &'a [[u32; 3]],
}

impl<'a> NewMesh<'a> {
    /// A mesh of these; they are checked where it is used.
    #[must_use]
    pub fn new(name: &'a str, vertices: NewVertices<'a>, faces: &'a [[u32; 3]]) -> Self {
        Self {
            name,
            vertices,
            faces,
        }
    }
}

/// The vertices of a [`NewMesh`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum NewVertices<'a> {
    /// Those of this mesh of the document, with all that is stored with them and with its material;
    /// nothing is copied. The new mesh is drawn where that one is: at the first node that draws it.
    ///
    /// If that mesh has no indices, its faces can be ordered no more: they are its vertices, which the
    /// new mesh numbers. It is left out of [`Document::meshes`](super::Document::meshes) from then on,
    /// with a note.
    Shared(usize),
    /// What is stored with them: one attribute is the position. The new mesh is drawn at the root of
    /// the scene.
    Stored(&'a [Attribute]),
}

/// How many vertices these attributes describe.
///
/// # Errors
/// One does not fit: there is no position, or none of three floats, the lengths differ, or two are the
/// same.
pub(super) fn vertex_count(
    attributes: &[Attribute],
    faces: &[[u32; 3]],
) -> Result<usize, FileErrorKind> {
    let refused = |text: String| Err(FileErrorKind::unsupported(text));
    let is_position = |attribute: &&Attribute| {
        let info = &attribute.info;
        info.semantic == Semantic::Position
            && info.morph_target.is_none()
            && info.domain == Domain::Vertex
    };
    let Some(position) = attributes.iter().find(is_position) else {
        return refused("a new mesh needs the attribute POSITION, one element a vertex".into());
    };
    let is_float = matches!(
        position.info.component_type,
        ComponentType::F32 | ComponentType::F64
    );
    if position.info.components != 3 || !is_float {
        return refused("POSITION must have three components, 32-bit or 64-bit floats".into());
    }

    let mut seen = BTreeSet::new();
    for Attribute { info, .. } in attributes {
        if !seen.insert((&info.semantic, info.morph_target, info.domain)) {
            return refused(format!(
                "two attributes are {}: leave one out",
                info.semantic
            ));
        }
    }
    for attribute in attributes {
        let expected = match attribute.info.domain {
            Domain::Vertex => position.len(),
            Domain::Corner => 3 * faces.len(),
            Domain::Face => faces.len(),
        };
        if attribute.len() != expected {
            return refused(format!(
                "{} has {} elements, but the mesh needs {expected}: one for each {}",
                attribute.info.semantic,
                attribute.len(),
                match attribute.info.domain {
                    Domain::Vertex => "vertex",
                    Domain::Corner => "corner",
                    Domain::Face => "face",
                }
            ));
        }
    }
    Faces::new(faces, position.len()).map_err(FileErrorKind::Order)?;
    Ok(position.len())
}
