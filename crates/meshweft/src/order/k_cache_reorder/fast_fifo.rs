//! The fast mode for a first-in first-out cache.
//!
//! The output is that of the plain greedy, restricted to the oldest live candidates (`oracle` is
//! that definition by brute force). It is reached without drawing every candidate *tentatively*,
//! that is, drawing its faces to learn the cost and taking them back:
//!
//! - A vertex is in the cache if it entered within the last `K` pushes. So one time stamp a vertex
//!   is the whole cache, and a tentative drawing is undone by restoring a few stamps
//!   ([`TentativeCache`]).
//! - Each vertex knows how many white corners its live faces have, which bounds from below the
//!   pushes that finishing it takes ([`least_neighbours`](crate::order::greedy::least_neighbours)).
//!   A vertex that is pushed or evicted updates the counts of its neighbours. Only the candidate
//!   with the lowest estimate is drawn tentatively; if it costs no more than estimated, no other
//!   can be cheaper.
//! - All costs are integers: a rounding difference would let platforms disagree.
//!
//! Two constant parameters choose the variant: `KEEP_CORNERS` forbids turning corners, `POLYGONS`
//! draws the whole polygon of each face and implies the former.
//!
//! Read `draw_all` first, then `cheapest_candidate`; `push` has the bookkeeping of the cache.

use std::hint::select_unpredictable;

use super::task::Task;
use super::tentative::{Overwritten, TentativeCache};
use crate::index::index32;
use crate::order::greedy::{Costs, Entry, HUB, LiveFaces, Queue, Turn};
use crate::permutation::{FaceOrder, Permutation};

/// Most candidates of a step for any cache; see [`candidate_count`].
const MAX_CANDIDATES: usize = 16;

/// Most candidates drawn tentatively in a step; after that, the cheapest of these is taken.
///
/// On a surface the first or second is chosen. On faces that are not a surface the estimate is poor,
/// and this bounds the work.
pub(super) const MAX_TENTATIVE: u32 = 4;

/// How many of the oldest live vertices in a cache of `size` vertices are candidates for the focus.
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

/// The order in which to draw all faces.
pub(super) fn face_order(task: &Task<'_>, keep_corners: bool) -> FaceOrder {
    let mut traversal = FifoTraversal::new(task);
    match keep_corners {
        true => traversal.draw_all::<true, false>(task.first_focus),
        false => traversal.draw_all::<false, false>(task.first_focus),
    }
    traversal.order()
}

/// As [`face_order`] with corners kept, but draws whole polygons; `polygons` says where the polygon
/// of each face begins and ends.
pub(super) fn polygon_order(task: &Task<'_>, polygons: &[[u32; 2]]) -> FaceOrder {
    let mut traversal = FifoTraversal::new(task);
    traversal.polygons = polygons;
    traversal.draw_all::<true, true>(task.first_focus);
    traversal.order()
}

/// The greedy traversal: the faces that are drawn and the cache after them.
struct FifoTraversal<'a> {
    live: LiveFaces<'a>,
    /// Where the polygon of each face begins and ends; empty if there are no polygons.
    polygons: &'a [[u32; 2]],
    costs: &'a Costs,

    /// Of the cache, in vertices.
    size: u32,
    /// The number of the next push. Starts past the cache size, so that stamp 0 is not in the cache.
    /// It may wrap: ages are wrapping differences.
    clock: u32,
    /// The vertex of each of the last pushes, by the low bits of its number: tells which one leaves.
    pushed: Vec<u32>,
    /// The vertices in the cache by age.
    queue: Queue,

    /// How many candidates a step has at most.
    most_candidates: usize,
    /// The candidates of a step, oldest first. A field, so that it is not cleared each time.
    candidates: [Entry; MAX_CANDIDATES],
    /// The cost of each candidate: estimated, or exact once it was drawn tentatively.
    candidate_costs: [i64; MAX_CANDIDATES],
    gathered: Gathered,
    /// A buffer for tentative drawings, empty between them.
    overwritten: Vec<Overwritten>,

    new_to_old: Vec<u32>,
    rotations: Vec<u8>,
}

/// The live faces of one vertex.
struct Gathered {
    /// Whose faces they are; `None` once one of them may be drawn.
    vertex: Option<u32>,
    /// Only the first `len` count.
    faces: Vec<u32>,
    len: usize,
}

