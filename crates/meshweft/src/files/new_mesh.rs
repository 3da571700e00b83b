//! Meshes that a file does not have yet.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::error::{FileErrorKind, Place, Problem};
use super::format::Format;
use crate::attribute::{Attribute, ComponentType, Domain, Semantic};
use crate::faces::Faces;

/// A mesh to be added to a document, or to make one of: see
/// [`Document::create`](super::Document::create).
///
/// What new files hold:
///
/// | format | meshes | what is stored |
/// |---|---|---|
/// | GLB; `.gltf` with its buffer in the text | any number, each drawn by a node | all attributes of vertices that glTF allows; positions are finite |
/// | OBJ | any number, each an `o` with its vertices and faces | 32-bit positions, finite |
/// | PLY, binary | one; its name in a comment | attributes of vertices and faces, texture coordinates of corners; floats bit for bit |
/// | OFF | one, without its name | 32-bit positions, finite |
/// | STL, binary | one; its name in the header | 32-bit positions of the corners, bit for bit, and normals |
///
/// - Text has the shortest digits that read back as the same float.
/// - A name is kept on its line: control characters become `_`, and in an OBJ `#` and a `\` at the end.
///   Unnamed meshes of several in an OBJ are called `mesh_0` and so on, by their number.
/// - STL stores no vertices. Corners with the same bits are one vertex to a reader, those that no face
///   names are lost, and vertices get other numbers. A face without an area has the normal 0 0 0.
/// - A glTF has no meshes without faces. Of one without vertices its node is left; one of vertices alone
///   is refused. The other formats take such meshes, and OBJ and glTF no mesh at all.
///
/// ```
/// use meshweft::attribute::{Attribute, Semantic};
/// use meshweft::files::{Document, Format, NewMesh, NewVertices};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let attributes = [
///     Attribute::of_vertices(Semantic::Position, &corners),
///     Attribute::of_vertices(Semantic::Normal, &[[0.0, 0.0, 1.0]; 3]),
/// ];
/// let vertices = NewVertices::Stored(&attributes);
/// let triangle = NewMesh::new("triangle", vertices, &[[0, 1, 2]]);
/// let document = Document::create(Format::Glb, "triangle.glb".as_ref(), &[triangle])?;
/// assert_eq!(document.attributes(0).len(), 2);
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct NewMesh<'a> {
    /// What it is called; empty if it has no name.
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

    /// A mesh of which nothing is known but the position of each vertex and the faces.
    #[must_use]
    pub fn plain(name: &'a str, positions: &'a [[f32; 3]], faces: &'a [[u32; 3]]) -> Self {
        Self::new(name, NewVertices::Positions(positions), faces)
    }

    /// The place of what is wrong with the mesh of this number.
    pub(super) fn place(&self, number: usize) -> Place {
        Place::NewMesh {
            number,
            name: self.name.to_owned(),
        }
    }
}

/// The mesh of a file that holds one.
///
/// # Errors
/// There are none, or several.
pub(super) fn only<'a, 'b>(
    meshes: &'b [NewMesh<'a>],
    format: Format,
) -> Result<&'b NewMesh<'a>, Problem> {
    let [mesh] = meshes else {
        let text = format!(
            "{format} files hold one mesh, not {}: create a .glb or an .obj",
            meshes.len()
        );
        return Err(FileErrorKind::unsupported(text).at(Place::File));
    };
    Ok(mesh)
}

/// A name in one line of text: line ends and other control characters become `_`.
pub(super) fn in_one_line(name: &str) -> String {
    let breaks = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    name.replace(breaks, "_")
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
    /// Their positions, and nothing else. The new mesh is drawn at the root of the scene.
    Positions(&'a [[f32; 3]]),
}

impl<'a> NewVertices<'a> {
    /// What is stored with them; or the number of the mesh that has them.
    pub(super) fn attributes(self) -> Result<Cow<'a, [Attribute]>, usize> {
        match self {
            Self::Shared(mesh) => Err(mesh),
            Self::Stored(attributes) => Ok(attributes.into()),
            Self::Positions(positions) => {
                let attribute = Attribute::of_vertices(Semantic::Position, positions);
                Ok(vec![attribute].into())
            }
        }
    }
}

/// The error for vertices of a mesh in a file that has none yet.
pub(super) fn nothing_to_share(_mesh: usize) -> FileErrorKind {
    let text = "a new file has no vertices that could be shared: give their attributes";
    FileErrorKind::unsupported(text)
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
