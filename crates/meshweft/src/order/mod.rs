//! Rendering sequences: in which order to draw the faces, and to store the vertices.
//!
//! [`KCacheReorder`] is the method of this toolkit; [`baselines`] are what it is compared with.
//! Faces come first, then [`vertex_fetch()`] puts the vertices in the order of their first use.

pub mod baselines;
mod greedy;
mod grid;
mod k_cache_reorder;
mod search;
pub mod universal;
mod vertex_fetch;

pub use grid::Grid;
pub use k_cache_reorder::{KCacheReorder, Mode};
pub use search::{Effort, Optimizer, ParseTargetError, Target};
pub use vertex_fetch::vertex_fetch;
