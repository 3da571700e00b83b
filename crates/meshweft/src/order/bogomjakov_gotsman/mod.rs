//! Orders that are made for no particular cache size, by recursive cuts.
//!
//! Alexander Bogomjakov, Craig Gotsman: *Universal Rendering Sequences for Transparent Vertex
//! Caching of Progressive Meshes*, Computer Graphics Forum 21(2), 2002,
//! doi:10.1111/1467-8659.00573. The mesh is cut in two with few edges between the halves, then each
//! half again, down to a few faces. A sequence along that tree keeps neighbours together at every
//! scale, like a space-filling curve. The paper orients the tree in two ways: by what is near the
//! cut ([`RecursiveCut`]) and by the minimum linear arrangement problem ([`LinearArrangement`]).
//!
//! They are here to compare with, and for caches of some hundred vertices. A search for the target
//! [`Universal`](super::Target::Universal) misses less in every cache up to 64.
//!
//! Read `cut_tree` for the tree, `seam` for what it saves to draw one half after the other.

mod cut_tree;
mod linear_arrangement;
mod recursive_cut;
mod seam;

pub use cut_tree::Cutter;
pub use linear_arrangement::{LinearArrangement, cost as linear_arrangement_cost};
pub use recursive_cut::RecursiveCut;

#[cfg(test)]
mod tests;
