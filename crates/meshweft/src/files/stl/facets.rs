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

/// The unit normal of a triangle; zeros if it has no area.
pub(super) fn normal_of(corners: [[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let side = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let (u, v) = (side(b), side(c));
    let cross = [1, 2, 0].map(|i: usize| {
        let j = (i + 1) % 3;
        u[i] * v[j] - u[j] * v[i]
    });
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return [0.0; 3];
    }
    #[expect(clippy::cast_possible_truncation, reason = "of length one")]
    cross.map(|x| (x / length) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_points_to_where_the_corners_turn_left() {
        let corners = [[0.0, 0.0, 5.0], [2.0, 0.0, 5.0], [0.0, 3.0, 5.0]];
        assert_eq!(normal_of(corners), [0.0, 0.0, 1.0]);
        let [a, b, c] = corners;
        assert_eq!(normal_of([b, a, c]), [0.0, 0.0, -1.0]);
        assert_eq!(normal_of([a, a, c]), [0.0; 3]);
        assert_eq!(
            normal_of([[0.0, 0.0, 0.0], [0.0, 1e-30, 0.0], [0.0, 0.0, 1e-30]]),
            [1.0, 0.0, 0.0]
        );
    }
}
