//! A graph cut into two sides.

use super::coarsen::coarser;
use super::graph::Graph;
use super::refine::Sides;
use crate::index::index32;
use crate::random::SplitMix64;

/// The cut that is asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bisection {
    /// The weight that the first side should have.
    pub(crate) first: u64,
    /// The most that each side may weigh; exceeded only where vertices are too heavy to do better.
    pub(crate) most: [u64; 2],
    pub(crate) seed: u64,
    /// Graphs of at most this many vertices are cut without making them coarser.
    pub(crate) coarsest: usize,
    /// How many start vertices are tried on the coarsest graph.
    pub(crate) tries: u32,
    /// Most passes of moving vertices across the cut on each level.
    pub(crate) passes: usize,
    /// How many moves without a better cut end a pass on a small graph.
    pub(crate) patience: usize,
}

/// Whether each vertex is on the second side.
///
/// Time O((vertices + edges) · log boundary).
pub(crate) fn halves(graph: &Graph, asked: &Bisection) -> Vec<bool> {
    let mut random = SplitMix64(asked.seed);

    // Coarser and coarser graphs, each with the group of each vertex of the one before.
    let mut levels: Vec<(Graph, Vec<u32>)> = Vec::new();
    // No vertex much heavier than the mean of the coarsest level, so that this can be balanced.
    let heaviest = (graph.weight() / (asked.coarsest as u64).max(1)).max(1) * 3 / 2;
    loop {
        let last = levels.last().map_or(graph, |(graph, _)| graph);
        if last.vertex_count() <= asked.coarsest {
            break;
        }
        match coarser(last, heaviest.max(2), &mut random) {
            Some(level) => levels.push(level),
            None => break,
        }
    }

    // Cut the coarsest, then refine the cut on each finer graph.
    let coarsest = levels.last().map_or(graph, |(graph, _)| graph);
    let mut side = grown(coarsest, asked, &mut random);
    while let Some((_, group_of)) = levels.pop() {
        let finer = levels.last().map_or(graph, |(graph, _)| graph);
        let inherited = group_of.iter().map(|&group| side[group as usize]).collect();
        let mut sides = Sides::new(finer, inherited, asked.most);
        sides.refine(asked.passes, asked.patience_on(finer));
        side = sides.side;
    }
    side
}

impl Bisection {
    /// The patience for a graph: larger graphs need more moves before a cut gets better.
    fn patience_on(&self, graph: &Graph) -> usize {
        (graph.vertex_count() / 50).clamp(self.patience, 400)
    }
}

/// The best of several cuts, each of which grows the first side from a vertex at one end of the
/// graph and refines the cut.
fn grown(graph: &Graph, asked: &Bisection, random: &mut SplitMix64) -> Vec<bool> {
    let mut best: Option<Sides<'_>> = None;
    let vertex_count = graph.vertex_count();
    let mut far = 0;

    for attempt in 0..asked.tries.max(1) {
        // Start from the vertex farthest from a random one, then from the one farthest from that.
        let start = match attempt % 2 {
            0 => {
                let start = index32(random.below(vertex_count));
                by_distance(graph, start, u64::MAX)
                    .last()
                    .copied()
                    .unwrap_or(0)
            }
            _ => far,
        };

        // The far end is found only if the next attempt starts there.
        let is_far_of_use = attempt % 2 == 0 && attempt + 1 < asked.tries;
        let enough = if is_far_of_use { u64::MAX } else { asked.first };
        let order = by_distance(graph, start, enough);
        far = order.last().copied().unwrap_or(0);

        // Fill the first side up to its weight.
        let mut side = vec![true; vertex_count];
        let mut weight = 0;
        for vertex in order {
            let next = weight + u64::from(graph.weights[vertex as usize]);
            // Closer to the weight without this vertex than with it.
            if next > asked.first && next - asked.first > asked.first - weight {
                break;
            }
            weight = next;
            side[vertex as usize] = false;
            if weight >= asked.first {
                break;
            }
        }

        let mut sides = Sides::new(graph, side, asked.most);
        sides.refine(asked.passes, asked.patience_on(graph));
        let is_better = best
            .as_ref()
            .is_none_or(|best| (sides.excess(), sides.cut) < (best.excess(), best.cut));
        if is_better {
            best = Some(sides);
        }
    }
    best.map_or(Vec::new(), |sides| sides.side)
}

/// Vertices by their distance from `start`, then those not connected with it, piece by piece, until
/// they weigh more than `enough`.
fn by_distance(graph: &Graph, start: u32, enough: u64) -> Vec<u32> {
    let vertex_count = graph.vertex_count();
    let mut is_reached = vec![false; vertex_count];
    let mut order = Vec::with_capacity(vertex_count);
    let mut next = 0;
    let mut weight = 0;

    let starts = (vertex_count > 0).then_some(start).into_iter();
    for piece in starts.chain(0..index32(vertex_count)) {
        if std::mem::replace(&mut is_reached[piece as usize], true) {
            continue;
        }

        // Breadth first from a vertex that was not reached.
        order.push(piece);
        while let Some(&vertex) = order.get(next) {
            next += 1;
            weight += u64::from(graph.weights[vertex as usize]);
            if weight > enough {
                return order;
            }
            for &(other, _) in graph.row(vertex) {
                if !std::mem::replace(&mut is_reached[other as usize], true) {
                    order.push(other);
                }
            }
        }
    }
    order
}
