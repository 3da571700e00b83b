//! Better cuts by moving vertices across (C. M. Fiduccia, R. M. Mattheyses: *A Linear-Time
//! Heuristic for Improving Network Partitions*, 1982, doi:10.1109/DAC.1982.1585498).
//!
//! The *gain* of a vertex is how much less is cut if it moves. A pass moves the vertex of greatest
//! gain, again and again and even where the gain is negative, and in the end returns to the best
//! state on the way: so it can leave a cut that no single move makes better.

use std::collections::BinaryHeap;

use super::graph::Graph;
use crate::index::index32;

/// For each side, its vertices by gain, ties to the lowest number: entries are the gain and
/// `u32::MAX` minus the vertex. An entry is out of date once its vertex has moved or has another
/// gain.
type Heaps = [BinaryHeap<(i64, u32)>; 2];

/// On graphs of at most this many vertices a pass may move all of them, not only the boundary.
const FEW: usize = 128;
/// With at most this many passes it does not: the caller wants speed.
const FEW_PASSES: usize = 3;

/// The two sides of a graph, and how heavy each may be.
pub(super) struct Sides<'a> {
    graph: &'a Graph,
    pub(super) side: Vec<bool>,
    weights: [u64; 2],
    most: [u64; 2],
    /// For each vertex, the weight of its edges to the other side less that of those to its own.
    gains: Vec<i64>,
    /// The vertices with an edge to the other side; `None` after the first pass.
    boundary: Option<Vec<u32>>,
    pub(super) cut: i64,
}

impl<'a> Sides<'a> {
    /// The given sides, with the gain of each vertex; `most` is the most that each side may weigh.
    pub(super) fn new(graph: &'a Graph, side: Vec<bool>, most: [u64; 2]) -> Self {
        let mut sides = Self {
            graph,
            weights: [0; 2],
            most,
            gains: Vec::with_capacity(side.len()),
            boundary: None,
            cut: 0,
            side,
        };

        let mut boundary = Vec::new();
        for vertex in 0..index32(sides.side.len()) {
            let here = sides.side[vertex as usize];
            sides.weights[usize::from(here)] += u64::from(graph.weights[vertex as usize]);

            let mut sums = [0, 0];
            for &(other, weight) in graph.row(vertex) {
                let is_cut = sides.side[other as usize] != here;
                sums[usize::from(is_cut)] += i64::from(weight);
            }
            let [inside, across] = sums;
            sides.cut += across;
            sides.gains.push(across - inside);
            if across > 0 {
                boundary.push(vertex);
            }
        }

        // Each cut edge was counted from both ends.
        sides.cut /= 2;
        sides.boundary = Some(boundary);
        sides
    }

    /// How much the sides weigh beyond what they may: the larger of the two excesses.
    pub(super) fn excess(&self) -> u64 {
        let over = |side: usize| self.weights[side].saturating_sub(self.most[side]);
        over(0).max(over(1))
    }

    /// Makes passes until one does not improve the cut, at most `passes`.
    ///
    /// A pass moves each vertex at most once. It ends after `patience` moves without a better cut
    /// and returns to the best state.
    pub(super) fn refine(&mut self, passes: usize, patience: usize) {
        let mut is_locked = vec![false; self.side.len()];
        for _ in 0..passes {
            if !self.pass(patience, &mut is_locked, passes > FEW_PASSES) {
                break;
            }
        }
    }

