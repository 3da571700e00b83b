//! The facets of an STL file, binary or ascii.

use std::ops::Range;

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

/// Where the numbers of a facet stand, and what they are.
pub(super) struct FacetPlaces {
    /// The three numbers of its normal.
    pub(super) normal: [Range<usize>; 3],
    /// Its corners, each three numbers with what is between.
    pub(super) corners: [Range<usize>; 3],
    pub(super) positions: [[f32; 3]; 3],
}
