//! Terrain: a hierarchy of right triangles over heights, as a file, as a mesh, on a path of the eye, and how far it is off there.
//!
//! Read `heights` for where heights come from, `source` for what is drawn, `build` and `extract` for files, `paths` for where the eye goes,
//! `walk` for what happens in a frame (`numbered_surface` once, `walk_buffers` for each policy), `verify`, `full_grid` and
//! `full_points` for what is measured.

mod build;
mod error;
mod extract;
#[cfg(test)]
mod file_tests;
mod full_grid;
mod full_points;
#[cfg(test)]
mod full_points_tests;
mod heights;
mod measured_heights;
mod numbered_surface;
mod numbers;
mod paths;
mod point_tree;
mod source;
mod surface_faults;
mod verify;
mod verify_options;
mod verify_report;
mod walk;
mod walk_buffers;
mod walk_options;
mod walk_report;
#[cfg(test)]
mod walk_tests;

pub use build::{BuiltTerrain, TerrainBuildReport, terrain_build};
pub use error::TerrainError;
pub use extract::{
    ExtractedTerrain, TerrainDetail, TerrainExtractOptions, TerrainExtractReport, terrain_extract,
};
pub use heights::{TerrainHeights, TerrainReadOptions, TerrainSamples};
pub use paths::TerrainPath;
pub use source::{TerrainFacts, TerrainSource};
pub use verify::terrain_verify;
pub use verify_options::TerrainVerifyOptions;
pub use verify_report::{TerrainVerifyReport, VerifiedSurface};
pub use walk::{TerrainWalker, terrain_walk};
pub use walk_options::TerrainWalkOptions;
pub use walk_report::TerrainWalkReport;
