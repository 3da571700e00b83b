//! Vertices moved between two of many parts, as in `refine` but at the cost of the border alone.

use std::collections::{BTreeMap, BinaryHeap};
use std::ops::RangeInclusive;

use super::links::Links;
use crate::index::index32;

/// The part of a vertex on no face.
pub(crate) const NO_PART: u32 = u32::MAX;

/// More edges than a vertex has that moves: to learn the gain of one again and again takes as long as it
/// has edges, and where it stands decides little.
const HUB: usize = 1 << 10;

/// A gain that is not known.
const UNKNOWN: i32 = i32::MIN;

/// How many moves without a better cut end a pass, at least.
const PATIENCE: usize = 200;

/// Parts of a vertex graph, and the borders between them.
pub(super) struct Exchange<'a> {
    links: &'a Links<'a>,
    pub(super) part_of: Vec<u32>,
    /// How many vertices each part has.
    pub(super) sizes: Vec<usize>,
    /// For two parts, the lesser first, the vertices that have or had a neighbour in the other one.
    borders: BTreeMap<[u32; 2], Vec<u32>>,
    /// How much less is cut if a vertex moves to the other part of this pass; mostly unknown.
    gains: Vec<i32>,
    /// Vertices that moved in this pass; hubs always.
    is_locked: Vec<bool>,
}

/// A pass over the border of two parts.
struct Exchanging {
    parts: [u32; 2],
    /// For each part its vertices by gain, ties to the lowest number: entries are the gain and
    /// `u32::MAX` minus the vertex, out of date if the vertex has moved or has another gain.
    heaps: [BinaryHeap<(i32, u32)>; 2],
    /// How many vertices the first part gave, less those that it got.
    given: i64,
    /// How many it should have given.
    aim: RangeInclusive<i64>,
    /// Vertices whose gain is known.
    known: Vec<u32>,
}

impl Exchanging {
    /// How far `given` is from what it should be.
    fn excess(&self, given: i64) -> i64 {
        (self.aim.start() - given)
            .max(given - self.aim.end())
            .max(0)
    }

    /// The sum after a move from the part of this side.
    fn after(&self, side: usize) -> i64 {
        self.given + if side == 0 { 1 } else { -1 }
    }
}

impl<'a> Exchange<'a> {
    /// Parts numbered below `count`.
    ///
    /// Time and space O(vertices + faces).
    pub(super) fn new(links: &'a Links<'a>, part_of: Vec<u32>, count: usize) -> Self {
        let mut sizes = vec![0; count];
        for &part in part_of.iter().filter(|&&part| part != NO_PART) {
            sizes[part as usize] += 1;
        }
        let is_hub = |vertex| links.others(vertex).nth(HUB).is_some();
        let mut exchange = Self {
            links,
            gains: vec![UNKNOWN; part_of.len()],
            is_locked: (0..index32(part_of.len())).map(is_hub).collect(),
            borders: BTreeMap::new(),
            part_of,
            sizes,
        };
        for ends in links.edges() {
            exchange.note_border(ends);
        }
        exchange
    }

    /// The pairs of parts with a border, or that had one.
    pub(super) fn pairs(&self) -> Vec<[u32; 2]> {
        self.borders.keys().copied().collect()
    }

    /// Enters the ends of an edge in the border of their parts, if these differ and none is a hub.
    fn note_border(&mut self, ends: [u32; 2]) {
        if ends.iter().any(|&vertex| self.is_locked[vertex as usize]) {
            return;
        }
        let [a, b] = ends.map(|vertex| self.part_of[vertex as usize]);
        if a != b {
            let border = self.borders.entry([a.min(b), a.max(b)]).or_default();
            // Edges of one vertex often come one after the other.
            for vertex in ends {
                if border.last() != Some(&vertex) {
                    border.push(vertex);
                }
            }
        }
    }

    /// Moves vertices between two parts, each at most once, so that the first gives as many as `aim`
    /// says, less those that it gets, and then so that less is cut. Returns whether that is so.
    ///
    /// Time O(log border) for each vertex of the border and each edge of those that move.
    pub(super) fn pass(&mut self, parts: [u32; 2], aim: RangeInclusive<i64>) -> bool {
        let mut pass = Exchanging {
            parts,
            heaps: Default::default(),
            given: 0,
            aim,
            known: Vec::new(),
        };
        let border = self.current_border(parts);
        for &vertex in &border {
            self.learn(vertex, &mut pass);
            self.enter(vertex, &mut pass);
        }

        // Move the best vertex, again and again; `kept` moves lead to the best state.
        let start = (pass.excess(0), 0);
        let (mut best, mut kept, mut cut) = (start, 0, 0);
        let mut moved = Vec::new();
        let patience = PATIENCE + border.len() / 8;
        while moved.len() - kept < patience {
            let Some((vertex, gain)) = self.next(&mut pass) else {
                break;
            };
            self.shift(vertex, &mut pass);
            cut -= i64::from(gain);
            moved.push(vertex);
            let now = (pass.excess(pass.given), cut);
            if now < best {
                (best, kept) = (now, moved.len());
            }
        }

        // Take back the moves after the best state.
        for &vertex in &moved[kept..] {
            self.part_of[vertex as usize] = other_part(self.part_of[vertex as usize], parts);
        }
        for &vertex in &moved {
            self.is_locked[vertex as usize] = false;
        }
        for vertex in pass.known {
            self.gains[vertex as usize] = UNKNOWN;
        }

        // Enter the new borders.
        self.borders.insert(sorted(parts), border);
        for &vertex in &moved[..kept] {
            self.count_move(vertex, parts);
        }
        best < start
    }

