//! glTF files: what is moved keeps its meaning, and what is not moved keeps its bytes.
#![cfg(feature = "files")]

mod append;
mod append_edges;
mod attributes;
mod broken;
mod builder;
mod companions;
mod cull_stats;
mod culling;
mod data;
#[path = "../data/folder.rs"]
mod data_folder;
#[path = "../files_errors/mod.rs"]
mod errors;
mod in_order;
mod lengths;
mod level_ranges;
mod levelled;
mod links;
mod moves;
mod neighbours;
mod nothing_lost;
mod output;
mod reader;
mod stream_layout;
mod strips;
mod surroundings;

use meshweft::files::{Document, Edit};
use meshweft::{FaceOrder, Permutation, VertexOrder};

/// A small generator of numbers that are the same everywhere.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number below `bound`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound
    }

    pub(crate) fn permutation(&mut self, len: usize) -> Permutation {
        let mut order: Vec<u32> = (0..u32::try_from(len).unwrap()).collect();
        for i in (1..len).rev() {
            order.swap(i, self.below(i + 1));
        }
        Permutation::new(order).unwrap()
    }

    pub(crate) fn face_order(&mut self, len: usize) -> FaceOrder {
        let rotations = (0..len).map(|_| u8::try_from(self.below(3)).unwrap());
        let rotations = rotations.collect();
        FaceOrder::new(self.permutation(len), rotations).unwrap()
    }
}

/// Applies a random order of faces and of vertices, where they can be moved, to every mesh.
pub(crate) fn random_orders(document: &mut Document, seed: u64) {
    let mut random = Random(seed);
    for mesh in 0..document.meshes().len() {
        let entry = &document.meshes()[mesh];
        let faces = random.face_order(entry.record_count());
        let faces = entry.faces_movable.then_some(faces);
        let vertices = entry
            .vertices_movable
            .then(|| VertexOrder::from(random.permutation(entry.mesh.vertex_count())));
        document
            .edit(Edit::order(mesh, faces.as_ref(), vertices.as_ref()))
            .unwrap();
    }
}
