//! Faces that are drawn together because they were cut from one polygon.
//!
//! Callers give `starts`: polygon `i` is the faces `starts[i]..starts[i + 1]`. Algorithms ask by
//! face and use the range of each face's polygon ([`polygon_of_each_face`]).

use crate::index::index32;

/// Panics unless `starts` rises from 0 to `face_count`.
pub(super) fn check_starts(starts: &[u32], face_count: usize) {
    let ends = starts.first().copied().zip(starts.last().copied());
    assert!(
        ends == Some((0, index32(face_count))) && starts.is_sorted(),
        "polygons must start at 0, rise, and end at the number of faces"
    );
}

/// For each face, where its polygon begins and ends.
pub(super) fn polygon_of_each_face(starts: &[u32]) -> Vec<[u32; 2]> {
    let polygon =
        |ends: &[u32]| std::iter::repeat_n([ends[0], ends[1]], (ends[1] - ends[0]) as usize);
    starts.windows(2).flat_map(polygon).collect()
}
