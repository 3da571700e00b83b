//! Faces across the border of two blocks of vertices, drawn two at the end of a batch.
//!
//! A GPU that forgets its vertices where the block changes draws such faces at the price of all three
//! vertices, or nearly. By themselves they would fill batches with vertices; two in a batch, after 30
//! faces inside a block, take room that is free. A face *waits* from where its vertex in the block, its
//! *anchor*, is finished, and is drawn at the end of the next batch that has room: so caches that do
//! not care for blocks may still have its vertices.

use super::super::block_faces::turned_home;
use crate::faces::turned;
use crate::permutation::{FaceOrder, Permutation};
use crate::topology::rows::Rows;

/// How many of them a batch takes.
pub(super) const HOSTED: u32 = 2;

/// Most vertices that they add to a batch.
pub(super) const HOSTED_VERTICES: u32 = 3 * HOSTED;

/// A face across a border, in the part of its block.
#[derive(Debug, Clone, Copy)]
pub(super) struct BorderFace {
    /// Its first two vertices in the block, if it has two, in the numbers of the part.
    anchors: [u32; 2],
    /// How far to turn it so that its vertices in the block come first, and last.
    rotations: [u8; 2],
}

impl BorderFace {
    /// Of a face, given in the numbers of the whole mesh and in those of the part.
    pub(super) fn new(face: [u32; 3], in_part: [u32; 3], keep_corners: bool) -> Self {
        let rotations = [false, true].map(|is_last| turned_home(face, is_last));
        let [a, b, _] = turned(in_part, rotations[0]);
        Self {
            anchors: [a, b],
            rotations: if keep_corners { [0; 2] } else { rotations },
        }
    }
}

/// The faces across a border of one part, by their anchors.
pub(super) struct Border<'a> {
    faces: &'a [BorderFace],
    /// How many corners of faces inside each vertex has.
    live: Vec<u32>,
    /// The faces that wait once a vertex is finished.
    by_anchor: Rows<u32>,
    /// Faces whose vertices are on no face inside.
    without_anchor: Vec<u32>,
}

impl<'a> Border<'a> {
    /// Time and space O(vertices + faces of the part).
    pub(super) fn new(faces: &'a [BorderFace], inside: &[[u32; 3]], vertex_count: usize) -> Self {
        let mut live = vec![0; vertex_count];
        for &corner in inside.as_flattened() {
            live[corner as usize] += 1;
        }
        let anchor = |face: &BorderFace| {
            let mut anchors = face.anchors.into_iter();
            anchors.find(|&anchor| live[anchor as usize] != 0)
        };
        let numbered = (0..).zip(faces);
        let anchored = numbered
            .clone()
            .filter_map(|(number, face)| Some((anchor(face)?, number)));
        let by_anchor = Rows::by_counting(vertex_count, anchored);
        let without_anchor = numbered.filter(|(_, face)| anchor(face).is_none());
        let without_anchor = without_anchor.map(|(number, _)| number).collect();
        Self {
            faces,
            live,
            by_anchor,
            without_anchor,
        }
    }

    /// How many faces wait once each vertex is finished.
    pub(super) fn waiting_by_vertex(&self) -> Vec<u32> {
        let rows = 0..crate::index::index32(self.by_anchor.len());
        rows.map(|vertex| crate::index::index32(self.by_anchor.row(vertex).len()))
            .collect()
    }

    /// The order of the faces `inside` with those across a border, numbered after them, put in at the
    /// positions `hosts`, [`HOSTED`] each. Those that no batch took come last; returns how many.
    pub(super) fn woven(
        mut self,
        inside: &[[u32; 3]],
        order: &FaceOrder,
        hosts: &[u32],
    ) -> (FaceOrder, usize) {
        let first = crate::index::index32(inside.len());
        let mut new_to_old = Vec::with_capacity(inside.len() + self.faces.len());
        let mut rotations = Vec::with_capacity(inside.len() + self.faces.len());
        let mut waiting: Vec<u32> = Vec::new();
        let mut hosts = hosts.iter().copied().peekable();

        for position in 0..=first {
            // The last that came to wait: their vertices were used last. A corner that the one before
            // ends with does not change the block.
            if hosts.next_if_eq(&position).is_some() {
                for is_last in [0, 1] {
                    if let Some(face) = waiting.pop() {
                        new_to_old.push(first + face);
                        rotations.push(self.faces[face as usize].rotations[is_last]);
                    }
                }
            }

            // A face inside may finish anchors.
            let Some(&face) = order.new_to_old().get(position as usize) else {
                break;
            };
            new_to_old.push(face);
            rotations.push(order.rotation(position as usize));
            for corner in inside[face as usize] {
                self.live[corner as usize] -= 1;
                if self.live[corner as usize] == 0 {
                    waiting.extend(self.by_anchor.row(corner));
                }
            }
        }

        // Those left.
        waiting.extend(self.without_anchor);
        waiting.sort_unstable();
        let left = waiting.len();
        new_to_old.extend(waiting.into_iter().map(|face| first + face));
        rotations.resize(new_to_old.len(), 0);
        let order = Permutation::from_algorithm(new_to_old);
        let order = FaceOrder::new(order, rotations).expect("one rotation below 3 a face");
        (order, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_wait_for_their_anchor_and_come_by_twos() {
        // Inside: a strip of vertices 0 to 5. Across: with vertex 6 of another block.
        let inside = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];
        let high = 1 << 16;
        let across = [[0, 1, 6], [6, 0, 2], [5, 6, 4], [6, 7, 8]];
        let global = |v: u32| if v < 6 { v } else { high + v };
        let faces = across.map(|face| BorderFace::new(face.map(global), face, false));
        let border = Border::new(&faces, &inside, 9);
        assert_eq!(border.waiting_by_vertex(), [2, 0, 0, 0, 1, 0, 0, 0, 0]);

        // Vertex 0 is finished by the first face, vertex 4 by the last; the fourth has no anchor.
        let order = FaceOrder::identity(4);
        let (order, left) = border.woven(&inside, &order, &[3]);
        assert_eq!(order.new_to_old(), [0, 1, 2, 5, 4, 3, 6, 7]);
        assert_eq!(left, 2);
        // Face 5 starts in the block, face 4 ends in it.
        let drawn = order.apply(&[&inside[..], &across[..]].concat());
        assert_eq!(drawn[3..5], [[0, 2, 6], [6, 0, 1]]);

        let kept = across.map(|face| BorderFace::new(face.map(global), face, true));
        let border = Border::new(&kept, &inside, 9);
        let (order, _) = border.woven(&inside, &FaceOrder::identity(4), &[3]);
        assert!(order.rotations().is_empty() || order.rotations().iter().all(|&r| r == 0));
    }
}
