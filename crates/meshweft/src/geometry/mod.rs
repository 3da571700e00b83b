//! Positions and directions in space, as plain arrays.

mod normals;
mod vector;

pub use normals::vertex_normals;
pub use vector::{cross, dot, normalized, sub};
