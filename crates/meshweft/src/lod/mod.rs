//! View-dependent level of detail: what to draw of a mesh that costs more than a frame allows.

mod cone;
pub mod fast_mesh;
pub mod geometry_cache;
mod view;

pub use view::{Camera, CameraView, ViewError};
