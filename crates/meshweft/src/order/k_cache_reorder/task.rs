//! The input of every mode.

use crate::faces::Faces;
use crate::order::greedy::Costs;

/// Faces to be ordered for a cache of `size` vertices.
pub(super) struct Task<'a> {
    pub(super) faces: Faces<'a>,
    /// At most the number of vertices: a larger cache changes nothing.
    pub(super) size: u32,
    pub(super) costs: Costs,
    /// The vertex to start from, instead of what the mode would choose.
    pub(super) first_focus: Option<u32>,
}
