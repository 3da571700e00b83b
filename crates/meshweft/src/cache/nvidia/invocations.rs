//! Invocations alone: what a pass over an order asks again and again.

use super::batcher::{BATCH_FACES, LANES, WINDOW};
use crate::index::{block_of, index32};

/// Invocations of the vertex shader for a draw of these faces, whose vertices are below `vertex_count`:
/// as [`counts`](super::counts()) has them. Vertices are indexed here and not looked up by a hash.
///
/// # Complexity
/// Time O(faces), space 4 bytes a vertex.
pub(crate) fn invocations(faces: &[[u32; 3]], vertex_count: usize) -> u64 {
    let mut uses = Uses {
        last: vec![0; vertex_count],
        now: 1,
        first: 1,
        block: u32::MAX,
    };
    let (mut invocations, mut primitives, mut lanes) = (0, 0, 0);
    for &face in faces {
        if primitives == BATCH_FACES {
            (primitives, lanes) = (0, 0);
            uses.first = uses.now;
        }
        let mut misses = uses.misses(face);
        if lanes + misses > LANES {
            (primitives, lanes) = (0, 0);
            uses.first = uses.now;
            misses = uses.misses(face);
        }
        uses.note(face);
        primitives += 1;
        lanes += misses;
        invocations += u64::from(misses);
    }
    invocations
}

/// When vertices were used. Corners are numbered from 1 through the whole draw.
struct Uses {
    /// The number of each vertex's last corner, 0 before the first.
    last: Vec<u32>,
    /// The number of the next corner.
    now: u32,
    /// The first corner of the batch, or after the last change of block if that is later.
    first: u32,
    /// The block of the last corner.
    block: u32,
}

impl Uses {
    /// How many corners of a face miss if it is drawn next.
    #[inline]
    fn misses(&self, face: [u32; 3]) -> u32 {
        if face.map(block_of) != [self.block; 3] {
            return self.misses_across(face);
        }
        let [a, b, c] = face;
        // What is used again by this face is found there.
        let is_first = [true, b != a, c != a && c != b];
        let misses = (self.now..)
            .zip(face)
            .zip(is_first)
            .map(|((now, v), is_first)| {
                let is_hit = self.last[v as usize] >= self.first.max(now.saturating_sub(WINDOW));
                u32::from(is_first && !is_hit)
            });
        misses.sum()
    }

    /// The same where a corner may be in another block than the one before it.
    #[cold]
    fn misses_across(&self, face: [u32; 3]) -> u32 {
        let (mut first, mut block, mut misses) = (self.first, self.block, 0);
        for (corner, &vertex) in face.iter().enumerate() {
            let now = self.now + index32(corner);
            if block_of(vertex) != block {
                (first, block) = (now, block_of(vertex));
            }
            let earlier = face[..corner].iter().rposition(|&v| v == vertex);
            let last = match earlier {
                Some(earlier) => self.now + index32(earlier),
                None => self.last[vertex as usize],
            };
            misses += u32::from(last < first.max(now.saturating_sub(WINDOW)));
        }
        misses
    }

    /// Notes that a face is drawn.
    #[inline]
    fn note(&mut self, face: [u32; 3]) {
        for vertex in face {
            if block_of(vertex) != self.block {
                (self.first, self.block) = (self.now, block_of(vertex));
            }
            self.last[vertex as usize] = self.now;
            self.now += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache::nvidia::counts;
    use crate::random::SplitMix64;

    #[test]
    fn are_those_of_the_full_counts() {
        for case in 0..3000 {
            let mut numbers = SplitMix64(case);
            let span = 2 + numbers.below(60);
            let base = [0, 65_500, 131_000][numbers.below(3)];
            let step = 1 + numbers.below(4);
            let faces: Vec<[u32; 3]> = (0..numbers.below(300))
                .map(|i| [0; 3].map(|_| index32(base + i / step + numbers.below(span))))
                .collect();
            let vertex_count = base + 400;
            let found = invocations(&faces, vertex_count);
            let counted = counts(&faces).invocations;
            assert_eq!(found, counted, "case {case}");
        }
    }
}