    /// Moves vertices from the first part to the second, wherever they are: for parts without a
    /// border between them.
    ///
    /// Takes whole pieces of the first part where they fit, and of the last one a compact share.
    /// Time O(vertices + faces of the part).
    pub(super) fn carve(&mut self, parts: [u32; 2], count: usize) {
        if count == 0 {
            return;
        }
        let [from, to] = parts;
        let all = (0..index32(self.part_of.len())).filter(|&v| self.part_of[v as usize] == from);
        let all: Vec<u32> = all.collect();

        // The pieces of the part, the smallest first.
        let mut pieces: Vec<Vec<u32>> = Vec::new();
        let mut is_reached = vec![false; self.part_of.len()];
        for &start in &all {
            if std::mem::replace(&mut is_reached[start as usize], true) {
                continue;
            }
            let (mut piece, mut next) = (vec![start], 0);
            while let Some(&vertex) = piece.get(next) {
                next += 1;
                for other in self.links.others(vertex) {
                    let is_here = self.part_of[other as usize] == from;
                    if is_here && !std::mem::replace(&mut is_reached[other as usize], true) {
                        piece.push(other);
                    }
                }
            }
            pieces.push(piece);
        }
        pieces.sort_by_key(Vec::len);

        // Each was reached breadth first, so its end is far from its start.
        let moved: Vec<u32> = pieces
            .iter()
            .flat_map(|piece| piece.iter().rev())
            .copied()
            .take(count)
            .collect();
        for &vertex in &moved {
            self.part_of[vertex as usize] = to;
        }
        for vertex in moved {
            self.count_move(vertex, parts);
        }
    }

    /// The vertices of either part with a neighbour in the other one, each once.
    fn current_border(&mut self, parts: [u32; 2]) -> Vec<u32> {
        let mut border = self.borders.remove(&sorted(parts)).unwrap_or_default();
        border.sort_unstable();
        border.dedup();
        border.retain(|&vertex| {
            let here = self.part_of[vertex as usize];
            let there = other_part(here, parts);
            let is_there = |other: u32| self.part_of[other as usize] == there;
            parts.contains(&here) && self.links.others(vertex).any(is_there)
        });
        border
    }

    /// Enters a vertex that has moved between two parts in the sizes and in all borders.
    fn count_move(&mut self, vertex: u32, parts: [u32; 2]) {
        let here = self.part_of[vertex as usize];
        self.sizes[here as usize] += 1;
        self.sizes[other_part(here, parts) as usize] -= 1;
        let links = self.links;
        for other in links.others(vertex) {
            self.note_border([vertex, other]);
        }
    }

    /// Learns the gain of a vertex of one of the parts.
    fn learn(&mut self, vertex: u32, pass: &mut Exchanging) {
        if self.gains[vertex as usize] != UNKNOWN {
            return;
        }
        let here = self.part_of[vertex as usize];
        let there = other_part(here, pass.parts);
        let mut gain = 0;
        for other in self.links.others(vertex) {
            let part = self.part_of[other as usize];
            gain += i32::from(part == there) - i32::from(part == here);
        }
        self.gains[vertex as usize] = gain;
        pass.known.push(vertex);
    }

    /// Enters a vertex with its gain in the heap of its part.
    fn enter(&self, vertex: u32, pass: &mut Exchanging) {
        let side = usize::from(self.part_of[vertex as usize] == pass.parts[1]);
        pass.heaps[side].push((self.gains[vertex as usize], u32::MAX - vertex));
    }

    /// Takes the vertex of greatest gain whose move keeps or betters the balance; one vertex too many
    /// may be given. `None` if there is none.
    fn next(&self, pass: &mut Exchanging) -> Option<(u32, i32)> {
        let mut choice = None;
        for side in 0..2 {
            // Drop entries that are out of date.
            while let Some(&(gain, inverse)) = pass.heaps[side].peek() {
                let vertex = (u32::MAX - inverse) as usize;
                let is_here = self.part_of[vertex] == pass.parts[side];
                if is_here && !self.is_locked[vertex] && self.gains[vertex] == gain {
                    break;
                }
                pass.heaps[side].pop();
            }
            let Some(&(gain, _)) = pass.heaps[side].peek() else {
                continue;
            };

            // Where too few were given, the moves that even that come first.
            let (now, then) = (pass.excess(pass.given), pass.excess(pass.after(side)));
            if then <= 1 || then < now {
                choice = choice.max(Some((now > then, gain, side)));
            }
        }
        let (_, _, side) = choice?;
        let (gain, inverse) = pass.heaps[side].pop()?;
        Some((u32::MAX - inverse, gain))
    }

    /// Moves a vertex to the other part, locks it, and enters its neighbours with their new gains.
    fn shift(&mut self, vertex: u32, pass: &mut Exchanging) {
        let links = self.links;
        for other in links.others(vertex) {
            let is_in = pass.parts.contains(&self.part_of[other as usize]);
            if is_in && !self.is_locked[other as usize] {
                self.learn(other, pass);
            }
        }

        let from = self.part_of[vertex as usize];
        let to = other_part(from, pass.parts);
        pass.given = pass.after(usize::from(from == pass.parts[1]));
        self.part_of[vertex as usize] = to;
        self.is_locked[vertex as usize] = true;

        for other in links.others(vertex) {
            let part = self.part_of[other as usize];
            if (part == from || part == to) && !self.is_locked[other as usize] {
                self.gains[other as usize] += if part == from { 2 } else { -2 };
                self.enter(other, pass);
            }
        }
    }
}

/// The other one of two parts.
fn other_part(part: u32, [a, b]: [u32; 2]) -> u32 {
    if part == a { b } else { a }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
