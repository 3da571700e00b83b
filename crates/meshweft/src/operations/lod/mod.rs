//! What a view-dependent level of detail does on a path of the eye.
//!
//! `build` makes a `.mwl` file of one, and `extract` takes a mesh from it.
//!
//! Read `walk` for what happens in a frame, `paths` for where the eye goes, `loading` for what a file is walked around as.

mod build;
mod camera_file;
mod extract;
#[cfg(test)]
mod file_tests;
mod frame;
mod loading;
mod options;
mod paths;
mod read_back;
mod report;
mod walk;
#[cfg(test)]
mod walk_tests;

pub use crate::lod::fast_mesh::Camera;
pub use crate::lod::geometry_cache::Eviction;
pub use build::{LodBuildOptions, LodBuildReport, lod_build};
pub use camera_file::{MOST_FRAMES, cameras_from_json};
pub use extract::{ExtractedMesh, LodDetail, LodExtractOptions, LodExtractReport, lod_extract};
pub use frame::{WalkFrame, WalkQuantity};
pub use options::{LodError, LodWalkOptions, WalkOptionError};
pub use paths::CameraPath;
pub use report::{LodWalkReport, WalkOptimum, WalkSummary, WalkedMesh};
pub use walk::lod_walk;
