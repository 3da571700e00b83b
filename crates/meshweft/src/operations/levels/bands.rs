//! The vertices of a group in bands, and their numbers there and here.

use crate::faces::Faces;
use crate::order::vertex_bands;
use crate::permutation::{VertexOrder, renumber};

/// The order of a group of vertices, and its inverse.
pub(super) struct GroupBands {
    order: VertexOrder,
    old_to_new: Vec<u32>,
}

impl GroupBands {
    /// That of the levels of all meshes of the group, fine to coarse.
    pub(super) fn new(levels: &[Faces<'_>]) -> Self {
        let order = vertex_bands(levels);
        let old_to_new = order.permutation().old_to_new();
        Self { order, old_to_new }
    }

    pub(super) fn order(&self) -> &VertexOrder {
        &self.order
    }

    /// The number that a vertex will have.
    pub(super) fn number(&self, vertex: u32) -> u32 {
        self.old_to_new[vertex as usize]
    }

    /// Gives corners the numbers that their vertices will have.
    pub(super) fn renumber(&self, faces: &mut [[u32; 3]]) {
        renumber(faces, &self.old_to_new);
    }

    /// Gives corners the numbers that their vertices had.
    pub(super) fn restore(&self, faces: &mut [[u32; 3]]) {
        renumber(faces, self.order.new_to_old());
    }
}
