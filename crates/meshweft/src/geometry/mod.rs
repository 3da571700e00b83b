//! Positions and directions in space, as plain arrays; how far surfaces are from each other.

pub(crate) mod angle;
mod ball;
mod deviation;
pub(crate) mod double;
mod lattice;
pub(crate) mod linear_program;
pub(crate) mod morton;

mod normals;
mod samples;
pub(crate) mod signs;
mod surface;
pub(crate) mod triangle;
mod vector;

pub use ball::Ball;
pub use deviation::{Deviation, Distances, deviation};
pub use lattice::Lattice;
pub use normals::vertex_normals;
pub use surface::{Nearest, Surface};
pub(crate) use vector::place_bits;
pub use vector::{cross, dot, normalized, sub};
