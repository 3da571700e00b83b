//! The rule by which NVIDIA cards collect primitives in batches, with its four numbers open.
//!
//! `meshweft::cache::nvidia` has the numbers of the cards that were probed; here they are searched for
//! on the card at hand. This is a second implementation, kept plain: it looks back through the corners
//! of the batch for every corner.

use crate::draw::{Draw, RESTART, Topology};

/// What one warp does.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Batch {
    /// The vertex of each lane.
    pub vertices: Vec<u32>,
    /// The lanes of each face's corners.
    pub faces: Vec<[u32; 3]>,
}

/// The rule; every limit is the largest that is still allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BatchRule {
    /// Primitives in a batch.
    pub primitives: u32,
    /// Invocations of the vertex shader in a batch: lanes of a warp.
    pub lanes: u32,
    /// Corners after the last use of a vertex at which it is still found.
    pub window: u32,
    /// Bits of a vertex number inside a block; all is forgotten where the block changes.
    pub block_bits: u32,
}

impl BatchRule {
    /// The rule of H100 and H200 with driver 580.
    pub const NVIDIA: Self = Self {
        primitives: 32,
        lanes: 32,
        window: 42,
        block_bits: 16,
    };

    /// The batches of one draw.
    ///
    /// # Complexity
    /// Time O(corners · window).
    #[must_use]
    pub fn batches(&self, draw: &Draw<'_>) -> Vec<Batch> {
        let mut filling = Filling::new(*self);
        let primitives = primitives(draw);
        for instance in 0..draw.instances {
            for primitive in &primitives {
                let corners = primitive.map(|index| index.wrapping_add_signed(draw.vertex_offset));
                // A shader that does not read the instance has the same vertices in all of them.
                filling.draw(corners, if draw.reads_instance { instance } else { 0 });
            }
        }
        filling.batches
    }

    /// Invocations and batches of one draw.
    ///
    /// # Complexity
    /// As [`batches`](Self::batches).
    #[must_use]
    pub fn counts(&self, draw: &Draw<'_>) -> (u64, u64) {
        let batches = self.batches(draw);
        let lanes: usize = batches.iter().map(|batch| batch.vertices.len()).sum();
        (lanes as u64, batches.len() as u64)
    }

    /// The block of a vertex.
    fn block(&self, vertex: u32) -> u32 {
        vertex.checked_shr(self.block_bits).unwrap_or(0)
    }
}

/// The faces of a draw, three indices each, as cards take them apart.
fn primitives(draw: &Draw<'_>) -> Vec<[u32; 3]> {
    if draw.topology == Topology::TriangleList {
        let (faces, _) = draw.indices.as_chunks();
        return faces.to_vec();
    }
    let mut faces = Vec::new();
    let pieces = draw
        .indices
        .split(|&index| draw.restart && index == RESTART);
    for piece in pieces.filter(|piece| piece.len() >= 3) {
        for i in 0..piece.len() - 2 {
            faces.push(match draw.topology {
                Topology::TriangleFan => [piece[i + 1], piece[i + 2], piece[0]],
                _ if i % 2 == 1 => [piece[i], piece[i + 2], piece[i + 1]],
                _ => [piece[i], piece[i + 1], piece[i + 2]],
            });
        }
    }
    faces
}

/// A corner of the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Corner {
    vertex: u32,
    instance: u32,
    /// The lane of its vertex.
    lane: u32,
    /// Where the run that it is in starts: block or instance changed there.
    run: usize,
}

/// The batches so far.
#[derive(Debug)]
struct Filling {
    rule: BatchRule,
    batches: Vec<Batch>,
    /// All corners so far, of which the last batch has those from `start` on.
    corners: Vec<Corner>,
    start: usize,
}

impl Filling {
    fn new(rule: BatchRule) -> Self {
        Self {
            rule,
            batches: Vec::new(),
            corners: Vec::new(),
            start: 0,
        }
    }

    fn draw(&mut self, vertices: [u32; 3], instance: u32) {
        let first = self.corners.len();
        for vertex in vertices {
            let run = match self.corners.last() {
                Some(last) if self.are_together(last, vertex, instance) => last.run,
                _ => self.corners.len(),
            };
            self.corners.push(Corner {
                vertex,
                instance,
                lane: 0,
                run,
            });
        }

        // Into the last batch, or a new one.
        let missing = (first..first + 3)
            .filter(|&at| self.found(at).is_none())
            .count();
        let has_room = self.batches.last().is_some_and(|batch| {
            batch.faces.len() < self.rule.primitives as usize
                && batch.vertices.len() + missing <= self.rule.lanes as usize
        });
        if !has_room {
            self.batches.push(Batch::default());
            self.start = first;
        }

        // Lanes in corner order.
        let mut lanes = [0; 3];
        for (at, lane) in (first..).zip(&mut lanes) {
            let found = self.found(at).map(|earlier| self.corners[earlier].lane);
            if let Some(batch) = self.batches.last_mut() {
                *lane = found.unwrap_or_else(|| {
                    batch.vertices.push(self.corners[at].vertex);
                    u32::try_from(batch.vertices.len() - 1).expect("at most `lanes`")
                });
            }
            self.corners[at].lane = *lane;
        }
        if let Some(batch) = self.batches.last_mut() {
            batch.faces.push(lanes);
        }
    }