impl<'a> FifoTraversal<'a> {
    /// Nothing is drawn, and the cache is empty.
    fn new(task: &'a Task<'_>) -> Self {
        let Task {
            faces, size, costs, ..
        } = task;
        let size = *size;
        let ring = (size as usize).next_power_of_two();

        Self {
            live: LiveFaces::new(*faces),
            polygons: &[],
            costs,
            size,
            clock: size + 1,
            // The entry past the last vertex is on no face: it leaves without being announced.
            pushed: vec![index32(faces.vertex_count()); ring],
            queue: Queue::new(size),
            most_candidates: candidate_count(size),
            candidates: [(0, 0); MAX_CANDIDATES],
            candidate_costs: [0; MAX_CANDIDATES],
            gathered: Gathered {
                vertex: None,
                faces: vec![0; HUB as usize],
                len: 0,
            },
            overwritten: Vec::with_capacity(2 * HUB as usize),
            new_to_old: Vec::with_capacity(faces.len()),
            rotations: vec![0; faces.len()],
        }
    }

    /// What was drawn, once that is all.
    fn order(self) -> FaceOrder {
        let permutation = Permutation::from_algorithm(self.new_to_old);
        FaceOrder::new(permutation, self.rotations).expect("one rotation below 3 a face")
    }

    /// Finishes one vertex after the other, until all faces are drawn.
    fn draw_all<const KEEP_CORNERS: bool, const POLYGONS: bool>(
        &mut self,
        first_focus: Option<u32>,
    ) {
        const { assert!(KEEP_CORNERS || !POLYGONS, "polygons keep their corners") };

        let mut next = first_focus;
        loop {
            next = next.or_else(|| self.cheapest_candidate::<KEEP_CORNERS, POLYGONS>());
            let Some(focus) = next.or_else(|| self.live.after_dead_end()) else {
                return;
            };
            self.finish::<KEEP_CORNERS, POLYGONS>(focus);
            next = None;
        }
    }

