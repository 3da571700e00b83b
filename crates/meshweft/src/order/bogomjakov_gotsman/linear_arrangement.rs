//! Minimum linear arrangement: each vertex's faces close together in the sequence.
//!
//! The *length* of a vertex is the distance between its first and its last face; [`cost`] adds them
//! up. Bogomjakov & Gotsman minimise the sum by swapping the halves of a cut tree, for which R.
//! Bar-Yehuda, G. Even, J. Feldman, J. Naor: *Computing an Optimal Orientation of a Balanced
//! Decomposition Tree for Linear Arrangement Problems*, Journal of Graph Algorithms and
//! Applications 5(4), 2001, doi:10.7155/jgaa.00035, give a dynamic program. Here it is written for
//! hyperedges.
//!
//! **Why no further.** The tree keeps neighbours together at every scale, and that makes the
//! sequence good for small caches. The sum alone does not: orders that minimise it sweep a front of
//! about √faces vertices over the whole mesh. Nearly every vertex is then needed again one front
//! later, and only a cache larger than the front still has it. Faces sorted by the Fiedler vector
//! of the dual graph are an example: less cost than any order here, and in small caches little
//! better than a random order. So the sum is a metric and a way to orient a tree, but not a goal.

use super::cut_tree::{CutTree, Cutter, Cutting};
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::index::index32;
use crate::order::turn_corners::turn_corners;
use crate::partition::Graph;
use crate::permutation::{FaceOrder, Permutation};
use crate::topology::Adjacency;

/// The sum, over all used vertices, of the distance from their first to their last face, in faces.
///
/// ```
/// use meshweft::order::bogomjakov_gotsman::linear_arrangement_cost;
/// // Vertices 1 and 2 of a strip are used twice, one face apart.
/// assert_eq!(linear_arrangement_cost(&[[0, 1, 2], [1, 3, 2]]), 2);
/// ```
///
/// # Complexity
/// Time O(faces + vertices), space 4 bytes a vertex.
#[must_use]
pub fn cost<'a>(faces: impl Into<Faces<'a>>) -> u64 {
    const UNUSED: u32 = u32::MAX;
    let faces = faces.into();
    let mut last = vec![UNUSED; faces.vertex_count()];
    let mut cost = 0;
    for (i, face) in (0..).zip(faces.as_slice()) {
        for &vertex in face {
            let last = &mut last[vertex as usize];
            if *last != UNUSED {
                cost += u64::from(i - *last);
            }
            *last = i;
        }
    }
    cost
}

/// A rendering sequence by an approximate minimum linear arrangement (Bogomjakov & Gotsman 2002).
///
/// ```
/// use meshweft::{Mesh, order::{baselines, bogomjakov_gotsman::{LinearArrangement, linear_arrangement_cost}}};
/// let strip = |i: u32| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
/// let faces = baselines::random(100, 1).apply(&(0..100).map(strip).collect::<Vec<_>>());
/// let mesh = Mesh::connectivity_only(102, faces)?;
/// let order = LinearArrangement::default().face_order(&mesh);
/// // No order of a strip has less: 98 vertices with three faces, two with two.
/// assert_eq!(linear_arrangement_cost(&order.apply(mesh.faces())), 2 * 98 + 2);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinearArrangement {
    /// How many levels of the tree are oriented together, from 1 to 6. The paper orients all of
    /// them; each further level doubles the time.
    pub levels: u32,
    /// Which algorithm finds the cuts.
    pub cutter: Cutter,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Forbids turning corners.
    pub keep_corners: bool,
}

impl Default for LinearArrangement {
    fn default() -> Self {
        Self {
            levels: 6,
            cutter: Cutter::default(),
            seed: 0,
            keep_corners: false,
        }
    }
}

