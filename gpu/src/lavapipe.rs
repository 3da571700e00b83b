//! How Mesa's software renderer reuses vertices.
//!
//! Its drawing module cuts an index list into segments of 1,023 indices (1,024, rounded down to whole
//! faces), and looks each index up in a table of 256 entries, empty at the start of a segment: entry
//! `vertex mod 256` holds the last vertex that was looked up there. A vertex that is not in its entry is
//! transformed. Read off the counters of Mesa 22.3 and 25.0, which it equals.

/// Indices in a segment.
const SEGMENT: usize = 1023;
/// Entries of the table.
const ENTRIES: usize = 256;

/// How often the vertex shader runs for one draw of a list of faces.
///
/// # Complexity
/// Time O(indices), space O(1).
#[must_use]
pub fn invocations(indices: &[u32], vertex_offset: i32) -> u64 {
    let mut invocations = 0;
    for segment in indices.chunks(SEGMENT) {
        let mut table = [None; ENTRIES];
        for &index in segment {
            let vertex = index.wrapping_add_signed(vertex_offset);
            let entry = &mut table[vertex as usize % ENTRIES];
            if *entry != Some(vertex) {
                *entry = Some(vertex);
                invocations += 1;
            }
        }
    }
    invocations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_is_kept_until_another_takes_its_entry() {
        assert_eq!(invocations(&[0, 1, 2, 2, 1, 3], 0), 4);
        // 256 takes the entry of 0, and loses it again.
        assert_eq!(invocations(&[0, 1, 2, 256, 1, 2, 0, 1, 2], 0), 5);
        // 257 takes that of 1, 258 that of 2; 0 stays.
        assert_eq!(invocations(&[0, 1, 2, 0, 257, 258], 0), 5);
    }

    #[test]
    fn every_segment_starts_with_an_empty_table() {
        let list = |faces: usize| [0, 1, 2].repeat(faces);
        // 341 faces are 1,023 indices.
        assert_eq!(invocations(&list(341), 0), 3);
        assert_eq!(invocations(&list(342), 0), 6);
        assert_eq!(invocations(&list(683), 0), 9);
    }

    #[test]
    fn an_offset_is_added_first() {
        // Without it, 0 and 256 share an entry; so they do with any.
        assert_eq!(invocations(&[0, 1, 2, 256, 1, 2, 0, 1, 2], 77), 5);
        assert_eq!(invocations(&[5, 6, 7], -5), 3);
    }
}
