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

use crate::limits::index32;
use crate::mesh::Mesh;

/// Panics unless `starts` are polygons of all faces.
fn check_starts(starts: &[u32], mesh: &Mesh) {
    let ends = starts.first().copied().zip(starts.last().copied());
    assert!(
        ends == Some((0, index32(mesh.face_count()))) && starts.is_sorted(),
        "polygons must start at 0, rise, and end at the number of faces"
    );
}
