//! The fast mode for a first-in first-out cache.
//!
//! The output is that of the plain greedy, restricted to the oldest live candidates (`oracle` is
//! that definition by brute force). It is reached without drawing every candidate *tentatively*,
//! that is, drawing its faces to learn the cost and taking them back:
//!
//! - A vertex is in the cache if it entered within the last `K` pushes. So one time stamp a vertex
//!   is the whole cache, and a tentative drawing is undone by restoring a few stamps.
//! - Each vertex knows how many white corners its live faces have, which bounds from below the
//!   pushes that finishing it takes ([`least_neighbours`](crate::order::greedy::least_neighbours)).
//!   A push or an eviction updates the counts of its neighbours. Only the candidate with the lowest
//!   estimate is drawn tentatively; if it costs no more than estimated, no other can be cheaper.
//! - All costs are integers: a rounding difference would let platforms disagree.
//!
//! Two constant parameters choose the variant: `KEEP_CORNERS` forbids turning corners, `POLYGONS`
//! draws the whole polygon of each face.

use std::hint::select_unpredictable;

use super::task::Task;
use crate::index::index32;
use crate::order::greedy::{Costs, Entry, HUB, LiveFaces, Queue, Turn};
use crate::permutation::{FaceOrder, Permutation};

/// Most candidates looked at; see [`candidate_count`].
const MAX_CANDIDATES: usize = 16;

/// Most candidates drawn tentatively in a step; after that, the cheapest of these is taken. On a
/// surface the first or second is chosen. On faces that are not a surface the estimate is poor, and
/// this bounds the work.
pub(super) const MAX_TENTATIVE: u32 = 4;

/// How many of the oldest live vertices in the cache are candidates for the focus.
///
/// On eight scanned and CAD meshes, in file order and shuffled, more candidates change the mean
/// ACMR by less than .0005.
pub(super) fn candidate_count(size: u32) -> usize {
    match size {
        0..=23 => 9,
        24..=47 => 14,
        _ => MAX_CANDIDATES,
    }
}

/// Draws all faces.
pub(super) fn face_order(task: &Task<'_>, keep_corners: bool) -> FaceOrder {
    let mut growth = FifoGrowth::new(task);
    match keep_corners {
        true => growth.grow::<true, false>(task.first_focus),
        false => growth.grow::<false, false>(task.first_focus),
    }
    growth.order()
}

/// As [`face_order`] with corners kept, but draws whole polygons; `polygons` says where the polygon
/// of each face begins and ends.
pub(super) fn polygon_order(task: &Task<'_>, polygons: &[[u32; 2]]) -> FaceOrder {
    let mut growth = FifoGrowth::new(task);
    growth.polygons = polygons;
    growth.grow::<true, true>(task.first_focus);
    growth.order()
}

/// The drawn faces, which grow around one focus vertex after the other, and the cache.
struct FifoGrowth<'a> {
    live: LiveFaces<'a>,
    /// Where the polygon of each face begins and ends; empty if there are no polygons.
    polygons: &'a [[u32; 2]],
    costs: &'a Costs,
    size: u32,
    candidates: usize,
    /// Counts pushes; starts past the cache size, so that stamp 0 is not in the cache. Wraps.
    clock: u32,
    /// The vertex of each of the last pushes, by the low bits of the clock: tells which one leaves.
    pushed: Vec<u32>,
    queue: Queue,
    /// The candidates of a step; a field, so that it is not cleared each time.
    oldest: [Entry; MAX_CANDIDATES + 1],
    tentative: Tentative,
    new_to_old: Vec<u32>,
    rotations: Vec<u8>,
}

/// The live faces of one vertex, and what drawing them tentatively overwrote.
struct Tentative {
    vertex: Option<u32>,
    /// Only the first `len` count.
    faces: Vec<u32>,
    len: usize,
    /// Overwritten stamps: vertex, stamp.
    undo: Vec<(u32, u32)>,
}

impl<'a> FifoGrowth<'a> {
    fn new(task: &'a Task<'_>) -> Self {
        let Task {
            faces, size, costs, ..
        } = task;
        let size = *size;
        let ring = (size as usize + 1).next_power_of_two();

        Self {
            live: LiveFaces::new(*faces),
            polygons: &[],
            costs,
            size,
            candidates: candidate_count(size),
            clock: size + 1,
            // The entry past the last vertex is on no face: it leaves without being announced.
            pushed: vec![index32(faces.vertex_count()); ring],
            queue: Queue::new(size),
            oldest: [(0, 0); MAX_CANDIDATES + 1],
            tentative: Tentative {
                vertex: None,
                faces: vec![0; HUB as usize],
                len: 0,
                undo: Vec::with_capacity(2 * HUB as usize),
            },
            new_to_old: Vec::with_capacity(faces.len()),
            rotations: vec![0; faces.len()],
        }
    }

