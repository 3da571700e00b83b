//! Orders that know of no cache size.
//!
//! Alexander Bogomjakov, Craig Gotsman: *Universal Rendering Sequences for Transparent Vertex Caching
//! of Progressive Meshes*, Computer Graphics Forum 21(2), 2002, doi:10.1111/1467-8659.00573. The mesh
//! is cut in two with few edges between the halves, each half again, down to a few faces: a sequence
//! along that tree keeps neighbours together at every scale, like a space-filling curve. The paper
//! orients the tree in two ways, by what is near the cut ([`RecursiveCut`]) and by the minimum linear
//! arrangement problem ([`LinearArrangement`]).
//!
//! Here they are for the record and for caches of some hundred vertices. A search for the target
//! [`Universal`](super::Target::Universal) misses less in every cache up to 64.
//!
//! Read `cut_tree` for the tree, `seam` for what two halves save.

mod cut_tree;
mod linear_arrangement;
mod recursive_cut;
mod seam;

pub use cut_tree::Cutter;
pub use linear_arrangement::{LinearArrangement, cost as linear_arrangement_cost};
pub use recursive_cut::RecursiveCut;

use crate::mesh::Mesh;
use crate::order::greedy::HITS_FIRST;
use crate::permutation::FaceOrder;

/// The order with corners turned so that hits come first in a FIFO cache of 12.
fn turned(order: FaceOrder, mesh: &Mesh) -> FaceOrder {
    const SIZE: u32 = 12;
    let mut entered = vec![0_u32; mesh.vertex_count()];
    let mut pushes = SIZE;
    let mut rotations = Vec::with_capacity(order.len());
    for &face in order.new_to_old() {
        let [a, b, c] = mesh.faces()[face as usize];
        let missing = [a, b, c].map(|v| pushes - entered[v as usize] >= SIZE);
        let set = missing.map(usize::from);
        let rotation = HITS_FIRST[set[0] | set[1] << 1 | set[2] << 2];
        rotations.push(rotation);
        let turned = [[a, b, c], [b, c, a], [c, a, b]][rotation as usize];
        for vertex in turned {
            if pushes - entered[vertex as usize] >= SIZE {
                pushes += 1;
                entered[vertex as usize] = pushes;
            }
        }
    }
    FaceOrder::new(order.permutation().clone(), rotations).expect("one rotation below 3 a face")
}

#[cfg(test)]
mod tests;
