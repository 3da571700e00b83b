//! What can be done to a document.

use super::entry::MeshEntry;
use super::error::FileErrorKind;
use super::new_mesh::NewMesh;
use crate::error::MeshError;
use crate::permutation::{FaceOrder, VertexOrder};

/// A change to a document, for [`Document::edit`](super::Document::edit).
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Edit<'a> {
    /// Face records and vertices change places; every other byte stays.
    Order {
        /// The number of the mesh.
        mesh: usize,
        /// An order of its face records, as they are now.
        faces: Option<&'a FaceOrder>,
        /// An order of its vertices, as they are now. It renumbers every mesh of the same
        /// [`vertex_group`](MeshEntry::vertex_group).
        vertices: Option<&'a VertexOrder>,
    },
    /// Meshes, and anything else, are added to a glTF or GLB. Whatever was there keeps its bytes and
    /// its number: new bytes go to the end of a buffer, new elements to the ends of arrays, new members
    /// to the ends of objects. Only that buffer's `byteLength` has another value.
    ///
    /// Afterwards the document is what a reader of the written file sees: the new meshes are at the end
    /// of [`Document::meshes`](super::Document::meshes).
    Append {
        /// Meshes, each drawn by a new node: see [`NewVertices`](super::NewVertices).
        meshes: &'a [NewMesh<'a>],
        /// Values in the JSON, in this order.
        values: &'a [NewValue<'a>],
    },
}

impl<'a> Edit<'a> {
    /// [`Order`](Self::Order) of the faces of a mesh, of its vertices, or of both.
    #[must_use]
    pub fn order(
        mesh: usize,
        faces: impl Into<Option<&'a FaceOrder>>,
        vertices: impl Into<Option<&'a VertexOrder>>,
    ) -> Self {
        let (faces, vertices) = (faces.into(), vertices.into());
        Self::Order {
            mesh,
            faces,
            vertices,
        }
    }

    /// [`Append`](Self::Append) of meshes alone.
    #[must_use]
    pub fn append(meshes: &'a [NewMesh<'a>]) -> Self {
        let values = &[];
        Self::Append { meshes, values }
    }
}

/// A value to be added to the JSON of a glTF, such as an extension of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewValue<'a> {
    /// Where it goes, as a JSON pointer (RFC 6901) to what is not there yet. A last part `-` is the
    /// end of an array. Objects and arrays on the way are made if they are not there:
    /// `/nodes/3/extensions/MSFT_lod`, `/extensionsUsed/-`. What a buffer holds comes with meshes only:
    /// neither a buffer is added as a value, nor a `uri` or `byteLength` of one.
    pub pointer: &'a str,
    /// The value, as JSON text.
    pub json: &'a str,
}

/// Whether a mesh can take these orders.
pub(super) fn check_order(
    entry: &MeshEntry,
    faces: Option<&FaceOrder>,
    vertices: Option<&VertexOrder>,
) -> Result<(), FileErrorKind> {
    let length = |what, expected, found| match expected == found {
        true => Ok(()),
        false => Err(FileErrorKind::Order(MeshError::LengthMismatch {
            what,
            expected,
            found,
        })),
    };
    let unsupported = |text: &str| {
        Err(FileErrorKind::unsupported(format!(
            "mesh {:?}: {text}",
            entry.name
        )))
    };

    if let Some(faces) = faces {
        length("face order", entry.record_count(), faces.len())?;
        if !entry.keeps_runs(faces) {
            return unsupported("the order moves a face out of its run (group, material, …)");
        }
        if !entry.faces_movable && !faces.is_identity() {
            return unsupported("its faces must stay in their order");
        }
        let turns = faces.rotations().iter().any(|&r| r != 0);
        if turns && (!entry.corners_turnable || entry.polygons.is_some()) {
            return unsupported("the order turns corners that must stay");
        }
    }

    if let Some(vertices) = vertices {
        length("vertex order", entry.mesh.vertex_count(), vertices.len())?;
        if !entry.vertices_movable && !vertices.is_identity() {
            return unsupported("its vertices must stay where they are");
        }
    }
    Ok(())
}
