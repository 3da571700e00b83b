//! Rendering sequences: the order in which to draw the faces and to store the vertices.
//!
//! [`Optimizer`] is the one call for every [`Target`] and [`Effort`]. [`KCacheReorder`] is the
//! greedy that it uses; [`baselines`] are orders to compare with. Order the faces first; then
//! [`vertex_fetch()`] puts the vertices in the order of their first use, and [`vertex_bands()`] those that levels of
//! detail share.

mod bands;
pub mod baselines;
mod block_faces;
pub mod bogomjakov_gotsman;
mod finish;
mod greedy;
mod grid;
mod in_batches;
mod k_cache_reorder;
mod linear_speed;
mod optimizer;
mod polygons;
mod search;
mod target;
mod turn_corners;
mod universal;
mod vertex_blocks;
mod vertex_fetch;

pub use bands::vertex_bands;
pub(crate) use block_faces::is_in_blocks;
pub use grid::Grid;
pub use in_batches::InBatches;
pub use k_cache_reorder::{KCacheReorder, Mode};
pub use optimizer::Optimizer;
#[cfg(feature = "tuning")]
#[doc(hidden)]
pub use search::tuning;
pub use target::{Effort, ParseTargetError, Target};
pub use turn_corners::turn_corners;
pub(crate) use universal::is_above_floor;
#[cfg(feature = "files")]
pub(crate) use vertex_blocks::by_first_use;
pub(crate) use vertex_blocks::first_use_in_blocks;
pub use vertex_blocks::vertex_blocks;
pub use vertex_fetch::vertex_fetch;
