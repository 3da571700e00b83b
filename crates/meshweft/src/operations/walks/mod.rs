//! What walks with any level of detail share: cameras, what a frame counts, what is seen of it, and how far that is off.

mod camera_file;
mod checks;
mod frame;
mod measured_view;
mod passes;
mod pixel_errors;
mod stored_file;
mod summary;

pub use camera_file::{MOST_FRAMES, cameras_from_json};
pub use checks::WalkOptionError;
pub use frame::{WalkFrame, WalkQuantity};
pub use pixel_errors::PixelErrors;
pub use summary::{WalkOptimum, WalkSummary};

pub(super) use checks::WalkNumbers;
pub(super) use measured_view::MeasuredView;
pub(super) use passes::draw_passes;
pub(super) use pixel_errors::CollectedErrors;
pub(super) use stored_file::{BlockSource, is_stored, open_stored};
pub(super) use summary::{counted, overfull_frames};
