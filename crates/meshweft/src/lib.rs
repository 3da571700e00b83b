#![cfg_attr(not(test), warn(clippy::print_stdout))]
//! Put the triangles of a mesh in the order in which a GPU transforms each vertex about once.

pub mod adjacency;
pub mod cache;
mod error;
mod limits;
mod mesh;
pub mod order;
mod permutation;

pub use cache::CacheModel;
pub use error::MeshError;
pub use limits::Limits;
pub use mesh::Mesh;
pub use permutation::{FaceOrder, Permutation, VertexOrder};