    /// Whether nothing is forgotten between a corner and the next.
    fn are_together(&self, last: &Corner, vertex: u32, instance: u32) -> bool {
        last.instance == instance && self.rule.block(last.vertex) == self.rule.block(vertex)
    }

    /// The last corner before this one at which its vertex is found.
    fn found(&self, at: usize) -> Option<usize> {
        let corner = self.corners[at];
        let oldest = at.saturating_sub(self.rule.window as usize);
        let from = self.start.max(corner.run).max(oldest).min(at);
        let is_same = |earlier: &Corner| earlier.vertex == corner.vertex;
        let found = self.corners[from..at].iter().rposition(is_same);
        found.map(|found| from + found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: BatchRule = BatchRule::NVIDIA;

    fn lanes(draw: &Draw<'_>) -> Vec<usize> {
        let batches = RULE.batches(draw);
        batches.iter().map(|batch| batch.vertices.len()).collect()
    }

    #[test]
    fn a_batch_ends_after_32_faces_or_32_lanes() {
        let repeated = [0, 1, 2].repeat(65);
        assert_eq!(lanes(&Draw::list(&repeated)), [3, 3, 3]);
        let new: Vec<u32> = (0..63).collect();
        assert_eq!(lanes(&Draw::list(&new)), [30, 30, 3]);
        // A face that shares two vertices still fits where one with three new ones does not.
        let sharing: Vec<u32> = (0..30)
            .chain([28, 29, 30, 30, 29, 31, 31, 30, 32])
            .collect();
        assert_eq!(lanes(&Draw::list(&sharing)), [32, 3]);
    }

    #[test]
    fn a_vertex_is_found_42_corners_later_and_not_43() {
        // 0, then `between` corners of other vertices, few of them new, then 0 again.
        let lanes_at = |between: usize| {
            let mut indices = vec![9, 9, 0];
            indices.extend([1, 2, 3].repeat(14));
            indices.truncate(3 + between);
            indices.push(0);
            indices.resize(indices.len().next_multiple_of(3), 0);
            lanes(&Draw::list(&indices))
        };
        assert_eq!(lanes_at(41), [5]);
        assert_eq!(lanes_at(42), [6]);
    }

    #[test]
    fn another_block_forgets_all() {
        let near = [0, 1, 2, 2, 1, 3];
        assert_eq!(lanes(&Draw::list(&near)), [4]);
        let draw = Draw {
            vertex_offset: 65_533,
            ..Draw::list(&near)
        };
        // 65,536 is in a block of its own; no later corner goes back.
        assert_eq!(lanes(&draw), [4]);
        let draw = Draw {
            vertex_offset: 65_534,
            ..Draw::list(&near)
        };
        // … 4, 5, 6 | 6, 5, 7: blocks 0 0 1 | 1 0 1, so 5 and 7 miss.
        assert_eq!(lanes(&draw), [5]);
    }

    #[test]
    fn a_vertex_that_fell_out_gets_a_second_lane() {
        let mut indices = vec![9, 9, 0];
        indices.extend([1, 2, 3].repeat(14));
        indices.extend([0, 0, 0]);
        let batches = RULE.batches(&Draw::list(&indices));
        assert_eq!(batches.len(), 1);
        assert_eq!(batches[0].vertices, [9, 0, 1, 2, 3, 0]);
        assert_eq!(batches[0].faces[0], [0, 0, 1]);
        assert_eq!(batches[0].faces[15], [5, 5, 5]);
    }

    #[test]
    fn strips_fans_and_instances_are_taken_apart() {
        let strip: Vec<u32> = (0..10).collect();
        assert_eq!(lanes(&Draw::strips(&strip)), [10]);
        let fan = Draw {
            topology: Topology::TriangleFan,
            ..Draw::list(&strip)
        };
        assert_eq!(lanes(&fan), [10]);
        let twice = Draw {
            instances: 2,
            reads_instance: true,
            ..Draw::list(&strip[..9])
        };
        assert_eq!(lanes(&twice), [18]);
        let alike = Draw {
            reads_instance: false,
            ..twice
        };
        assert_eq!(lanes(&alike), [9]);
        let apart = [0, 1, 2, RESTART, 0, 2, 1, RESTART, 3];
        assert_eq!(primitives(&Draw::strips(&apart)), [[0, 1, 2], [0, 2, 1]]);
    }
}
