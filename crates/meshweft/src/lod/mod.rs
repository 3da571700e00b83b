//! View-dependent level of detail: what to draw of a mesh that is larger than what a frame may cost.

pub mod fast_mesh;
pub mod geometry_cache;
