//! Faces that are drawn together, as the polygons that they were cut from.

use crate::index::index32;

/// Panics unless `starts` are polygons of `face_count` faces.
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
