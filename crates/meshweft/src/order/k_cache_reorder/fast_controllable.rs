//! The fast mode for a cache whose evictions the program decides.
//!
//! The cost of a vertex is `k1` times its white neighbours minus `k2` times its live faces. It is
//! computed for all vertices in the cache when a focus is chosen, and whoever has to leave while
//! the focus is finished is chosen by that cost: the dearest, ties to the oldest. A finished vertex
//! leaves at once.

use std::hint::select_unpredictable;

use super::costs::Costs;
use super::live_faces::LiveFaces;
use crate::cache::CacheEvent;
use crate::permutation::{FaceOrder, Permutation};

/// Draws all faces; `record` receives each step of the schedule.
pub(super) fn face_order(
    faces: &[[u32; 3]],
    vertex_count: usize,
    size: u32,
    costs: &Costs,
    first_focus: Option<u32>,
    record: impl FnMut(CacheEvent),
) -> FaceOrder {
    let mut growth = Growth {
        live: LiveFaces::new(faces, vertex_count),
        costs,
        size: size as usize,
        buffer: Vec::with_capacity(2 * size as usize),
        buffer_costs: Vec::with_capacity(size as usize),
        held: 0,
        pushes: 0,
        record,
        new_to_old: Vec::with_capacity(faces.len()),
    };
    growth.run(first_focus);
    Permutation::from_algorithm(growth.new_to_old).into()
}

struct Growth<'a, R> {
    live: LiveFaces<'a>,
    costs: &'a Costs,
    size: usize,
    /// The vertices in the cache and the number of their push, from the oldest on; with some that
    /// have left since the focus was chosen.
    buffer: Vec<(u32, u32)>,
    /// Their costs when the focus was chosen; shorter by those that entered since.
    buffer_costs: Vec<i64>,
    /// How many vertices are in the cache.
    held: usize,
    pushes: u32,
    record: R,
    new_to_old: Vec<u32>,
}

impl<R: FnMut(CacheEvent)> Growth<'_, R> {
    fn run(&mut self, first_focus: Option<u32>) {
        let mut run = Vec::new();
        let mut next = first_focus;
        loop {
            let cheapest = self.cheapest_candidate();
            next = next.or(cheapest);
            let Some(focus) = next.or_else(|| self.live.after_dead_end()) else {
                return;
            };
            let count = self.live.gather(focus, &mut run);
            for &face in &run[..count] {
                self.draw(face);
            }
            next = None;
        }
    }

    /// The vertex of least cost in the cache, ties to the oldest; computes and keeps all costs.
    fn cheapest_candidate(&mut self) -> Option<u32> {
        let vertices = &self.live.vertices;
        self.buffer
            .retain(|&(v, push)| vertices[v as usize].entered == push);
        self.buffer_costs.clear();
        let mut best = None;
        let mut least = i64::MAX;
        for &(candidate, _) in &self.buffer {
            let vertex = &vertices[candidate as usize];
            let cost = self.costs.of(vertex.white_neighbours(), vertex.live, 0);
            self.buffer_costs.push(cost);
            best = select_unpredictable(cost < least, Some(candidate), best);
            least = select_unpredictable(cost < least, cost, least);
        }
        best
    }

    fn draw(&mut self, face: u32) {
        if !self.live.mark_drawn(face) {
            return;
        }
        let corners = self.live.faces[face as usize];
        let missing = corners.map(|corner| {
            let vertex = &self.live.vertices[corner as usize];
            u32::from(vertex.entered == 0)
        });
        self.live.remove_corners(corners, missing.iter().sum());
        for corner in corners {
            if self.live.vertices[corner as usize].entered == 0 {
                if self.held == self.size {
                    self.pop_dearest(corners);
                }
                self.push(corner);
            }
        }
        (self.record)(CacheEvent::Draw);
        self.new_to_old.push(face);
        for corner in corners {
            let vertex = &mut self.live.vertices[corner as usize];
            if vertex.live == 0 && vertex.entered != 0 {
                vertex.entered = 0;
                self.held -= 1;
                (self.record)(CacheEvent::Pop(corner));
            }
        }
    }

    fn push(&mut self, vertex: u32) {
        self.pushes = self.pushes.wrapping_add(1).max(1);
        self.live.vertices[vertex as usize].entered = self.pushes;
        self.held += 1;
        self.buffer.push((vertex, self.pushes));
        self.live.announce_entry(vertex);
        (self.record)(CacheEvent::Push(vertex));
    }

    /// Makes room: the vertex of greatest cost leaves, ties to the oldest, no corner of the face
    /// being drawn; one that entered since the focus was chosen only if there is no other.
    fn pop_dearest(&mut self, corners: [u32; 3]) {
        let vertices = &self.live.vertices;
        let may_leave = |&(entry, push): &(u32, u32)| {
            vertices[entry as usize].entered == push && !corners.contains(&entry)
        };
        let (mut dearest, mut most) = (None, i64::MIN);
        for (entry, &cost) in self.buffer.iter().zip(&self.buffer_costs) {
            if cost > most && may_leave(entry) {
                (dearest, most) = (Some(entry.0), cost);
            }
        }
        let mut entered_since = self.buffer[self.buffer_costs.len()..].iter();
        let leaving = dearest.or_else(|| Some(entered_since.find(|&entry| may_leave(entry))?.0));
        let leaving = leaving.expect("a full cache holds more than the other two corners");
        self.live.vertices[leaving as usize].entered = 0;
        self.held -= 1;
        self.live.announce_unfinished_exit(leaving);
        (self.record)(CacheEvent::Pop(leaving));
    }
}
