//! The rule by which NVIDIA cards collect primitives in batches, with its four numbers open.
//!
//! `meshweft::cache::nvidia` has the numbers of the cards that were probed; here they are searched for
//! on the card at hand. This is a second implementation, kept plain: it looks back through the corners
//! of the batch for every corner.

use crate::draw::{Draw, RESTART, Topology};

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

    /// The batches of one draw: for each, the vertices of its lanes, in lane order.
    ///
    /// # Complexity
    /// Time O(corners · window).
    #[must_use]
    pub fn batches(&self, draw: &Draw<'_>) -> Vec<Vec<u32>> {
        let mut filling = Filling::new(*self);
        let primitives = primitives(draw);
        for instance in 0..draw.instances {
            for primitive in &primitives {
                let corners = primitive.map(|index| index.wrapping_add_signed(draw.vertex_offset));
                filling.draw(corners, instance);
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
        let lanes: usize = batches.iter().map(Vec::len).sum();
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
}

/// The batches so far.
#[derive(Debug)]
struct Filling {
    rule: BatchRule,
    batches: Vec<Vec<u32>>,
    /// The primitives of the last batch.
    primitives: u32,
    /// All corners so far, of which the last batch has those from `start` on.
    corners: Vec<Corner>,
    start: usize,
    /// Where block or instance changed last.
    run: usize,
}

impl Filling {
    fn new(rule: BatchRule) -> Self {
        Self {
            rule,
            batches: Vec::new(),
            // Full: the first primitive starts a batch.
            primitives: u32::MAX,
            corners: Vec::new(),
            start: 0,
            run: 0,
        }
    }

    fn draw(&mut self, vertices: [u32; 3], instance: u32) {
        // The corners, and where each one's run starts.
        let first = self.corners.len();
        let mut runs = [0; 3];
        for (run, vertex) in runs.iter_mut().zip(vertices) {
            let corner = Corner { vertex, instance };
            let is_new = self.corners.last().is_none_or(|before| {
                before.instance != instance
                    || self.rule.block(before.vertex) != self.rule.block(vertex)
            });
            if is_new {
                self.run = self.corners.len();
            }
            *run = self.run;
            self.corners.push(corner);
        }

        // Into the last batch, or a new one.
        let mut missing = self.missing(first, runs);
        let lanes = self.batches.last().map_or(0, Vec::len);
        if self.primitives >= self.rule.primitives
            || lanes + missing.len() > self.rule.lanes as usize
        {
            self.batches.push(Vec::new());
            self.primitives = 0;
            self.start = first;
            missing = self.missing(first, runs);
        }
        self.primitives += 1;
        if let Some(batch) = self.batches.last_mut() {
            batch.extend(missing);
        }
    }

    /// The vertices of the three corners from `first` on that are not found.
    fn missing(&self, first: usize, runs: [usize; 3]) -> Vec<u32> {
        let mut missing = Vec::with_capacity(3);
        for (at, run) in (first..).zip(runs) {
            let oldest = at.saturating_sub(self.rule.window as usize);
            let from = self.start.max(run).max(oldest);
            let corner = self.corners[at];
            if !self.corners[from.min(at)..at].contains(&corner) {
                missing.push(corner.vertex);
            }
        }
        missing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: BatchRule = BatchRule::NVIDIA;

    fn lanes(draw: &Draw<'_>) -> Vec<usize> {
        RULE.batches(draw).iter().map(Vec::len).collect()
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
            ..Draw::list(&strip[..9])
        };
        assert_eq!(lanes(&twice), [18]);
        let apart = [0, 1, 2, RESTART, 0, 2, 1, RESTART, 3];
        assert_eq!(primitives(&Draw::strips(&apart)), [[0, 1, 2], [0, 2, 1]]);
    }
}
