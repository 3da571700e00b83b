//! View-dependent level of detail: what to draw of a mesh that costs more than a frame allows.

mod block_file;
mod cone;
pub mod fast_mesh;
mod fields;
pub mod geometry_cache;
mod hierarchy_error;
pub mod quad_tin;
mod view;

pub use hierarchy_error::HierarchyError;
pub use view::{Camera, CameraView, ViewError};
