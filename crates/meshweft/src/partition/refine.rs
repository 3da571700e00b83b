//! Better cuts by moving vertices across (C. M. Fiduccia, R. M. Mattheyses: *A Linear-Time Heuristic
//! for Improving Network Partitions*, 1982, doi:10.1109/DAC.1982.1585498).

use std::collections::BinaryHeap;

use super::graph::Graph;
use crate::index::index32;

/// Vertices of each side by their gain, ties to the lowest number.
type Heaps = [BinaryHeap<(i64, u32)>; 2];

/// Graphs of so few vertices try to move all of them.
const FEW: usize = 128;
/// Who asks for no more passes than that is in a hurry.
const FEW_PASSES: usize = 3;

/// The two sides of a graph, and how heavy each may be.
pub(super) struct Sides<'a> {
    graph: &'a Graph,
    pub(super) side: Vec<bool>,
    weights: [u64; 2],
    most: [u64; 2],
    /// Of each vertex: weight of the edges to the other side less that of those to its own.
    gains: Vec<i64>,
    /// Vertices with an edge to the other side, as long as none has moved.
    boundary: Option<Vec<u32>>,
    pub(super) cut: i64,
}

impl<'a> Sides<'a> {
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
        sides.cut /= 2;
        sides.boundary = Some(boundary);
        sides
    }

    /// By how much the heavier side is too heavy.
    pub(super) fn excess(&self) -> u64 {
        let over = |side: usize| self.weights[side].saturating_sub(self.most[side]);
        over(0).max(over(1))
    }

    /// Passes until one gains nothing, at most `passes`.
    ///
    /// A pass moves the best vertex of the boundary again and again, each at most once, even where
    /// that cuts more for a while, up to `patience` moves without a better cut; then it goes back to
    /// the best state.
    pub(super) fn refine(&mut self, passes: usize, patience: usize) {
        let mut is_locked = vec![false; self.side.len()];
        for _ in 0..passes {
            if !self.pass(patience, &mut is_locked, passes > FEW_PASSES) {
                break;
            }
        }
    }

    fn pass(&mut self, patience: usize, is_locked: &mut [bool], is_thorough: bool) -> bool {
        let mut heaps = Heaps::default();
        // Where the balance is wrong all may have to move; where there are few, also what touches
        // nothing on the other side may make room.
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

    /// The vertex of greatest gain whose move keeps the balance or betters it.
    fn next(&self, heaps: &mut Heaps, is_locked: &[bool]) -> Option<u32> {
        loop {
            let mut choice: Option<(i64, u64, usize)> = None;
            let mut blocked = None;
            for (from, heap) in heaps.iter_mut().enumerate() {
                // What was pushed before its gain changed or before it moved is out of date.
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
                let weight = u64::from(self.graph.weights[(u32::MAX - inverse) as usize]);
                let over_there =
                    (self.weights[1 - from] + weight).saturating_sub(self.most[1 - from]);
                let over_here = self.weights[from].saturating_sub(self.most[from]);
                // On the way a side may be too heavy by one vertex.
                if over_there > weight && over_there >= over_here {
                    blocked = Some(from);
                    continue;
                }
                let key = (gain, self.weights[from], from);
                choice = choice.max(Some(key));
            }
            match (choice, blocked) {
                (Some((_, _, from)), _) => {
                    return heaps[from].pop().map(|(_, inverse)| u32::MAX - inverse);
                }
                // Too heavy for now: the next one may not be.
                (None, Some(from)) => heaps[from].pop(),
                (None, None) => return None,
            };
        }
    }

    /// Moves a vertex to the other side.
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