impl LinearArrangement {
    /// The order in which to draw the faces.
    ///
    /// The tree goes down to single faces. Its upper levels are oriented first, with each subtree
    /// below them as one block; then each of these subtrees, with all others fixed. Corners are
    /// turned so that hits come first in a FIFO cache of 12, unless that is forbidden.
    ///
    /// # Complexity
    /// Time O(faces · (log faces + 2^levels)), space 150 bytes a face.
    #[must_use]
    pub fn face_order<'a>(&self, faces: impl Into<Faces<'a>>) -> FaceOrder {
        let faces = faces.into();
        let cutting = Cutting {
            piece: 1,
            seed: self.seed,
            cutter: self.cutter,
        };
        let graph = Graph::dual(faces);
        let tree = CutTree::new(&graph, &cutting);
        drop(graph);
        let sequence = oriented(&tree, faces, self.levels);
        let order = Permutation::from_algorithm(sequence).into();
        match self.keep_corners {
            true => order,
            false => turn_corners(faces, &order, CacheModel::fifo(12)),
        }
    }
}

/// The faces of the tree from the first leaf to the last, with its halves in the best order.
pub(super) fn oriented(tree: &CutTree, faces: Faces<'_>, levels: u32) -> Vec<u32> {
    let face_count = faces.len();
    let mut orienting = Orienting {
        faces,
        adjacency: Adjacency::new(faces),
        levels: levels.clamp(1, 6),
        starts: vec![0; face_count],
        unit_of: vec![0; face_count],
        seen: vec![0; faces.vertex_count()],
        blocks: 0,
        sequence: vec![0; face_count],
    };

    // Subtrees whose place is known, each with its first position.
    let mut placed = vec![(tree, 0)];
    while let Some((tree, start)) = placed.pop() {
        orienting.place(tree, start, &mut placed);
    }
    orienting.sequence
}

/// A tree being oriented.
struct Orienting<'a> {
    faces: Faces<'a>,
    adjacency: Adjacency,
    levels: u32,
    /// For each face, the first position of the smallest placed subtree that has it.
    starts: Vec<u32>,
    /// For each face of the current subtree, the number of its block.
    unit_of: Vec<u8>,
    /// The last subtree that each vertex was seen in, by its number.
    seen: Vec<u32>,
    /// The number of the current subtree.
    blocks: u32,
    sequence: Vec<u32>,
}

/// Blocks of a subtree as a bit set.
type Units = u64;

/// The blocks that a vertex's faces touch, and whether it also has faces before or after this
/// subtree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Span {
    units: Units,
    is_before: bool,
    is_behind: bool,
}

/// The upper levels of a subtree; a `Unit` is a block below them, a `Cut` has the set of its blocks
/// and its number of faces.
enum Upper {
    Unit(u32),
    Cut(Box<[Upper; 2]>, Units, u64),
}

impl Upper {
    fn units(&self) -> Units {
        match self {
            Self::Unit(unit) => 1 << unit,
            Self::Cut(_, units, _) => *units,
        }
    }

    fn len(&self, lens: &[u64]) -> u64 {
        match self {
            Self::Unit(unit) => lens[*unit as usize],
            Self::Cut(_, _, len) => *len,
        }
    }
}

impl Orienting<'_> {
    /// Orients the upper levels of a subtree that starts at `start`.
    fn place<'t>(&mut self, tree: &'t CutTree, start: u32, placed: &mut Vec<(&'t CutTree, u32)>) {
        if let CutTree::Piece(faces) = tree {
            let end = start as usize + faces.len();
            self.sequence[start as usize..end].copy_from_slice(faces);
            return;
        }

        let mut units = Vec::new();
        let upper = upper(tree, self.levels, &mut units);
        let spans = self.spans(&units, start);
        let mut order = Vec::with_capacity(units.len());
        let lens: Vec<u64> = units.iter().map(|unit| unit.len() as u64).collect();
        let (_, best) = best(&upper, &lens, &spans, [0; 2]);
        in_order(&upper, &mut best.iter(), &mut order);

        // The blocks have their places now; they are oriented later.
        let mut start = start;
        for unit in order {
            let unit = units[unit as usize];
            unit.for_each_face(&mut |face| self.starts[face as usize] = start);
            placed.push((unit, start));
            start += index32(unit.len());
        }
    }

    /// The distinct spans of the vertices that are in several blocks or also outside, and how many
    /// vertices have each.
    fn spans(&mut self, units: &[&CutTree], start: u32) -> Vec<(Span, u64)> {
        for (number, unit) in (0..).zip(units) {
            unit.for_each_face(&mut |face| self.unit_of[face as usize] = number);
        }

        self.blocks += 1;
        let mut spans = Vec::new();
        for unit in units {
            unit.for_each_face(&mut |face| {
                for vertex in self.faces.as_slice()[face as usize] {
                    let seen = &mut self.seen[vertex as usize];
                    if std::mem::replace(seen, self.blocks) == self.blocks {
                        continue;
                    }

                    // A face outside the subtree is before or after it by where its own starts.
                    let mut span = Span {
                        units: 0,
                        is_before: false,
                        is_behind: false,
                    };
                    for &near in self.adjacency.faces_of(vertex) {
                        match self.starts[near as usize].cmp(&start) {
                            std::cmp::Ordering::Less => span.is_before = true,
                            std::cmp::Ordering::Greater => span.is_behind = true,
                            std::cmp::Ordering::Equal => {
                                span.units |= 1 << self.unit_of[near as usize];
                            }
                        }
                    }

                    if span.is_before || span.is_behind || !span.units.is_power_of_two() {
                        spans.push(span);
                    }
                }
            });
        }

        // Count the equal ones.
        spans.sort_unstable();
        let alike = spans.chunk_by(|a, b| a == b);
        alike.map(|group| (group[0], group.len() as u64)).collect()
    }
}

