//! Terrain: a hierarchy of right triangles over heights, as a file and as a mesh.
//!
//! Read `heights` for where heights come from, `source` for what is drawn, `build` and `extract` for files.

mod build;
mod error;
mod extract;
#[cfg(test)]
mod file_tests;
mod heights;
mod source;

pub use build::{BuiltTerrain, TerrainBuildReport, terrain_build};
pub use error::TerrainError;
pub use extract::{
    ExtractedTerrain, TerrainDetail, TerrainExtractOptions, TerrainExtractReport, terrain_extract,
};
pub use heights::{TerrainHeights, TerrainReadOptions};
pub use source::{TerrainFacts, TerrainSource};
