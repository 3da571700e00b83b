//! What can be done to a document.

use super::entry::MeshEntry;
use super::error::FileErrorKind;
use super::new_levels::NewLevels;
use super::new_mesh::NewMesh;
use super::select::{SelectedFaces, SelectedVertices};
use super::stored_culling::StoredCulling;
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
    /// Faces and vertices are left out, and the rest is put in an order: every vertex of the result is a
    /// vertex of the source with all that is stored with it, and every face a face of the source whose
    /// corners may have moved to other vertices. What a simplified mesh is, where no vertex is invented.
    ///
    /// Counts follow, and what is derived of them (offsets, lengths, smallest and largest values). What
    /// leaves takes its bytes with it unless something else names them. Every other byte stays: comments,
    /// other elements and meshes, materials, images, extensions that are not known.
    ///
    /// - A mesh of which no faces are selected keeps all of them, and a vertex group of which no vertices
    ///   are selected all of those. Vertices are selected by group and not by mesh, because the meshes of
    ///   a group have the same ones: one list says which stay, for all, and the vertices that any of these
    ///   meshes uses then must be among them.
    /// - A polygon stays one, drawn where the first of its faces is, if all its faces are selected with
    ///   their corners. Else it is cut into its faces, each with all that was stored with the polygon. A
    ///   record without faces (of fewer than three corners) leaves with the first vertex that leaves.
    /// - What is stored with a face stays with it. What is stored with a corner follows the corner; one
    ///   that moves to another vertex takes what the other corners at that vertex have, of its side of a
    ///   seam if they differ, and where this cannot be told it is an error: then say which corner it is
    ///   ([`SelectedFaces::corner_sources`]).
    /// - STL files, and meshes of a glTF without indices, store no vertices but corners. Theirs are copies
    ///   of what the vertex has in the source, which vertices stay follows from the faces, and a facet of
    ///   an STL file that has changed gets the normal of its corners.
    ///
    /// Afterwards the document is what a reader of the written file sees; the meshes keep their numbers. A
    /// selection of everything as it is changes nothing.
    Select {
        /// Faces, each mesh at most once.
        faces: &'a [SelectedFaces<'a>],
        /// Vertices, each vertex group at most once.
        vertices: &'a [SelectedVertices<'a>],
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
    /// Meshes of a glTF or GLB get culling tables, added as by [`Append`](Self::Append). From then on
    /// faces stay in their clusters, which are [`runs`](MeshEntry::runs), and none of these meshes can lose faces.
    Cull {
        /// The number of each mesh, which has none yet, and a table of its faces as they are now.
        tables: &'a [(usize, &'a StoredCulling)],
    },
    /// Meshes of a glTF or GLB get levels of detail, added as by [`Append`](Self::Append): an index list and a mesh for each
    /// level, and nodes that stand in for those that draw the mesh (the extension `MSFT_lod`). Every reader that does not know
    /// the extension shows what it showed before.
    ///
    /// What is below a node that is stood in for is copied with it as far as it draws something, and animations move copies
    /// alike. A primitive that gets no levels is as it is in all levels of its glTF mesh. The levels of a primitive without an index
    /// list have [copies](NewLevels::copies) of its vertices.
    Levels {
        /// The levels of each mesh.
        meshes: &'a [NewLevels],
    },
    /// The buffers of a glTF or GLB are laid out for a client that reads them from the start and shows what it has:
    /// geometry first, coarse to fine, images last. Whole buffer views change places; what is in them stays.
    ///
    /// A buffer then has, by the first thing that reads each of its views:
    /// 1. for the first picture, in which each mesh is as coarse as it gets: the index lists of meshes with levels of
    ///    detail, all of meshes without, the matrices of joints and instances, and the vertices of meshes with levels (the
    ///    first picture needs the beginning of each);
    /// 2. for each finer level the index lists that it adds, and vertices if it has vertices of its own; level 0 last;
    /// 3. what other known things read (animations, culling tables), what nothing known reads, and images.
    ///
    /// Where nothing else decides, views keep their order. Views that share bytes stay as they are to each other.
    /// Each keeps its place modulo 4, or modulo 8 if it was a multiple of 8. Bytes that are in no view go to the end,
    /// but for up to seven zeros between two views. In the JSON, the `byteOffset` of views is another number; a view without
    /// one gets one unless it stands at 0. A buffer keeps its `byteLength`, unless what fills up between views does not fit.
    ///
    /// Nothing is changed if each buffer is laid out like that; so nothing is, the second time.
    ///
    /// It is an error ([`FileErrorKind::Unsupported`](super::FileErrorKind)) if a buffer that would change
    /// may not (other files read it, it is beside a GLB, or is named twice), or if anything else than buffer views may name bytes of
    /// it, as an extension of views that is not known.
    StreamLayout,
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

    /// [`Select`](Self::Select) of faces and vertices.
    ///
    /// ```
    /// use meshweft::Limits;
    /// use meshweft::files::{Document, Edit, Format, SelectedFace, SelectedFaces, SelectedVertices};
    ///
    /// // Two faces; vertex 3 collapses onto vertex 2, and the second face with it.
    /// let text = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n";
    /// let (name, limits) = ("two.off".as_ref(), Limits::default());
    /// let mut document = Document::from_bytes(text.into(), Format::Off, name, limits)?;
    /// let faces = [SelectedFace { face: 0, corners: [0, 1, 2] }];
    /// let faces = [SelectedFaces::new(0, &faces)];
    /// let vertices = [SelectedVertices { vertex_group: 0, vertices: &[0, 1, 2] }];
    /// document.edit(Edit::select(&faces, &vertices))?;
    /// assert_eq!(document.to_main_bytes()?, b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    /// # Ok::<(), meshweft::files::FileError>(())
    /// ```
    ///
    /// # Complexity
    /// Time O(bytes of the file + n log n) in faces and vertices, space as reading it takes.
    #[must_use]
    pub fn select(faces: &'a [SelectedFaces<'a>], vertices: &'a [SelectedVertices<'a>]) -> Self {
        Self::Select { faces, vertices }
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
