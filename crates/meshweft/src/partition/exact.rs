//! Parts of an exact number of vertices.

use super::bisection::{Bisection, halves};
use super::clusters::clustered;
use super::edge_cut;
use super::exchange::{Exchange, NO_PART};
use super::graph::Graph;
use super::links::Links;
use crate::faces::Faces;
use crate::index::index32;
use crate::parallel;
use crate::topology::rows::Rows;

/// Vertices in a cluster: so few that a border along clusters is smooth after a few moves, so many
/// that cutting the graph of clusters takes a small part of the time.
const MOST_IN_CLUSTER: usize = 32;

/// How many cuts of clusters the best is taken of.
const SEEDS: u64 = 6;

/// Rounds over all borders before and after the sizes are made exact.
const ROUNDS: usize = 4;

/// The part of each vertex of a mesh, with few faces across borders: every part has exactly `size`
/// vertices, but for the last one, which has the rest. Vertices on no face are in none ([`NO_PART`]).
///
/// The vertices are put in small clusters, the graph of clusters is cut by bisection, then vertices
/// move between neighbouring parts: first to cut less, then along chains of neighbouring parts until
/// all sizes are exact, then in exchange.
///
/// Time O((vertices + faces) · log parts), space 70 bytes a face.
///
/// # Panics
/// If `size` is 0.
pub(crate) fn exact_parts(faces: Faces<'_>, size: usize) -> Vec<u32> {
    let links = Links::new(faces);
    let used = (0..index32(links.vertex_count())).filter(|&vertex| links.is_used(vertex));
    let used = used.count();
    let targets: Vec<usize> = (0..used.div_ceil(size))
        .map(|part| size.min(used - part * size))
        .collect();
    if targets.len() < 2 {
        let part = |vertex| if links.is_used(vertex) { 0 } else { NO_PART };
        return (0..index32(links.vertex_count())).map(part).collect();
    }

    // Cut the graph of clusters.
    let most_in_cluster = (size / 64).clamp(1, MOST_IN_CLUSTER);
    let (graph, cluster_of) = clustered(&links, most_in_cluster);
    let mut part_of_cluster = vec![NO_PART; graph.vertex_count()];
    let all = (0..index32(graph.vertex_count())).collect();
    let whole = Halving {
        graph,
        members: all,
        first_part: 0,
        targets: &targets,
        slack: 4 * most_in_cluster as u64,
    };
    for (part, members) in whole.cut() {
        for cluster in members {
            part_of_cluster[cluster as usize] = part;
        }
    }
    let part_of = cluster_of
        .iter()
        .map(|&cluster| {
            part_of_cluster
                .get(cluster as usize)
                .copied()
                .unwrap_or(NO_PART)
        })
        .collect();

    // Move vertices.
    let mut balance = Balance {
        exchange: Exchange::new(&links, part_of, targets.len()),
        targets,
    };
    balance.refine(size / 32);
    balance.make_exact();
    balance.refine(0);
    balance.exchange.part_of
}

/// A piece that is still to be cut.
struct Halving<'a> {
    graph: Graph,
    /// The clusters that it has.
    members: Vec<u32>,
    first_part: u32,
    /// The size of each part that it becomes.
    targets: &'a [usize],
    /// How many vertices a side may have too many: more than a cluster has, or a share of the side.
    slack: u64,
}

impl Halving<'_> {
    /// The parts of the piece, each with its clusters.
    fn cut(self) -> Vec<(u32, Vec<u32>)> {
        if self.targets.len() == 1 {
            return vec![(self.first_part, self.members)];
        }

        // Two sides of about as many parts, near their sizes: vertices make them exact later.
        let targets = self.targets.split_at(self.targets.len().div_ceil(2));
        let [first, second] = [targets.0, targets.1].map(|t| t.iter().sum::<usize>() as u64);
        let slack = |weight: u64| weight + (weight / 256).max(self.slack);
        let seeds = (0..SEEDS).map(|seed| seed + SEEDS * u64::from(self.first_part));
        let sides = parallel::map(seeds.collect(), |seed| {
            let asked = Bisection {
                first,
                most: [slack(first), slack(second)],
                seed,
                coarsest: 80,
                tries: 8,
                passes: 8,
                patience: 25,
            };
            let side = halves(&self.graph, &asked);
            let number: Vec<u32> = side.iter().map(|&side| side.into()).collect();
            (edge_cut(&self.graph, &number), side)
        });
        let best = sides.into_iter().min_by_key(|(cut, _)| *cut);
        let (_, side) = best.expect("one seed at least");

        // Each side is a piece of its own.
        let [a, b] = self.graph.split(&side);
        let second_part = self.first_part + index32(targets.0.len());
        let sides = [(a, self.first_part, targets.0), (b, second_part, targets.1)];
        let pieces = sides.map(|((graph, inside), first_part, targets)| Halving {
            graph,
            members: inside.iter().map(|&i| self.members[i as usize]).collect(),
            first_part,
            targets,
            slack: self.slack,
        });
        parallel::map(pieces.into(), Self::cut).concat()
    }
}

