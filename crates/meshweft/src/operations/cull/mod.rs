//! Which faces of a document need not be drawn, and what that saves.
//!
//! Read `build` for how a document gets its tables, `eyes` for how eyes are listed, `stats` for what tables leave out.

mod build;
mod eyes;
mod options;
mod report;
mod stats;
mod stats_report;
mod views;

pub use build::cull_build;
pub use eyes::{CullEyesError, eyes_by_name, eyes_of_json};
pub use options::{CullError, CullOptions, CullOptionsError, CullStatsOptions};
pub use report::{CullOutcome, CullReport, CulledMesh};
pub use stats::cull_stats;
pub use stats_report::{CullStatsReport, CullingFigures};
pub use views::ViewSums;
