//! Meshes that a file does not have yet.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Range;

use super::error::{FileErrorKind, Place, Problem};
use super::format::Format;
use crate::attribute::{Attribute, ComponentType, Domain, Semantic};
use crate::faces::Faces;
use crate::index::index32;

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
/// - OBJ, PLY and OFF keep [polygons](Self::polygons), the others their triangles.
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
    /// Where the faces of each polygon start, and where the last ones end, or `None` where each is one triangle. The faces
    /// of a polygon are a fan around its first corner: (0, 1, 2), (0, 2, 3) …
    pub polygons: Option<&'a [u32]>,
}

impl<'a> NewMesh<'a> {
    /// A mesh of these; they are checked where it is used.
    #[must_use]
    pub fn new(name: &'a str, vertices: NewVertices<'a>, faces: &'a [[u32; 3]]) -> Self {
        Self {
            name,
            vertices,
            faces,
            polygons: None,
        }
    }

    /// The same mesh, its faces cut from these [`polygons`](Self::polygons).
    #[must_use]
    pub fn with_polygons(self, starts: &'a [u32]) -> Self {
        Self {
            polygons: Some(starts),
            ..self
        }
    }

    /// The corners of each polygon, one after the other: see [`polygons`](Self::polygons).
    ///
    /// # Errors
    /// The polygons are not all the faces, or one of them is not a fan.
    pub(super) fn checked_polygons(&self) -> Result<PolygonCorners<'a>, FileErrorKind> {
        PolygonCorners::new(self.faces, self.polygons)
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

/// The corners of the polygons of a new mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct PolygonCorners<'a> {
    faces: &'a [[u32; 3]],
    starts: Option<&'a [u32]>,
}

impl<'a> PolygonCorners<'a> {
    fn new(faces: &'a [[u32; 3]], starts: Option<&'a [u32]>) -> Result<Self, FileErrorKind> {
        let polygons = Self { faces, starts };
        let Some(starts) = starts else {
            return Ok(polygons);
        };
        let ends = starts.first().zip(starts.last());
        let rises = starts.windows(2).all(|ends| ends[0] < ends[1]);
        if ends != Some((&0, &index32(faces.len()))) || !rises {
            return Err(FileErrorKind::unsupported(
                "polygons must start at 0, rise, and end at the number of faces",
            ));
        }
        let is_fan = |polygon: usize| {
            let fan = &faces[polygons.faces_of(polygon)];
            let follows = |pair: &[[u32; 3]]| [pair[1][0], pair[1][1]] == [pair[0][0], pair[0][2]];
            fan.windows(2).all(follows)
        };
        match (0..polygons.len()).find(|&polygon| !is_fan(polygon)) {
            None => Ok(polygons),
            Some(polygon) => Err(FileErrorKind::unsupported(format!(
                "the faces of polygon {polygon} are not a fan around its first corner: (0, 1, 2), (0, 2, 3) …"
            ))),
        }
    }

    /// How many there are.
    pub(super) fn len(self) -> usize {
        match self.starts {
            Some(starts) => starts.len() - 1,
            None => self.faces.len(),
        }
    }

    fn faces_of(self, polygon: usize) -> Range<usize> {
        match self.starts {
            Some(starts) => starts[polygon] as usize..starts[polygon + 1] as usize,
            None => polygon..polygon + 1,
        }
    }

    /// How many corners a polygon has.
    pub(super) fn count(self, polygon: usize) -> usize {
        self.faces_of(polygon).len() + 2
    }

    /// The vertices at the corners of a polygon.
    pub(super) fn of(self, polygon: usize) -> impl Iterator<Item = u32> {
        let fan = &self.faces[self.faces_of(polygon)];
        let [a, b, _] = fan[0];
        [a, b].into_iter().chain(fan.iter().map(|face| face[2]))
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