    fn order(self) -> FaceOrder {
        let permutation = Permutation::from_algorithm(self.new_to_old);
        FaceOrder::new(permutation, self.rotations).expect("one rotation below 3 a face")
    }

    /// Finishes one vertex after the other.
    fn grow<const KEEP_CORNERS: bool, const POLYGONS: bool>(&mut self, first_focus: Option<u32>) {
        let mut next = first_focus;
        loop {
            // Choose the focus.
            next = next.or_else(|| self.cheapest_candidate::<KEEP_CORNERS, POLYGONS>());
            let Some(focus) = next.or_else(|| self.live.after_dead_end()) else {
                return;
            };

            // Its live faces are at hand if it was the last one drawn tentatively.
            if self.tentative.vertex != Some(focus) {
                self.gather(focus);
            }
            self.tentative.vertex = None;

            for i in 0..self.tentative.len {
                let face = self.tentative.faces[i];
                match POLYGONS {
                    false => self.draw::<KEEP_CORNERS>(face),
                    // Its other faces at this vertex come up again; `draw` skips them.
                    true => {
                        let [start, end] = self.polygons[face as usize];
                        for face in start..end {
                            self.draw::<KEEP_CORNERS>(face);
                        }
                    }
                }
            }
            next = None;
        }
    }

    #[inline]
    fn gather(&mut self, vertex: u32) {
        self.tentative.len = self.live.gather(vertex, &mut self.tentative.faces);
        self.tentative.vertex = Some(vertex);
    }

    /// The candidate of least cost, ties to the oldest; `None` if no live vertex is in the cache.
    #[inline]
    fn cheapest_candidate<const KEEP_CORNERS: bool, const POLYGONS: bool>(
        &mut self,
    ) -> Option<u32> {
        if self.queue.entries().is_empty() {
            return None;
        }

        // Estimate the oldest live vertices. Each queue entry is written and kept only if it is a
        // candidate: no branch for the processor to guess.
        let mut cost = [0_i64; MAX_CANDIDATES + 1];
        let oldest = &mut self.oldest;
        let mut count = 0;
        let mut scanned = 0;
        let mut best = 0;
        let mut least = i64::MAX;
        let (vertices, clock) = (&self.live.vertices[..], self.clock);
        for &entry in self.queue.entries() {
            let (candidate, entered) = entry;
            let vertex = &vertices[candidate as usize];
            let age = clock.wrapping_sub(vertex.entered);
            let estimate = self.costs.of(vertex.white_neighbours(), vertex.live, age);
            oldest[count] = entry;
            cost[count] = estimate;

            let is_candidate = (vertex.live != 0) & (vertex.entered == entered);
            let is_better = is_candidate & (estimate < least);
            best = select_unpredictable(is_better, count, best);
            least = select_unpredictable(is_better, estimate, least);

            count += usize::from(is_candidate);
            scanned += 1;
            if count == self.candidates {
                break;
            }
        }

        // Entries that are out of date are not scanned again.
        self.queue.replace_front(scanned, &oldest[..count]);
        if count == 0 {
            return None;
        }

        // Replace the lowest estimate by the exact cost until no candidate can be cheaper. `tried`
        // is the bit set of the candidates whose cost is exact.
        let mut tried = 0_u32;
        loop {
            let (focus, _) = self.oldest[best];
            let vertex = &self.live.vertices[focus as usize];

            // Without a push, or with one face left whose hits come first, nothing that is needed
            // can be evicted: the estimate is the cost. (With polygons the estimate sees only the
            // faces at this vertex, so it is never exact.)
            let is_exact =
                (!POLYGONS && vertex.white_corners == 0) || (!KEEP_CORNERS && vertex.live == 1);
            if is_exact || tried >> best & 1 != 0 || vertex.live > HUB {
                return Some(focus);
            }

            let exact = self.tentative_cost::<KEEP_CORNERS, POLYGONS>(focus);
            if exact <= cost[best] {
                return Some(focus);
            }

            // It costs more than estimated. After the last attempt only exact costs compete.
            cost[best] = exact;
            tried |= 1 << best;
            let is_last = tried.count_ones() == MAX_TENTATIVE;
            let rank = |i: usize| (is_last && tried >> i & 1 == 0, cost[i]);
            best = (0..count).min_by_key(|&i| rank(i)).unwrap_or(0);
        }
    }

