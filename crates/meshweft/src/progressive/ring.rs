//! The order of faces around a vertex.

/// A face at a vertex, and its two other vertices as the face is wound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RingFace {
    /// The corner at the vertex: three times the face, and 0, 1 or 2.
    pub(super) corner: u32,
    /// The neighbour where the face begins.
    pub(super) from: u32,
    /// The neighbour where it ends, and the next face begins.
    pub(super) to: u32,
}

/// Puts faces at a vertex in their order around it, counterclockwise as they are wound, beginning at the
/// neighbour of lowest number. At a gap it goes on where another row of faces begins.
///
/// # Complexity
/// Time O(n²) for n faces in few rows.
pub(super) fn put_in_order(faces: &mut [RingFace]) {
    for done in 0..faces.len() {
        let (before, rest) = faces.split_at(done);
        let last = before.last().map(|face| face.to);

        let follows = |face: &RingFace| Some(face.from) == last;
        let next = rest.iter().position(follows).unwrap_or_else(|| {
            let goes_on = |face: &RingFace| rest.iter().any(|other| other.to == face.from);
            let rank = |face: &RingFace| (last.is_some() && goes_on(face), face.from, face.corner);
            let lowest = (0..rest.len()).min_by_key(|&at| rank(&rest[at]));
            lowest.expect("some are left")
        });

        faces.swap(done, done + next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of these faces in the order around their vertex.
    fn ordered(sides: &[[u32; 2]]) -> Vec<u32> {
        let corners = (0..).zip(sides);
        let faces = corners.map(|(corner, &[from, to])| RingFace { corner, from, to });
        let mut faces: Vec<RingFace> = faces.collect();
        put_in_order(&mut faces);
        faces.iter().map(|face| face.corner).collect()
    }

    #[test]
    fn a_ring_begins_at_its_lowest_neighbour() {
        assert_eq!(ordered(&[[7, 3], [9, 7], [3, 9]]), [2, 1, 0]);
    }

    #[test]
    fn a_gap_is_where_the_way_around_goes_on() {
        // 5 6 2 8 4, without a face from 4 to 5.
        assert_eq!(ordered(&[[8, 4], [5, 6], [2, 8], [6, 2]]), [2, 0, 1, 3]);
        // Two rows of faces.
        assert_eq!(ordered(&[[5, 6], [1, 2], [4, 5], [2, 3]]), [1, 3, 2, 0]);
        assert_eq!(ordered(&[[5, 1], [2, 3], [4, 5], [3, 6]]), [1, 3, 2, 0]);
    }

    #[test]
    fn odd_faces_come_once_each() {
        assert_eq!(ordered(&[[1, 1], [3, 2], [2, 3], [3, 2]]), [0, 2, 1, 3]);
        assert!(ordered(&[]).is_empty());
    }
}
