//! The fast mode for a cache whose evictions the program decides.
//!
//! The cost of a vertex is `k1` times its white neighbours minus `k2` times its live faces; the
//! cheapest vertex in the cache is the next focus. A finished vertex leaves at once.
//!
//! To make room, the vertex that will be needed last leaves, as far as costs can tell. A vertex is
//! needed when it becomes the focus, or any vertex in the cache that it still shares a face with. So
//! the least of these costs is compared, then its own, and ties go to the oldest. (The paper
//! compares own costs alone; that is .015 worse on scanned meshes at K = 12.)
//!
//! Both choices look at the oldest vertices only, which bounds a step for any cache size.

use std::hint::select_unpredictable;

use super::task::Task;
use crate::cache::CacheEvent;
use crate::order::greedy::{Costs, Entry, LiveFaces, Queue};
use crate::permutation::{FaceOrder, Permutation};

/// How many of the oldest vertices are looked at. More are no better: on four scanned and CAD
/// meshes the mean ACMR at K = 128 is .517 with 64 and .521 with all.
const CANDIDATES: usize = 64;

/// The order in which to draw all faces; `record` receives each step of the schedule.
pub(super) fn face_order(task: &Task<'_>, record: impl FnMut(CacheEvent)) -> FaceOrder {
    let mut traversal = ControllableTraversal {
        live: LiveFaces::new(task.faces),
        costs: &task.costs,
        size: task.size as usize,
        queue: Queue::new(task.size),
        held: 0,
        pushes: 0,
        record,
        new_to_old: Vec::with_capacity(task.faces.len()),
    };
    traversal.draw_all(task.first_focus);
    Permutation::from_algorithm(traversal.new_to_old).into()
}

/// The greedy traversal: the faces that are drawn and the cache after them.
struct ControllableTraversal<'a, R> {
    live: LiveFaces<'a>,
    costs: &'a Costs,
    /// Of the cache, in vertices.
    size: usize,
    /// The vertices in the cache by age, and the numbers of their pushes.
    queue: Queue,
    /// How many vertices are in the cache.
    held: usize,
    /// The number of the last push; never 0 after the first one, for 0 is not in the cache.
    pushes: u32,
    /// Receives each step of the schedule.
    record: R,
    new_to_old: Vec<u32>,
}

impl<R: FnMut(CacheEvent)> ControllableTraversal<'_, R> {
    /// Finishes one vertex after the other, until all faces are drawn.
    fn draw_all(&mut self, first_focus: Option<u32>) {
        let mut gathered = Vec::new();
        let mut next = first_focus;
        loop {
            next = next.or_else(|| self.cheapest_candidate());
            let Some(focus) = next.or_else(|| self.live.after_dead_end()) else {
                return;
            };

            let count = self.live.gather(focus, &mut gathered);
            for &face in &gathered[..count] {
                self.draw(face);
            }
            next = None;
        }
    }

    /// The oldest vertices in the cache, and how many there are. Entries of vertices that have left
    /// are dropped, so that drawing a hub does not scan them again at every eviction.
    fn oldest(&mut self) -> ([Entry; CANDIDATES], usize) {
        let mut oldest = [(0, 0); CANDIDATES];
        let (mut count, mut scanned) = (0, 0);

        // Each entry is written and kept only if its vertex is in the cache: no branch for the
        // processor to guess.
        for &(vertex, push) in self.queue.entries() {
            if count == CANDIDATES {
                break;
            }
            scanned += 1;
            oldest[count] = (vertex, push);
            count += usize::from(self.live.vertices[vertex as usize].entered == push);
        }

        self.queue.replace_front(scanned, &oldest[..count]);
        (oldest, count)
    }

    /// The vertex of least cost in the cache, ties to the oldest.
    fn cheapest_candidate(&mut self) -> Option<u32> {
        let (oldest, count) = self.oldest();
        let (mut best, mut least) = (None, i64::MAX);
        for &(candidate, _) in &oldest[..count] {
            let cost = self.cost(candidate);
            best = select_unpredictable(cost < least, Some(candidate), best);
            least = select_unpredictable(cost < least, cost, least);
        }
        best
    }

    /// The cost of finishing a vertex in the cache.
    #[inline]
    fn cost(&self, vertex: u32) -> i64 {
        let vertex = &self.live.vertices[vertex as usize];
        self.costs.of(vertex.white_neighbours(), vertex.live, 0)
    }

    /// How late `vertex` is needed, to be compared: the least cost among it and the vertices in the
    /// cache that it shares a live face with, then its own cost.
    fn lateness(&self, vertex: u32) -> (i64, i64) {
        let own = self.cost(vertex);
        let mut least = own;
        self.live.for_each_live_face(vertex, |corners| {
            for corner in corners {
                if self.is_held(corner) {
                    least = least.min(self.cost(corner));
                }
            }
        });
        (least, own)
    }

    #[inline]
    fn is_held(&self, vertex: u32) -> bool {
        self.live.vertices[vertex as usize].entered != 0
    }

    /// Draws a face, unless it is drawn already: makes room for each corner that is not in the
    /// cache and pushes it.
    fn draw(&mut self, face: u32) {
        // Marked first, so that its own pushes and what they evict are not announced to it.
        if !self.live.mark_drawn(face) {
            return;
        }

        let corners = self.live.faces[face as usize];
        let missing = corners.map(|corner| u32::from(!self.is_held(corner)));
        self.live.remove_corners(corners, missing.iter().sum());

        for corner in corners {
            if !self.is_held(corner) {
                if self.held == self.size {
                    self.pop_needed_last(corners);
                }
                self.push(corner);
            }
        }
        (self.record)(CacheEvent::Draw);
        self.new_to_old.push(face);

        // Finished corners leave at once.
        for corner in corners {
            let vertex = &mut self.live.vertices[corner as usize];
            if vertex.live == 0 && vertex.entered != 0 {
                vertex.entered = 0;
                self.held -= 1;
                (self.record)(CacheEvent::Pop(corner));
            }
        }
    }

    /// Pushes a vertex that is not in the cache, which has room for it.
    fn push(&mut self, vertex: u32) {
        debug_assert!(!self.is_held(vertex) && self.held < self.size);
        self.pushes = self.pushes.wrapping_add(1).max(1);
        self.live.vertices[vertex as usize].entered = self.pushes;
        self.held += 1;

        let vertices = &self.live.vertices;
        self.queue.push((vertex, self.pushes), |(vertex, push)| {
            vertices[vertex as usize].entered == push
        });
        self.live.announce_entry(vertex);
        (self.record)(CacheEvent::Push(vertex));
    }

    /// Makes room: the vertex that is needed last leaves, ties to the oldest, but no corner of the
    /// face being drawn.
    fn pop_needed_last(&mut self, corners: [u32; 3]) {
        let (oldest, count) = self.oldest();
        let mut last: Option<(u32, (i64, i64))> = None;
        for &(vertex, _) in &oldest[..count] {
            if corners.contains(&vertex) {
                continue;
            }
            let lateness = self.lateness(vertex);
            if last.is_none_or(|(_, most)| lateness > most) {
                last = Some((vertex, lateness));
            }
        }

        let (leaving, _) = last.expect("a full cache holds more than the other two corners");
        self.live.vertices[leaving as usize].entered = 0;
        self.held -= 1;
        self.live.announce_unfinished_exit(leaving);
        (self.record)(CacheEvent::Pop(leaving));
    }
}
