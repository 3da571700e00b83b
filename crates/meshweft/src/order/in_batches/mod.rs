//! Faces in a better order inside each batch of an NVIDIA card.
//!
//! Which faces share a batch decides how many vertices are transformed; where they stand in it decides
//! what primitive setup costs, and whether a vertex is still found
//! ([`cache::nvidia`](crate::cache::nvidia)). So any order can be followed batch by batch, and the faces
//! of each batch drawn in another order.
//!
//! Read [`InBatches::follow`] first, which cuts the batches as the card does. `batch` numbers the
//! vertices of one from 0, `growth` makes orders of its faces and counts what they cost. `exchange` is apart: it
//! changes which faces share a batch.

mod batch;
mod exchange;
mod growth;
#[cfg(test)]
mod tests;

use std::cell::LazyCell;

use crate::cache::nvidia::{self, Batcher, LANES};
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};
pub(in crate::order) use batch::BESIDE_SIZE;
use batch::{Batch, MOST_FACES};
pub(in crate::order) use exchange::{Annealing, exchanged};
use growth::Grower;

/// The pass: how much it tries, and what else it looks after.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InBatches {
    /// How many faces of each batch are tried as its first one, at most.
    pub starts: u32,
    /// How many faces may be drawn next: the first ones, in the order that is followed, of those that
    /// are left. A few keep the order good for other caches; 32 and more: every face of the batch.
    pub reach: u32,
    /// What a miss in a FIFO cache of 10 vertices weighs, in 64ths of a setup cycle; 0: nothing.
    pub beside: u32,
}

impl InBatches {
    /// For the card alone.
    pub const ALONE: Self = Self {
        starts: 8,
        reach: 32,
        beside: 0,
    };
    /// For orders that are to serve other caches too: of the next two faces the better one, a miss
    /// weighs a cycle. Setup takes 6.8 % fewer cycles in the mean of six meshes, and the smallest cache
    /// of the universal target, of 10 vertices, misses 2.6 % more, the others .6 % at most
    /// (`cd compare && cargo run --release --bin card`).
    pub const BESIDE_OTHERS: Self = Self {
        starts: 2,
        reach: 2,
        beside: 64,
    };
}

impl Default for InBatches {
    fn default() -> Self {
        Self::ALONE
    }
}

impl InBatches {
    /// The order, with the faces inside each batch moved so that setup takes fewer cycles, and never with
    /// more invocations than before.
    ///
    /// A batch that runs across a border between blocks of 65,536 vertices keeps its faces from the first
    /// one across. Degenerate faces stay where they are. Corners are not turned.
    ///
    /// # Panics
    /// If the order is of another number of faces.
    ///
    /// # Complexity
    /// Time O(faces · starts), space 30 bytes a face and 4 bytes a vertex.
    ///
    /// ```
    /// use meshweft::{FaceOrder, cache::nvidia, order::InBatches};
    /// // Two strips of 14 faces, drawn in turn.
    /// let strip = |i: u32| [i, i + 1, i + 2];
    /// let faces: Vec<_> = (0..12).flat_map(|i| [strip(i), strip(16 + 5 * i % 12)]).collect();
    /// let order = InBatches::default().follow(&faces, &FaceOrder::identity(faces.len()));
    /// let cycles = [&faces, &order.apply(&faces)].map(|faces| nvidia::counts(faces).setup_cycles);
    /// assert_eq!(cycles, [43, 29]);
    /// ```
    #[must_use]
    pub fn follow<'a>(&self, faces: impl Into<Faces<'a>>, order: &FaceOrder) -> FaceOrder {
        self.follow_whole(faces.into(), order, None)
    }

    /// As [`follow`](Self::follow), with the faces of each polygon kept together and in their order;
    /// `polygons` has the first face and the end of the polygon of each face.
    pub(in crate::order) fn follow_whole(
        &self,
        faces: Faces<'_>,
        order: &FaceOrder,
        polygons: Option<&[[u32; 2]]>,
    ) -> FaceOrder {
        assert_eq!(order.len(), faces.len(), "face order of another length");
        let ordered = order.apply(faces.as_slice());
        let polygons = polygons.map(|polygons| {
            let first = |&face: &u32| polygons[face as usize][0];
            order.new_to_old().iter().map(first).collect::<Vec<u32>>()
        });

        let found = match self.beside {
            0 => self.found::<false>(&ordered, faces.vertex_count(), polygons.as_deref()),
            _ => self.found::<true>(&ordered, faces.vertex_count(), polygons.as_deref()),
        };
        found.map_or_else(|| order.clone(), |found| order.then(&found))
    }

    /// An order of faces that are `ordered` already, if it has no more invocations; `polygons` names the
    /// polygon of each.
    fn found<const BESIDE: bool>(
        &self,
        ordered: &[[u32; 3]],
        vertex_count: usize,
        polygons: Option<&[u32]>,
    ) -> Option<FaceOrder> {
        // A batch that loses nothing any more may hold more faces than before. Those after it then begin
        // elsewhere, and may by bad luck need more vertices: if so, such batches stay as they are.
        let invocations = LazyCell::new(|| nvidia::invocations(ordered, vertex_count));
        for extends in [true, false] {
            let mut pass = Pass::<BESIDE>::new(*self, ordered, polygons);
            let is_cut_anew = pass.run(extends);
            if !is_cut_anew || pass.invocations() <= *invocations {
                return Some(Permutation::from_algorithm(pass.new_to_old).into());
            }
        }
        None
    }
}

