//! How many misses two sequences save when one is drawn right after the other.

use crate::faces::Faces;

/// Sizes of the FIFO caches in which misses are counted.
const SIZES: Lanes = [10, 12, 16, 64];
const LANES: usize = 4;
/// A number for each cache.
type Lanes = [u32; LANES];

/// How many faces on each side of a seam are simulated.
const REACH: usize = 40;

/// FIFO caches of several sizes, simulated together.
///
/// The corners of a face are looked up before any of them is pushed, as if hits came first.
pub(super) struct SeamCaches<'a> {
    faces: &'a [[u32; 3]],
    /// The number of the push with which each vertex entered each cache.
    entered: Vec<Lanes>,
    pushes: Lanes,
    /// The vertices that a trial changed, as they were before.
    overwritten: Vec<(u32, Lanes)>,
}

/// A way to draw a part: its faces in order, and their misses in empty caches from the front and
/// from the back.
pub(super) struct PartSequence {
    pub(super) faces: Vec<u32>,
    misses: [u32; 2],
    /// The same for the first [`REACH`] faces from either end.
    head_misses: [u32; 2],
}

impl<'a> SeamCaches<'a> {
    pub(super) fn new(faces: Faces<'a>) -> Self {
        Self {
            faces: faces.as_slice(),
            entered: vec![[0; LANES]; faces.vertex_count()],
            pushes: [0; LANES],
            overwritten: Vec::new(),
        }
    }

    /// Empties the caches: as many pushes pass as each one has entries.
    fn empty(&mut self) {
        if self.pushes.iter().any(|&pushes| pushes > u32::MAX / 2) {
            self.entered.fill([0; LANES]);
            self.pushes = [0; LANES];
        }
        for (pushes, size) in self.pushes.iter_mut().zip(SIZES) {
            *pushes += size;
        }
    }

    /// Draws a face; with `UNDO`, remembers what it overwrites.
    #[inline]
    fn draw<const UNDO: bool>(&mut self, face: u32) {
        let corners = self.faces[face as usize];
        let before = corners.map(|corner| self.entered[corner as usize]);
        let start = self.pushes;

        for (corner, before) in corners.into_iter().zip(before) {
            let mut entered = before;
            for lane in 0..LANES {
                let is_missing = start[lane].wrapping_sub(before[lane]) >= SIZES[lane];
                self.pushes[lane] += u32::from(is_missing);
                entered[lane] = if is_missing {
                    self.pushes[lane]
                } else {
                    before[lane]
                };
            }
            if UNDO {
                self.overwritten.push((corner, before));
            }
            self.entered[corner as usize] = entered;
        }
    }

    /// Draws the faces; returns their misses, added up over the caches.
    fn draw_all(&mut self, faces: impl Iterator<Item = u32>) -> u32 {
        let before = self.pushes;
        for face in faces {
            self.draw::<false>(face);
        }
        self.since(before)
    }

    /// How many pushes there were since `before`.
    fn since(&self, before: Lanes) -> u32 {
        let misses = self
            .pushes
            .iter()
            .zip(before)
            .map(|(after, before)| after - before);
        misses.sum()
    }

    /// The misses that drawing the faces would have now; the caches stay as they are.
    fn tried(&mut self, faces: impl Iterator<Item = u32>) -> u32 {
        let before = self.pushes;
        for face in faces {
            self.draw::<true>(face);
        }
        let misses = self.since(before);
        self.pushes = before;
        while let Some((vertex, before)) = self.overwritten.pop() {
            self.entered[vertex as usize] = before;
        }
        misses
    }

    /// A piece: its faces in the given order.
    pub(super) fn sequence(&mut self, faces: Vec<u32>) -> PartSequence {
        self.empty();
        let forward = self.draw_all(faces.iter().copied());
        self.empty();
        let backward = self.draw_all(faces.iter().rev().copied());
        self.with_heads(faces, [forward, backward], [None; 2])
    }

    /// The sequence with the misses of its first faces from both ends, which are counted where they
    /// are not `known`.
    fn with_heads(
        &mut self,
        faces: Vec<u32>,
        misses: [u32; 2],
        known: [Option<u32>; 2],
    ) -> PartSequence {
        let mut sequence = PartSequence {
            faces,
            misses,
            head_misses: misses,
        };
        if sequence.faces.len() > REACH {
            sequence.head_misses = [0, 1].map(|end| {
                known[end].unwrap_or_else(|| {
                    self.empty();
                    self.draw_all(sequence.from(end == 1).take(REACH))
                })
            });
        }
        sequence
    }

    /// The best of the eight ways to draw two sequences one after the other: either first, each
    /// forward or backward.
    pub(super) fn joined(&mut self, pair: [PartSequence; 2]) -> PartSequence {
        // A way is three bits: which is first, whether it is reversed, whether the other one is.
        // The second sequence meets a cache that the end of the first one has filled.
        let mut misses = [0_u32; 8];
        for (way, misses) in misses.chunks_exact_mut(2).enumerate() {
            let (first, turned) = (way >> 1, way & 1);
            let (a, b) = (&pair[first], &pair[1 - first]);
            self.empty();
            let before_last = a.faces.len().saturating_sub(REACH);
            self.draw_all(a.from(turned == 1).skip(before_last));
            for (other, misses) in misses.iter_mut().enumerate() {
                let warm = self.tried(b.from(other == 1).take(REACH));
                *misses = a.misses[turned] + b.misses[other] + warm - b.head_misses[other];
            }
        }

        // Read from the back, a way is the other sequence, reversed, before the first one,
        // reversed.
        let backward = |way: usize| {
            let (other, turned, other_turned) = (1 - (way >> 2), 1 - (way & 1), 1 - (way >> 1 & 1));
            other << 2 | turned << 1 | other_turned
        };

        let ways = 0..misses.len();
        let best = ways.min_by_key(|&way| (misses[way], misses[backward(way)]));
        let way = best.unwrap_or_default();

        let (first, a, b) = (way >> 2, way >> 1 & 1, way & 1);
        let (front, back) = (&pair[first], &pair[1 - first]);
        let faces = front.from(a == 1).chain(back.from(b == 1)).collect();
        let head = |sequence: &PartSequence, end: usize| {
            (sequence.faces.len() >= REACH).then(|| sequence.head_misses[end])
        };
        let misses = [misses[way], misses[backward(way)]];
        self.with_heads(faces, misses, [head(front, a), head(back, 1 - b)])
    }
}

impl PartSequence {
    /// Its faces, from the front or from the back.
    fn from(&self, backward: bool) -> impl Iterator<Item = u32> {
        let last = self.faces.len().wrapping_sub(1);
        let at = move |i: usize| if backward { last - i } else { i };
        (0..self.faces.len()).map(move |i| self.faces[at(i)])
    }
}
