//! Which faces meet at which edges of a surface.

use crate::index::index32;

/// Stands for no half-edge, no vertex and no face.
pub(crate) const NONE: u32 = u32::MAX;

/// One side of an edge: it belongs to one face, and goes from one of its corners to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct HalfEdge {
    /// The vertex where it starts.
    pub(crate) start: u32,
    /// The half-edge of the other face at the edge, or [`NONE`] at a border.
    pub(crate) twin: u32,
}

/// The half-edges of faces: `3 f + k` starts at corner `k` of face `f`, 8 bytes each.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct HalfEdges {
    edges: Vec<HalfEdge>,
}

/// The half-edge that follows in the same face.
#[inline]
pub(crate) fn next(half_edge: u32) -> u32 {
    match half_edge % 3 {
        2 => half_edge - 2,
        _ => half_edge + 1,
    }
}

/// The half-edge before it in the same face.
#[inline]
pub(crate) fn previous(half_edge: u32) -> u32 {
    match half_edge % 3 {
        0 => half_edge + 2,
        _ => half_edge - 1,
    }
}

impl HalfEdges {
    /// Of faces with three distinct points each. Two half-edges are twins if they join the same points in opposite
    /// directions and no other half-edge joins them: an edge of three faces, or of two that are wound against each other, is a border
    /// of each.
    ///
    /// Time O(faces log faces), at most; space 24 bytes a face, and 12 more while it is made.
    pub(crate) fn new(faces: &[[u32; 3]], point_count: usize) -> Self {
        let corners = faces.as_flattened();
        let edge = |&start: &u32| HalfEdge { start, twin: NONE };
        let mut edges: Vec<HalfEdge> = corners.iter().map(edge).collect();
        let end = |half_edge: u32| corners[next(half_edge) as usize];

        // Half-edges by the lower of their two points.
        let lower = |half_edge: u32| corners[half_edge as usize].min(end(half_edge)) as usize;
        let mut starts = vec![0_u32; point_count + 1];
        for half_edge in 0..index32(corners.len()) {
            starts[lower(half_edge) + 1] += 1;
        }
        for point in 0..point_count {
            starts[point + 1] += starts[point];
        }
        let mut by_lower = vec![0_u32; corners.len()];
        let mut places = starts.clone();
        for half_edge in 0..index32(corners.len()) {
            let place = &mut places[lower(half_edge)];
            by_lower[*place as usize] = half_edge;
            *place += 1;
        }

        // At each point, those of one edge come together.
        let higher = |half_edge: u32| corners[half_edge as usize].max(end(half_edge));
        for range in starts.windows(2) {
            let here = &mut by_lower[range[0] as usize..range[1] as usize];
            here.sort_unstable_by_key(|&half_edge| (higher(half_edge), half_edge));
            for same in here.chunk_by(|&a, &b| higher(a) == higher(b)) {
                if let &[a, b] = same
                    && corners[a as usize] != corners[b as usize]
                {
                    edges[a as usize].twin = b;
                    edges[b as usize].twin = a;
                }
            }
        }
        Self { edges }
    }

    /// Of half-edges in their order.
    pub(crate) fn from_edges(edges: Vec<HalfEdge>) -> Self {
        debug_assert!(edges.len().is_multiple_of(3), "whole faces");
        Self { edges }
    }

    /// How many half-edges there are, three a face.
    pub(crate) fn len(&self) -> usize {
        self.edges.len()
    }

    /// Where a half-edge starts.
    #[inline]
    pub(crate) fn start(&self, half_edge: u32) -> u32 {
        self.edges[half_edge as usize].start
    }

    /// The other side of its edge, or [`NONE`].
    #[inline]
    pub(crate) fn twin(&self, half_edge: u32) -> u32 {
        self.edges[half_edge as usize].twin
    }

    /// A half-edge starts at another vertex from now on.
    #[inline]
    pub(crate) fn set_start(&mut self, half_edge: u32, vertex: u32) {
        self.edges[half_edge as usize].start = vertex;
    }

    /// The other side of its edge is another one from now on, which need not know.
    pub(crate) fn set_twin(&mut self, half_edge: u32, twin: u32) {
        self.edges[half_edge as usize].twin = twin;
    }

    /// Two half-edges are twins from now on; one that is there without the other is at a border.
    #[inline]
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        for (from, to) in [(a, b), (b, a)] {
            if from != NONE {
                self.edges[from as usize].twin = to;
            }
        }
    }

    /// The three vertices of a face.
    #[inline]
    pub(crate) fn face(&self, face: u32) -> [u32; 3] {
        [0, 1, 2].map(|slot| self.start(3 * face + slot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_faces_that_meet_are_twins_there_only() {
        let edges = HalfEdges::new(&[[0, 1, 2], [2, 1, 3]], 4);
        let twins: Vec<u32> = (0..6).map(|half_edge| edges.twin(half_edge)).collect();
        assert_eq!(twins, [NONE, 3, NONE, 1, NONE, NONE]);
        assert_eq!(edges.face(1), [2, 1, 3]);
    }

    #[test]
    fn edges_of_three_faces_or_wound_twice_the_same_way_are_borders() {
        for faces in [
            &[[0, 1, 2], [1, 0, 3], [0, 1, 4]][..],
            &[[0, 1, 2], [0, 1, 3]],
            &[[0, 1, 2], [0, 1, 2]],
        ] {
            let edges = HalfEdges::new(faces, 5);
            assert!((0..index32(edges.len())).all(|half_edge| edges.twin(half_edge) == NONE));
        }
    }

    #[test]
    fn twins_join_the_same_points_the_other_way() {
        let faces = crate::progressive::made::sphere(3);
        let edges = HalfEdges::new(&faces, 258);
        for half_edge in 0..index32(edges.len()) {
            let twin = edges.twin(half_edge);
            assert_eq!(edges.twin(twin), half_edge);
            assert_eq!(edges.start(twin), edges.start(next(half_edge)));
            assert_eq!(edges.start(next(twin)), edges.start(half_edge));
            assert_eq!(previous(next(half_edge)), half_edge);
        }
    }
}