    /// The exact cost of `focus`: draws its live faces on the time stamps, then restores these.
    #[inline]
    fn tentative_cost<const KEEP_CORNERS: bool, const POLYGONS: bool>(
        &mut self,
        focus: u32,
    ) -> i64 {
        self.gather(focus);

        // As the real drawing, without counts and announcements.
        let (size, mut clock) = (self.size, self.clock);
        let (vertices, undo) = (&mut self.live.vertices[..], &mut self.tentative.undo);
        let mut draw = |face: u32| {
            let corners = self.live.faces[face as usize];
            let missing = corners.map(|corner| {
                let entered = vertices[corner as usize].entered;
                u32::from(clock.wrapping_sub(entered) > size)
            });
            for corner in Turn::new::<KEEP_CORNERS>(missing).pushes(corners) {
                let entered = &mut vertices[corner as usize].entered;
                if clock.wrapping_sub(*entered) > size {
                    undo.push((corner, *entered));
                    *entered = clock;
                    clock = clock.wrapping_add(1);
                }
            }
        };

        let gathered = &self.tentative.faces[..self.tentative.len];
        if POLYGONS {
            // The faces of a polygon at this vertex are gathered next to each other. After as many
            // faces as a hub has, drawing stops: the cost so far is more than another's.
            let mut last = [u32::MAX; 2];
            let mut left = HUB;
            for &face in gathered {
                let polygon = self.polygons[face as usize];
                if std::mem::replace(&mut last, polygon) != polygon {
                    let [start, end] = polygon;
                    let taken = (end - start).min(left);
                    (start..start + taken).for_each(&mut draw);
                    left -= taken;
                }
            }
        } else {
            for &face in gathered {
                draw(face);
            }
        }

        // Read the age, then restore the stamps, the last one first: a vertex may be there twice.
        let vertex = vertices[focus as usize];
        let age = clock.wrapping_sub(vertex.entered);
        while let Some((corner, entered)) = undo.pop() {
            vertices[corner as usize].entered = entered;
        }

        let pushes = clock.wrapping_sub(self.clock);
        self.costs.after_run(pushes, vertex.live, age)
    }

    /// Draws a face, unless it is drawn already: turns its corners so that hits come first, and
    /// pushes its misses.
    #[inline]
    fn draw<const KEEP_CORNERS: bool>(&mut self, face: u32) {
        // Marked first, so that its own pushes and what they evict are not announced to it.
        if !self.live.mark_drawn(face) {
            return;
        }

        let corners = self.live.faces[face as usize];
        let missing = corners.map(|corner| u32::from(self.is_white(corner)));
        let turn = Turn::new::<KEEP_CORNERS>(missing);
        self.live.remove_corners(corners, turn.misses);
        self.rotations[self.new_to_old.len()] = turn.rotation;
        self.new_to_old.push(face);

        for corner in turn.pushes(corners) {
            // A face may name a vertex twice, and with kept corners an earlier push may have
            // evicted a corner that was there.
            if self.is_white(corner) {
                self.push(corner);
            }
        }
    }

    #[inline]
    fn is_white(&self, vertex: u32) -> bool {
        let entered = self.live.vertices[vertex as usize].entered;
        self.clock.wrapping_sub(entered) > self.size
    }

    /// Pushes a white vertex, and evicts the vertex that was pushed `size` pushes ago, if that was
    /// its last push.
    #[inline]
    fn push(&mut self, vertex: u32) {
        let mask = self.pushed.len() - 1;
        let leaving = self.pushed[self.clock.wrapping_sub(self.size) as usize & mask];
        self.pushed[self.clock as usize & mask] = vertex;
        let entered = self.clock;
        self.live.vertices[vertex as usize].entered = entered;
        self.clock = self.clock.wrapping_add(1);

        if self.live.vertices[leaving as usize].live != 0 {
            // Its stamp is too old by now. Without a stamp no entry of the queue matches it.
            self.live.vertices[leaving as usize].entered = 0;
            self.live.announce_unfinished_exit(leaving);
        }

        if self.live.vertices[vertex as usize].live == 0 {
            // Pushed by its last face: black already, with no live face to announce it to.
            return;
        }
        let vertices = &self.live.vertices;
        self.queue.push((vertex, entered), |(vertex, entered)| {
            let vertex = &vertices[vertex as usize];
            vertex.live != 0 && vertex.entered == entered
        });
        self.live.announce_entry(vertex);
    }
}
