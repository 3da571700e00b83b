//! What a view-dependent level of detail does on a path of the eye, and how far it is off there.
//!
//! `build` makes a `.mwl` file of one, and `extract` takes a mesh from it.
//!
//! Read `walk` for what happens in a frame, `paths` for where the eye goes, `loading` for what a file is walked around as, `verify` for what
//! is measured, `recording` for one walk drawn by several policies.

mod build;
mod detail_front;
mod extract;
#[cfg(test)]
mod file_tests;
mod loading;
mod options;
mod paths;
mod read_back;
#[cfg(test)]
mod real_tests;
mod recording;
#[cfg(test)]
mod recording_tests;
mod report;
mod source;
#[cfg(test)]
mod stored_walk_tests;
mod verify;
mod verify_options;
mod verify_report;
#[cfg(test)]
mod verify_tests;
mod walk;
#[cfg(test)]
mod walk_tests;

pub use build::{LodBuildOptions, LodBuildReport, lod_build};
pub use extract::{ExtractedMesh, LodDetail, LodExtractOptions, LodExtractReport, lod_extract};
pub use options::{LodError, LodWalkOptions};
pub use paths::CameraPath;
pub use recording::{RecordedWalk, WalkRecorder};
pub use report::{LodWalkReport, WalkedMesh};
pub use source::LodSource;
pub use verify::lod_verify;
pub use verify_options::LodVerifyOptions;
pub use verify_report::{LodVerifyReport, VerifiedFrame};
pub use walk::lod_walk;