/// Parts on the way to their sizes.
struct Balance<'a> {
    exchange: Exchange<'a>,
    targets: Vec<usize>,
}

impl Balance<'_> {
    /// How many vertices a part has too many.
    fn surplus(&self, part: u32) -> i64 {
        let part = part as usize;
        self.exchange.sizes[part] as i64 - self.targets[part] as i64
    }

    /// Moves vertices across each border as long as less is cut; each size stays within `slack` of
    /// its target, or moves towards it.
    fn refine(&mut self, slack: usize) {
        let slack = slack as i64;
        for _ in 0..ROUNDS {
            let mut is_better = false;
            for [a, b] in self.exchange.pairs() {
                // A cut that does not get better takes one pass, others a few.
                for _ in 0..ROUNDS {
                    let (over_a, over_b) = (self.surplus(a), self.surplus(b));
                    let least = (over_a - slack).max(-over_b - slack);
                    let most = (over_a + slack).min(slack - over_b);
                    // Where both cannot be had, half way.
                    let middle = i64::midpoint(least, most);
                    let aim = if least <= most {
                        least..=most
                    } else {
                        middle..=middle
                    };
                    if !self.exchange.pass([a, b], aim) {
                        break;
                    }
                    is_better = true;
                }
            }
            if !is_better {
                break;
            }
        }
    }

    /// Moves vertices from parts with too many, through neighbouring parts, to those with too few.
    fn make_exact(&mut self) {
        loop {
            let parts = 0..index32(self.targets.len());
            let Some(from) = parts.max_by_key(|&part| (self.surplus(part), u32::MAX - part)) else {
                break;
            };
            if self.surplus(from) <= 0 {
                break;
            }

            let chain = self.chain_to_room(from);
            let &to = chain.last().unwrap_or(&from);
            let count = self.surplus(from).min(-self.surplus(to));
            for hop in chain.windows(2) {
                self.give([hop[0], hop[1]], count);
            }
        }
    }

    /// Moves so many vertices from one part to another, whatever it costs.
    fn give(&mut self, hop: [u32; 2], count: i64) {
        let size = |balance: &Self| balance.exchange.sizes[hop[0] as usize];
        let before = size(self) as i64;
        self.exchange.pass(hop, count..=count);

        // Where the border gave no more.
        let given = before - size(self) as i64;
        let missing = usize::try_from(count - given).unwrap_or(0);
        self.exchange.carve(hop, missing);
    }

    /// Neighbouring parts from one to the nearest with too few vertices; just the two if none can be
    /// reached.
    fn chain_to_room(&self, from: u32) -> Vec<u32> {
        const UNREACHED: u32 = u32::MAX;
        let mut before = vec![UNREACHED; self.targets.len()];
        let pairs = self.exchange.pairs();
        let both_ways = pairs.iter().flat_map(|&[a, b]| [(a, b), (b, a)]);
        let neighbours = Rows::by_counting(self.targets.len(), both_ways);
        let (mut reached, mut next) = (vec![from], 0);
        before[from as usize] = from;

        while let Some(&part) = reached.get(next) {
            next += 1;
            if self.surplus(part) < 0 {
                let mut chain = vec![part];
                while chain.last() != Some(&from) {
                    chain.push(before[chain[chain.len() - 1] as usize]);
                }
                chain.reverse();
                return chain;
            }
            for &other in neighbours.row(part) {
                if before[other as usize] == UNREACHED {
                    before[other as usize] = part;
                    reached.push(other);
                }
            }
        }
        let parts = 0..index32(self.targets.len());
        let room = parts.min_by_key(|&part| self.surplus(part));
        vec![from, room.unwrap_or(from)]
    }
}
