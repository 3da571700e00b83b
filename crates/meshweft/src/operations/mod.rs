//! The jobs of this toolkit, each as one call. Programs and bindings parse options, call a job and print
//! its report.
//!
//! [`optimize_indices`] orders raw indices in place. With feature `files`, `optimize` orders a
//! document and keeps every other byte, `simplify` takes faces away from it, `levels` adds levels of detail to it, `inspect` counts it as it is, and
//! `compare` tells whether two documents hold the same triangles, `compress` makes an archive of the meshes, which `decompress` reads, `cull_build` adds tables that say which faces need not be
//! drawn, and `cull_stats` counts what these leave out, `lod_build` makes a file of a mesh with every level of detail,
//! `lod_extract` takes one mesh from it, `lod_walk` walks around one whose detail follows the eye, `lod_verify` measures how far
//! that is off, and `level_ranges` says which bytes of a file with levels of detail each of them needs; their reports are values that know their JSON. With feature `height-maps`, `terrain_build`, `terrain_extract`, `terrain_walk` and
//! `terrain_verify` do the same for terrain.
//! [`Method`] has every order by name, [`SequenceUpdate`] every way to keep one up as a mesh gets coarser,
//! along a history such as [`collapse_history`] makes. [`StripedMesh`] and [`FacePlanes`] count what of a mesh is drawn, and
//! what could be left out, from where it is seen.
//!
//! This is the only place that joins files and algorithms. Read `options`, then `better` for why a run
//! on its own output changes nothing, then `improve`.

mod algorithm;
mod better;
#[cfg(feature = "files")]
mod compare;
#[cfg(feature = "files")]
mod compress;
#[cfg(feature = "files")]
mod converted;
mod counts;
#[cfg(feature = "files")]
mod cull;
#[cfg(all(test, feature = "files"))]
#[path = "../../tests/data/folder.rs"]
mod data_folder;
#[cfg(feature = "files")]
mod facets;
#[cfg(feature = "files")]
mod file_report;
#[cfg(feature = "files")]
mod improve;
#[cfg(feature = "files")]
mod improved;
mod indices;
#[cfg(feature = "files")]
mod inspect;
#[cfg(feature = "files")]
mod json;
#[cfg(feature = "files")]
mod levels;
#[cfg(feature = "files")]
mod lod;
#[cfg(feature = "files")]
mod losses;
mod methods;
#[cfg(feature = "files")]
mod optimize;
#[cfg(feature = "files")]
mod optimize_json;
mod options;
#[cfg(feature = "files")]
mod plain_meshes;
mod sequence_updates;
mod shared_progress;
#[cfg(feature = "files")]
mod simplify;
#[cfg(feature = "files")]
mod stage;
mod striped_mesh;
#[cfg(feature = "height-maps")]
mod terrain;
#[cfg(feature = "files")]
mod vertex_groups;
#[cfg(feature = "files")]
mod walks;

#[cfg(feature = "files")]
pub use compare::{CompareReport, ComparedFile, ComparedLevel, compare};
#[cfg(feature = "files")]
pub use compress::{
    CompressError, CompressOptions, CompressReport, CompressedMesh, DecodedOrder,
    DecompressOptions, DecompressedMesh, KeepOrder, PolygonCounts, PositionPrecision, Tier,
    compress, decompress,
};
#[cfg(feature = "files")]
pub use converted::ConversionError;
pub use counts::{Counts, USUAL_CACHES};
#[cfg(feature = "files")]
pub use cull::{
    CullError, CullEyesError, CullOptions, CullOptionsError, CullOutcome, CullReport,
    CullStatsOptions, CullStatsReport, CulledMesh, CullingFigures, ViewSums, cull_build,
    cull_stats, eyes_by_name, eyes_of_json,
};
#[cfg(feature = "files")]
pub use file_report::FileReport;
pub use indices::{IndexOptions, Orders, VertexIndex, optimize_indices, optimize_indices_with};
#[cfg(feature = "files")]
pub use inspect::{InspectReport, InspectedLevel, InspectedMesh, inspect};
#[cfg(feature = "files")]
pub use json::SCHEMA;
#[cfg(feature = "files")]
pub use levels::{
    FileLevel, FileRange, LevelGoals, LevelRanges, LevelRangesOptions, LevelRangesReport,
    LeveledObject, LevelsError, LevelsOptions, LevelsOptionsError, LevelsReport, level_ranges,
    levels, levels_apart,
};
#[cfg(feature = "files")]
pub use lod::{
    CameraPath, ExtractedMesh, LodBuildOptions, LodBuildReport, LodDetail, LodError,
    LodExtractOptions, LodExtractReport, LodSource, LodVerifyOptions, LodVerifyReport,
    LodWalkOptions, LodWalkReport, RecordedWalk, VerifiedFrame, WalkRecorder, WalkedMesh,
    lod_build, lod_extract, lod_verify, lod_walk,
};
pub use methods::{InBatches, Method, grid_orders, linear_arrangement_cost};
#[cfg(feature = "files")]
pub use optimize::{CountChange, OptimizeError, OptimizeReport, OptimizedMesh, optimize};
pub use options::{Greedy, Options, OptionsError};
pub use sequence_updates::{SequenceUpdate, collapse_history};
#[cfg(feature = "files")]
pub use simplify::{
    AttributeWeights, ErrorLimit, LEVEL_CACHES, LevelFigures, Removals, SimplifiedMesh,
    SimplifiedObject, SimplifyError, SimplifyOptions, SimplifyOptionsError, SimplifyReport,
    StopReason, simplify,
};
pub use striped_mesh::{FacePlanes, StripedMesh, ViewFrom};
#[cfg(feature = "height-maps")]
pub use terrain::{
    BuiltTerrain, ExtractedTerrain, TerrainBuildReport, TerrainDetail, TerrainError,
    TerrainExtractOptions, TerrainExtractReport, TerrainFacts, TerrainHeights, TerrainPath,
    TerrainReadOptions, TerrainSamples, TerrainSource, TerrainVerifyOptions, TerrainVerifyReport,
    TerrainWalkOptions, TerrainWalkReport, TerrainWalker, VerifiedSurface, terrain_build,
    terrain_extract, terrain_verify, terrain_walk,
};
#[cfg(feature = "files")]
pub use walks::{
    MOST_FRAMES, PixelErrors, WalkFrame, WalkOptimum, WalkOptionError, WalkQuantity, WalkSummary,
    cameras_from_json,
};

#[cfg(feature = "files")]
pub use crate::lod::Camera;
#[cfg(feature = "files")]
pub use crate::lod::geometry_cache::EvictionPolicy;
