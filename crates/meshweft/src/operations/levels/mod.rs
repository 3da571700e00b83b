//! Levels of detail in one ordinary GLB: vertices in bands, an index list for each level, nodes that stand in.
//!
//! All objects of a file have one error budget (`budget`). The vertices of a level come before all others in every
//! vertex view, so a level is drawn from the beginning of the view. Read `build` first, then `coarser` for what becomes of
//! one object.

mod apart;
mod bands;
mod budget;
mod build;
mod coarser;
mod lists;
mod made;
mod options;
mod ranges;
mod report;

pub use apart::levels_apart;
pub use build::levels;
pub use options::{LevelGoals, LevelsError, LevelsOptions, LevelsOptionsError};
pub use ranges::{FileRange, LevelRanges, LevelRangesOptions, LevelRangesReport, level_ranges};
pub use report::{FileLevel, LeveledObject, LevelsReport};