/// The order of all faces, while it is made.
struct Pass<'a, const BESIDE: bool> {
    settings: InBatches,
    /// In the order that is followed.
    faces: &'a [[u32; 3]],
    /// The polygon of each of them, where polygons stay whole.
    polygons: Option<&'a [u32]>,
    /// What the card has drawn: the faces in their new order, without batches that are full.
    card: Batcher,
    /// The invocations of these.
    in_full_batches: u64,
    batch: Batch,
    grower: Grower<BESIDE>,
    new_to_old: Vec<u32>,
    is_cut_anew: bool,
}

impl<'a, const BESIDE: bool> Pass<'a, BESIDE> {
    fn new(settings: InBatches, faces: &'a [[u32; 3]], polygons: Option<&'a [u32]>) -> Self {
        Self {
            settings,
            faces,
            polygons,
            card: Batcher::new(),
            in_full_batches: 0,
            batch: Batch::default(),
            grower: Grower::new(settings.reach, settings.beside),
            new_to_old: Vec::with_capacity(faces.len()),
            is_cut_anew: false,
        }
    }

    /// Draws all faces; returns whether a batch may hold other faces than before, or faces after those
    /// that were moved. `extends`: batches that lose vertices from the window are improved too.
    fn run(&mut self, extends: bool) -> bool {
        let mut is_moved = false;
        while let Some(&next) = self.faces.get(self.new_to_old.len()) {
            let goes_on = self.card.primitives() > 0 && self.card.fits(next);
            self.is_cut_anew |= goes_on && is_moved;
            is_moved = !goes_on && self.draw_batch(extends);
            if !is_moved {
                self.draw(self.new_to_old.len());
            }
        }
        self.is_cut_anew
    }

    /// Draws the faces of the next batch in the best order found, as many as may move; returns whether it
    /// drew any.
    fn draw_batch(&mut self, extends: bool) -> bool {
        // The faces that a batch holds.
        let start = self.new_to_old.len();
        self.batch.fill(self.faces, start, self.polygons);
        if self.batch.len() < 2 {
            return false;
        }
        let before = self.grower.replay(&self.batch);
        if before.lost + self.batch.vertex_count() > LANES {
            self.is_cut_anew = true;
            if !extends {
                return false;
            }
        }

        // A face that fits in the batch before would be drawn in that one.
        let card = &self.card;
        let is_free = card.primitives() == 0 || self.batch.fixed() > 0;
        let may_start = |face: usize| is_free || !card.fits(self.faces[start + face]);
        let starts = self.settings.starts;
        let (order, cost) = self.grower.best(&self.batch, before, starts, may_start);
        let order = &order[..self.batch.len()];

        // A full batch is what it costs; the card need not draw it to know.
        let lanes = cost.lost + self.batch.vertex_count();
        if order.len() == MOST_FACES && lanes <= LANES {
            self.card.close();
            self.in_full_batches += u64::from(lanes);
            for &face in order {
                self.pass(start + usize::from(face));
            }
        } else {
            for &face in order {
                self.draw(start + usize::from(face));
            }
        }
        true
    }

    /// Invocations so far.
    fn invocations(&self) -> u64 {
        self.card.invocations() + self.in_full_batches
    }

    /// Draws a face.
    fn draw(&mut self, face: usize) {
        self.card.draw(&self.faces[face], 0);
        self.pass(face);
    }

    /// Notes a face that the card draws next.
    fn pass(&mut self, face: usize) {
        self.grower.passed(self.faces[face]);
        self.new_to_old.push(index32(face));
    }
}
