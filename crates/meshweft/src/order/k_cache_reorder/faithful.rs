//! The paper read plainly: every candidate is run, nothing is kept between steps.
//!
//! Step numbers are those of Figs. 1 and 2. See the parent module for the choices where the paper
//! leaves room.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};

use super::task::Task;
use crate::cache::CacheEvent;
use crate::index::index32;
use crate::order::greedy::Costs;
use crate::permutation::{FaceOrder, Permutation};
use crate::topology::{Adjacency, distinct};

/// Most faces of a tentative run.
const MAX_RUN: u32 = 4096;

/// Which cache the paper's greedy is run for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Evictions {
    /// First in, first out.
    Fifo,
    /// The program decides.
    Controllable,
}

/// Draws all faces; `record` receives each push, pop and draw.
pub(super) fn face_order(
    task: &Task<'_>,
    evictions: Evictions,
    record: impl FnMut(CacheEvent),
) -> FaceOrder {
    let (faces, vertex_count) = (task.faces.as_slice(), task.faces.vertex_count());
    let controllable = evictions == Evictions::Controllable;
    let size = task.size as usize;

    let adjacency = Adjacency::new(task.faces);
    let around = (0..index32(vertex_count))
        .map(|vertex| match evictions {
            Evictions::Controllable => adjacency.faces_of(vertex).to_vec(),
            Evictions::Fifo => clockwise(vertex, adjacency.faces_of(vertex), faces),
        })
        .collect::<Vec<_>>();
    let white = (0..index32(vertex_count))
        .map(|vertex| Reverse((adjacency.degree(vertex), vertex)))
        .collect();

    let reorder = Reorder {
        faces,
        size,
        controllable,
        costs: &task.costs,
        live: around.iter().map(|row| index32(row.len())).collect(),
        around,
        adjacency,
        drawn: vec![false; faces.len()],
        buffer: VecDeque::with_capacity(size + 1),
        gray: vec![false; vertex_count],
        white,
        record,
        new_to_old: Vec::with_capacity(faces.len()),
    };
    Permutation::from_algorithm(reorder.run(task.first_focus)).into()
}

struct Reorder<'a, R> {
    faces: &'a [[u32; 3]],
    size: usize,
    controllable: bool,
    costs: &'a Costs,
    adjacency: Adjacency,
    /// Faces around each vertex: clockwise from the first in the file, or in file order.
    around: Vec<Vec<u32>>,
    /// How many faces of each vertex are not drawn.
    live: Vec<u32>,
    drawn: Vec<bool>,
    /// The vertices in the buffer, the front first.
    buffer: VecDeque<u32>,
    gray: Vec<bool>,
    /// White vertices by (static degree, number), with some that are white no longer.
    white: BinaryHeap<Reverse<(u32, u32)>>,
    record: R,
    new_to_old: Vec<u32>,
}

impl<R: FnMut(CacheEvent)> Reorder<'_, R> {
    fn run(mut self, first_focus: Option<u32>) -> Vec<u32> {
        let mut next = first_focus;
        while self.new_to_old.len() < self.faces.len() {
            // 3-6: choose the focus.
            next = next.or_else(|| self.cheapest_gray());
            let Some(focus) = next.take().or_else(|| self.white_of_least_degree()) else {
                break;
            };

            // To make room, vertices that are in the buffer now are popped; those that enter for
            // this focus only if no other is left.
            let before: Vec<u32> = self.buffer.iter().copied().collect();

            // 7
            for face in self.live_faces(focus) {
                self.draw(face, &before); // 8-15
            }
            // 16, 17 are left out: dropping black vertices from the front of a FIFO buffer does not
            // change what else is in it.
        }
        self.new_to_old
    }

    fn live_faces(&self, vertex: u32) -> Vec<u32> {
        let row = self.around[vertex as usize].iter();
        row.copied().filter(|&f| !self.drawn[f as usize]).collect()
    }

    fn cheapest_gray(&self) -> Option<u32> {
        let candidates = self.buffer.iter().copied();
        let candidates = candidates.filter(|&v| self.live[v as usize] != 0);
        // `min_by_key` keeps the first of equals: the one closest to the front.
        candidates.min_by_key(|&v| self.cost(v))
    }

    fn white_of_least_degree(&mut self) -> Option<u32> {
        loop {
            let Reverse((_, vertex)) = self.white.pop()?;
            // Isolated vertices would turn black here one by one, without a push.
            if !self.gray[vertex as usize] && self.live[vertex as usize] != 0 {
                return Some(vertex);
            }
        }
    }

    fn cost(&self, vertex: u32) -> i64 {
        let live = self.live[vertex as usize];
        if live > MAX_RUN {
            return i64::MAX;
        }
        if self.controllable {
            return self.costs.of(self.white_neighbours(vertex), live, 0);
        }
        let mut run = TentativeRun {
            buffer: &self.buffer,
            popped: 0,
            pushed: Vec::new(),
            size: self.size,
        };
        for face in self.live_faces(vertex) {
            run.draw(self.faces[face as usize]);
        }
        self.costs
            .after_run(index32(run.pushed.len()), live, run.age(vertex))
    }

    /// How many distinct white vertices the live faces of `vertex` name.
    fn white_neighbours(&self, vertex: u32) -> u32 {
        let live = self.live_faces(vertex).into_iter();
        let corners = live.flat_map(|face| self.faces[face as usize]);
        let mut white: Vec<u32> = corners
            .filter(|&v| v != vertex && !self.gray[v as usize])
            .collect();
        white.sort_unstable();
        white.dedup();
        index32(white.len())
    }

    fn draw(&mut self, face: u32, before: &[u32]) {
        let corners = self.faces[face as usize];
        // A FIFO push may pop a vertex of the same face: push until all three are there.
        while let Some(&corner) = corners.iter().find(|&&v| !self.gray[v as usize]) {
            if self.buffer.len() == self.size {
                self.pop_one(corners, before); // 11, 12
            }
            self.gray[corner as usize] = true; // 13
            self.buffer.push_back(corner);
            (self.record)(CacheEvent::Push(corner));
        }
        self.drawn[face as usize] = true;
        self.new_to_old.push(face); // 15
        (self.record)(CacheEvent::Draw);
        for vertex in distinct(corners) {
            self.live[vertex as usize] -= 1;
            if self.controllable && self.live[vertex as usize] == 0 {
                self.remove(vertex);
            }
        }
    }

    /// Pops a vertex to make room (Fig. 2).
    fn pop_one(&mut self, corners: [u32; 3], before: &[u32]) {
        let leaving = if self.controllable {
            let others = self.buffer.iter().copied().filter(|v| !corners.contains(v));
            let others: Vec<u32> = others.collect();
            let settled = others.iter().copied().filter(|v| before.contains(v));
            // `max_by_key` keeps the last of equals: the newest.
            let dearest = settled.max_by_key(|&v| self.cost(v));
            dearest.or(others.last().copied())
        } else {
            self.buffer.front().copied()
        };
        let leaving = leaving.expect("a full buffer holds more than the other two corners");
        self.remove(leaving);
        if self.live[leaving as usize] != 0 {
            let degree = self.adjacency.degree(leaving);
            self.white.push(Reverse((degree, leaving)));
        }
    }

    fn remove(&mut self, vertex: u32) {
        if let Some(position) = self.buffer.iter().position(|&v| v == vertex) {
            self.buffer.remove(position);
            self.gray[vertex as usize] = false;
            (self.record)(CacheEvent::Pop(vertex));
        }
    }
}