    /// Draws the live faces of `focus`, or their polygons.
    #[inline]
    fn finish<const KEEP_CORNERS: bool, const POLYGONS: bool>(&mut self, focus: u32) {
        // They are at hand if `focus` was the last vertex drawn tentatively.
        if self.gathered.vertex != Some(focus) {
            self.gather(focus);
        }
        self.gathered.vertex = None;

        for i in 0..self.gathered.len {
            let face = self.gathered.faces[i];
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
    }

    #[inline]
    fn gather(&mut self, vertex: u32) {
        self.gathered.len = self.live.gather(vertex, &mut self.gathered.faces);
        self.gathered.vertex = Some(vertex);
    }

    /// The candidate of least cost, ties to the oldest; `None` if no live vertex is in the cache.
    #[inline]
    fn cheapest_candidate<const KEEP_CORNERS: bool, const POLYGONS: bool>(
        &mut self,
    ) -> Option<u32> {
        if self.queue.entries().is_empty() {
            return None;
        }
        let (count, mut best) = self.estimate_candidates();
        if count == 0 {
            return None;
        }

        // Replace the lowest cost by the exact one, until it was no estimate: then no candidate can
        // be cheaper. `tried` is the bit set of the candidates that were drawn tentatively.
        let mut tried = 0_u32;
        loop {
            let (focus, _) = self.candidates[best];
            let is_tried = tried >> best & 1 != 0;
            if is_tried || !self.is_worth_trying::<KEEP_CORNERS, POLYGONS>(focus) {
                return Some(focus);
            }

            let exact = self.tentative_cost::<KEEP_CORNERS, POLYGONS>(focus);
            if exact <= self.candidate_costs[best] {
                return Some(focus);
            }

            // It costs more than estimated. After the last attempt only exact costs compete.
            self.candidate_costs[best] = exact;
            tried |= 1 << best;
            let is_last = tried.count_ones() == MAX_TENTATIVE;
            let rank = |i: usize| {
                let is_out = is_last && tried >> i & 1 == 0;
                (is_out, self.candidate_costs[i])
            };
            best = (0..count).min_by_key(|&i| rank(i)).unwrap_or(0);
        }
    }

    /// Takes the oldest live vertices in the cache as candidates and estimates their costs, which
    /// are never too high on a surface. Returns how many there are, and which one is the cheapest.
    #[inline]
    fn estimate_candidates(&mut self) -> (usize, usize) {
        let (vertices, clock) = (&self.live.vertices[..], self.clock);
        let (mut scanned, mut count) = (0, 0);
        let (mut best, mut least) = (0, i64::MAX);

        // Each entry is written and kept only if it is a candidate: no branch for the processor to
        // guess.
        for &entry in self.queue.entries() {
            let (candidate, entered) = entry;
            let vertex = &vertices[candidate as usize];
            let age = clock.wrapping_sub(vertex.entered);
            let estimate = self.costs.of(vertex.white_neighbours(), vertex.live, age);
            self.candidates[count] = entry;
            self.candidate_costs[count] = estimate;

            let is_candidate = (vertex.live != 0) & (vertex.entered == entered);
            let is_better = is_candidate & (estimate < least);
            best = select_unpredictable(is_better, count, best);
            least = select_unpredictable(is_better, estimate, least);

            count += usize::from(is_candidate);
            scanned += 1;
            if count == self.most_candidates {
                break;
            }
        }

        // Entries that are out of date are not scanned again.
        self.queue.replace_front(scanned, &self.candidates[..count]);
        (count, best)
    }

    /// Whether drawing `focus` tentatively can tell more than the estimate, and is not too long.
    #[inline]
    fn is_worth_trying<const KEEP_CORNERS: bool, const POLYGONS: bool>(&self, focus: u32) -> bool {
        // Without a push, or with one face left whose hits come first, nothing that is needed can be
        // evicted: the estimate is the cost. (With polygons it sees only the faces at this vertex,
        // so it is never exact.)
        let vertex = &self.live.vertices[focus as usize];
        let takes_no_push = !POLYGONS && vertex.white_corners == 0;
        let is_last_face = !KEEP_CORNERS && vertex.live == 1;
        !takes_no_push && !is_last_face && vertex.live <= HUB
    }

    /// The exact cost of `focus`: draws its live faces tentatively.
    #[inline]
    fn tentative_cost<const KEEP_CORNERS: bool, const POLYGONS: bool>(
        &mut self,
        focus: u32,
    ) -> i64 {
        self.gather(focus);
        let gathered = &self.gathered.faces[..self.gathered.len];
        let live = self.live.vertices[focus as usize].live;
        let mut cache =
            TentativeCache::new(&mut self.live, self.size, self.clock, &mut self.overwritten);

        if POLYGONS {
            // The faces of a polygon at this vertex are gathered next to each other. `HUB` faces
            // are drawn at most, which bounds the work: what they cost stands for the rest.
            let mut last = [u32::MAX; 2];
            let mut left = HUB;
            for &face in gathered {
                let polygon = self.polygons[face as usize];
                if std::mem::replace(&mut last, polygon) != polygon {
                    let [start, end] = polygon;
                    let taken = (end - start).min(left);
                    (start..start + taken).for_each(|face| cache.draw::<KEEP_CORNERS>(face));
                    left -= taken;
                }
            }
        } else {
            for &face in gathered {
                cache.draw::<KEEP_CORNERS>(face);
            }
        }

        let cost = self.costs.after_run(cache.pushes(), live, cache.age(focus));
        cache.undo();
        cost
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

    /// Whether a vertex is not in the cache, finished or not.
    #[inline]
    fn is_white(&self, vertex: u32) -> bool {
        let entered = self.live.vertices[vertex as usize].entered;
        self.clock.wrapping_sub(entered) > self.size
    }

    /// Pushes a vertex that is not in the cache; the one pushed `size` pushes ago leaves.
    #[inline]
    fn push(&mut self, vertex: u32) {
        let now = self.clock;
        let size_ago = now.wrapping_sub(self.size);
        let mask = self.pushed.len() - 1;
        let leaving = self.pushed[size_ago as usize & mask];

        self.pushed[now as usize & mask] = vertex;
        self.live.vertices[vertex as usize].entered = now;
        self.clock = now.wrapping_add(1);

        // An unfinished vertex that leaves tells its neighbours. Without its stamp, which is too old
        // by now, no entry of the queue matches it.
        let left = &mut self.live.vertices[leaving as usize];
        if left.live != 0 {
            debug_assert_eq!(left.entered, size_ago, "{leaving} entered once more");
            left.entered = 0;
            self.live.announce_unfinished_exit(leaving);
        }

        // A vertex pushed by its last face is black already, with no live face to announce it to.
        if self.live.vertices[vertex as usize].live == 0 {
            return;
        }
        let vertices = &self.live.vertices;
        self.queue.push((vertex, now), |(vertex, entered)| {
            let vertex = &vertices[vertex as usize];
            vertex.live != 0 && vertex.entered == entered
        });
        self.live.announce_entry(vertex);
    }
}
