//! Terrain: a restricted quadtree over a grid of heights or over points.

mod descent;
mod extent;
mod grid;
mod grid_build;
mod grid_square;
mod hierarchy;
mod limited;
mod plane;
mod rounded;
mod stored;
#[cfg(test)]
mod stored_tests;
mod streamed;
mod strip;
#[cfg(test)]
pub(crate) mod tests;
mod triangle;

pub use descent::TinSurface;
pub use hierarchy::{QuadTin, QuadTinError};
pub use limited::TinLimit;
pub use streamed::StreamedTin;