/// A FIFO buffer that starts as a copy of the real one, which it leaves unchanged.
struct TentativeRun<'a> {
    buffer: &'a VecDeque<u32>,
    /// How many of `buffer`, then of `pushed`, have left.
    popped: usize,
    pushed: Vec<u32>,
    size: usize,
}

impl TentativeRun<'_> {
    /// Places from the front to the last entry of `vertex`; `None` if it has no entry or has left.
    fn place(&self, vertex: u32) -> Option<usize> {
        let entered = self.pushed.iter().rposition(|&v| v == vertex);
        let entered = entered.map(|i| self.buffer.len() + i);
        let entered = entered.or_else(|| self.buffer.iter().position(|&v| v == vertex));
        entered?.checked_sub(self.popped)
    }

    fn draw(&mut self, corners: [u32; 3]) {
        while let Some(&corner) = corners.iter().find(|&&v| self.place(v).is_none()) {
            if self.buffer.len() + self.pushed.len() - self.popped == self.size {
                self.popped += 1;
            }
            self.pushed.push(corner);
        }
    }

    /// Pushes since `vertex` entered, itself included.
    fn age(&self, vertex: u32) -> u32 {
        let held = self.buffer.len() + self.pushed.len() - self.popped;
        index32(held - self.place(vertex).unwrap_or(0))
    }
}

/// The faces of a row in clockwise order around `vertex` (the next face's second edge at the vertex
/// is this one's first), starting with the first in the file. Where that ends, or the faces are not
/// a fan, it goes on with the first face that is left.
fn clockwise(vertex: u32, row: &[u32], faces: &[[u32; 3]]) -> Vec<u32> {
    // The vertices after and before `vertex` in a face.
    let edges = |face: u32| {
        let corners = faces[face as usize];
        let at = corners.iter().position(|&v| v == vertex).unwrap_or(0);
        (corners[(at + 1) % 3], corners[(at + 2) % 3])
    };

    // Faces that arrive at the vertex from each neighbour, the first in the file last.
    let mut arriving: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &face in row.iter().rev() {
        arriving.entry(edges(face).1).or_default().push(face);
    }

    let mut placed: BTreeMap<u32, bool> = row.iter().map(|&face| (face, false)).collect();
    let mut around = Vec::with_capacity(row.len());
    for &start in row {
        let mut next = Some(start);
        while let Some(face) = next {
            if std::mem::replace(placed.entry(face).or_default(), true) {
                break;
            }
            around.push(face);

            let candidates = arriving.entry(edges(face).0).or_default();
            while candidates.last().is_some_and(|f| placed[f]) {
                candidates.pop();
            }
            next = candidates.last().copied();
        }
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fan_is_walked_clockwise_from_the_first_in_the_file() {
        // Four faces around vertex 0, counter-clockwise 1 2 3 4, stored out of order.
        let faces = [[0, 3, 4], [0, 1, 2], [2, 3, 0], [4, 1, 0]];
        assert_eq!(clockwise(0, &[0, 1, 2, 3], &faces), [0, 2, 1, 3]);
    }

    #[test]
    fn what_is_no_fan_is_walked_in_pieces() {
        let faces = [[0, 1, 2], [0, 3, 4], [0, 2, 5], [0, 1, 2]];
        assert_eq!(clockwise(0, &[0, 1, 2, 3], &faces), [0, 1, 2, 3]);
    }
}