    /// One pass; returns whether the cut is better. All of `is_locked` is false before and after.
    fn pass(&mut self, patience: usize, is_locked: &mut [bool], is_thorough: bool) -> bool {
        // The vertices that may move: the boundary; all where a side is too heavy, or where there
        // are few, because vertices inside a side can make room.
        let mut heaps = Heaps::default();
        let are_all_tried = self.excess() > 0 || is_thorough && self.side.len() <= FEW;
        let known = self.boundary.take();
        let boundary = match known {
            Some(boundary) if !are_all_tried => boundary,
            _ => self.movable(are_all_tried),
        };
        for vertex in boundary {
            let here = self.side[vertex as usize];
            let gain = self.gains[vertex as usize];
            heaps[usize::from(here)].push((gain, u32::MAX - vertex));
        }

        // Move the best vertex, lock it, and enter its neighbours again with their new gains.
        // `kept` is the number of moves that lead to the best state.
        let start = (self.excess(), self.cut);
        let (mut best, mut kept) = (start, 0);
        let mut moved = Vec::new();
        while moved.len() - kept < patience {
            let Some(vertex) = self.next(&mut heaps, is_locked) else {
                break;
            };
            self.shift(vertex);
            is_locked[vertex as usize] = true;
            moved.push(vertex);
            for &(other, _) in self.graph.row(vertex) {
                if !is_locked[other as usize] {
                    let heap = &mut heaps[usize::from(self.side[other as usize])];
                    heap.push((self.gains[other as usize], u32::MAX - other));
                }
            }
            let now = (self.excess(), self.cut);
            if now < best {
                (best, kept) = (now, moved.len());
            }
        }

        // Take back the moves after the best state.
        for &vertex in moved[kept..].iter().rev() {
            self.shift(vertex);
        }
        for vertex in moved {
            is_locked[vertex as usize] = false;
        }
        best < start
    }

    /// All vertices, or those with an edge to the other side.
    fn movable(&self, all: bool) -> Vec<u32> {
        let vertices = 0..index32(self.side.len());
        let is_movable = |&vertex: &u32| {
            let here = self.side[vertex as usize];
            let mut row = self.graph.row(vertex).iter();
            all || row.any(|&(other, _)| self.side[other as usize] != here)
        };
        vertices.filter(is_movable).collect()
    }

    /// The vertex of greatest gain whose move keeps or improves the balance; `None` if there is
    /// none.
    fn next(&self, heaps: &mut Heaps, is_locked: &[bool]) -> Option<u32> {
        loop {
            let mut choice: Option<(i64, u64, usize)> = None;
            let mut blocked = None;
            for (from, heap) in heaps.iter_mut().enumerate() {
                // Drop entries that are out of date.
                while let Some(&(gain, inverse)) = heap.peek() {
                    let vertex = (u32::MAX - inverse) as usize;
                    let is_here = usize::from(self.side[vertex]) == from;
                    if is_here && !is_locked[vertex] && self.gains[vertex] == gain {
                        break;
                    }
                    heap.pop();
                }
                let Some(&(gain, inverse)) = heap.peek() else {
                    continue;
                };

                // A move may leave the other side too heavy by this vertex at most, or by less than
                // this side is now.
                let weight = u64::from(self.graph.weights[(u32::MAX - inverse) as usize]);
                let over_there =
                    (self.weights[1 - from] + weight).saturating_sub(self.most[1 - from]);
                let over_here = self.weights[from].saturating_sub(self.most[from]);
                if over_there > weight && over_there >= over_here {
                    blocked = Some(from);
                    continue;
                }

                // The greater gain; ties from the heavier side.
                let key = (gain, self.weights[from], from);
                choice = choice.max(Some(key));
            }

            match (choice, blocked) {
                (Some((_, _, from)), _) => {
                    return heaps[from].pop().map(|(_, inverse)| u32::MAX - inverse);
                }
                // The best vertex is too heavy to move now; the next one may not be.
                (None, Some(from)) => heaps[from].pop(),
                (None, None) => return None,
            };
        }
    }

    /// Moves a vertex to the other side, and updates the weights, the cut and the gains.
    fn shift(&mut self, vertex: u32) {
        let v = vertex as usize;
        let here = self.side[v];
        self.cut -= self.gains[v];
        self.gains[v] = -self.gains[v];
        self.side[v] = !here;
        let weight = u64::from(self.graph.weights[v]);
        self.weights[usize::from(here)] -= weight;
        self.weights[usize::from(!here)] += weight;
        for &(other, weight) in self.graph.row(vertex) {
            let is_cut_now = self.side[other as usize] == here;
            let change = 2 * i64::from(weight);
            self.gains[other as usize] += if is_cut_now { change } else { -change };
        }
    }
}
