//! The facets of an STL file, binary or ascii.

use crate::files::slots::Spans;

/// The facets of a file.
pub(super) struct Facets {
    pub(super) spans: Spans,
    /// The bits of the positions of each facet's corners.
    pub(super) corners: Vec<[[u32; 3]; 3]>,
    /// The facets at which a `solid` starts.
    pub(super) runs: Vec<u32>,
    pub(super) name: String,
}
