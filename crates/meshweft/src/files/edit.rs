//! What can be done to a document.

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
        /// [`vertex_group`](super::MeshEntry::vertex_group).
        vertices: Option<&'a VertexOrder>,
    },
}
