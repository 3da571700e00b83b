//! View-dependent level of detail: what to draw of a mesh that costs more than a frame allows.

pub mod fast_mesh;
pub mod geometry_cache;