/// The upper `levels` levels of a tree; the subtrees below them are appended to `units` as blocks.
fn upper<'t>(tree: &'t CutTree, levels: u32, units: &mut Vec<&'t CutTree>) -> Upper {
    match tree {
        CutTree::Cut(halves, len) if levels > 0 => {
            let halves = halves.each_ref().map(|half| upper(half, levels - 1, units));
            let both = halves[0].units() | halves[1].units();
            Upper::Cut(Box::new(halves), both, *len as u64)
        }
        _ => {
            units.push(tree);
            Upper::Unit(index32(units.len() - 1))
        }
    }
}

/// The least cost of a subtree with the blocks `around` it, before and after; and for each cut,
/// from the root down, whether its second half comes first.
///
/// If a half lies between two faces of a vertex and has none of that vertex's faces, the vertex
/// gets longer by the number of faces in that half. An orientation changes nothing else: a vertex
/// with faces in both halves, or in neither, has the same length either way.
fn best(tree: &Upper, lens: &[u64], spans: &[(Span, u64)], around: [Units; 2]) -> (u64, Vec<bool>) {
    let Upper::Cut(halves, units, _) = tree else {
        return (0, Vec::new());
    };
    let [before, after] = around;

    // Only these vertices matter, also to the halves.
    let spans: Vec<(Span, u64)> = spans
        .iter()
        .filter(|(span, _)| span.units & units != 0)
        .copied()
        .collect();

    let ways = [false, true].map(|is_turned| {
        let [first, second] = match is_turned {
            false => [&halves[0], &halves[1]],
            true => [&halves[1], &halves[0]],
        };
        let sets = [first, second].map(Upper::units);

        // Vertices that get longer because a half of this cut is in between.
        let mut cost = 0;
        for (span, count) in &spans {
            let [in_first, in_second] = sets.map(|set| span.units & set != 0);
            let is_before = span.is_before || span.units & before != 0;
            let is_after = span.is_behind || span.units & after != 0;
            if in_first && !in_second && is_after {
                cost += count * second.len(lens);
            }
            if in_second && !in_first && is_before {
                cost += count * first.len(lens);
            }
        }

        // The cuts inside each half, with the other half around it.
        let inside = [
            best(first, lens, &spans, [before, after | sets[1]]),
            best(second, lens, &spans, [before | sets[0], after]),
        ];
        cost += inside[0].0 + inside[1].0;
        let turns = [vec![is_turned], inside.map(|(_, turns)| turns).concat()];
        (cost, turns.concat())
    });

    let [straight, turned] = ways;
    if turned.0 < straight.0 {
        turned
    } else {
        straight
    }
}

/// Appends the blocks from first to last; `turns` as [`best`] gives them.
fn in_order<'b>(tree: &Upper, turns: &mut impl Iterator<Item = &'b bool>, order: &mut Vec<u32>) {
    match tree {
        Upper::Unit(unit) => order.push(*unit),
        Upper::Cut(halves, ..) => {
            let is_turned = turns.next().copied().unwrap_or_default();
            let first = usize::from(is_turned);
            in_order(&halves[first], turns, order);
            in_order(&halves[1 - first], turns, order);
        }
    }
}
