//! A graph cut into any number of parts.

use super::bisection::{Bisection, halves};
use super::graph::Graph;
use super::part_weights;
use crate::index::index32;
use crate::parallel;
use crate::random::SplitMix64;

/// Cuts a graph into parts of similar weight with few edges between them.
///
/// ```
/// use meshweft::partition::{Graph, Multilevel, edge_cut, imbalance};
/// // A ladder of 100 squares.
/// let square = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
/// let faces: Vec<_> = (0..100).flat_map(square).collect();
/// let graph = Graph::dual(&faces);
/// let parts = Multilevel { parts: 4, ..Default::default() }.partition(&graph);
/// assert_eq!(edge_cut(&graph, &parts), 3);
/// assert!(imbalance(&graph, &parts, 4) <= 1.03);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Multilevel {
    /// How many parts.
    pub parts: u32,
    /// How many times the mean a part may weigh. A part of few or heavy vertices may exceed that by
    /// one vertex.
    pub imbalance: f64,
    /// Seed of the random numbers. The same seed gives the same parts, on any platform and any
    /// number of threads.
    pub seed: u64,
}

impl Default for Multilevel {
    fn default() -> Self {
        Self {
            parts: 2,
            imbalance: 1.03,
            seed: 0,
        }
    }
}

impl Multilevel {
    /// The part of each vertex, below [`parts`](Self::parts); with fewer vertices than parts, some
    /// are empty.
    ///
    /// # Panics
    /// If `parts` is 0, or `imbalance` is below 1.
    ///
    /// # Complexity
    /// Time O((vertices + edges) · log parts), space 40 bytes a vertex and 16 an edge.
    #[must_use]
    pub fn partition(&self, graph: &Graph) -> Vec<u32> {
        assert!(self.parts > 0, "a graph has one part at least");
        assert!(self.imbalance >= 1.0, "a part weighs the mean at least");

        // Halve again and again.
        let mean = graph.weight() as f64 / f64::from(self.parts);
        let levels = self.parts.next_power_of_two().ilog2();
        let all: Vec<u32> = (0..index32(graph.vertex_count())).collect();
        let job = Job {
            graph: graph.clone(),
            members: all,
            first_part: 0,
            parts: self.parts,
            level: 1,
            seed: self.seed,
        };
        let rules = Rules {
            mean,
            slack: self.imbalance - 1.0,
            levels,
        };
        let mut part_of = vec![0; graph.vertex_count()];
        for (part, members) in rules.cut(job) {
            for vertex in members {
                part_of[vertex as usize] = part;
            }
        }

        // Then move vertices between any two parts.
        if self.parts > 2 {
            refine(graph, &mut part_of, self.parts, rules.most(1, levels));
        }
        part_of
    }
}

/// How heavy parts may be: the mean weight, and the share above it, which `levels` cuts use up.
#[derive(Debug, Clone, Copy)]
struct Rules {
    mean: f64,
    slack: f64,
    levels: u32,
}

/// A piece that is still to be cut.
struct Job {
    graph: Graph,
    /// The vertices of the whole graph that it has.
    members: Vec<u32>,
    /// The first of the parts that it becomes, and how many.
    first_part: u32,
    parts: u32,
    /// The number of the next cut, from 1.
    level: u32,
    seed: u64,
}

impl Rules {
    /// The most that a piece of `parts` parts may weigh after `level` cuts; each cut may use an
    /// equal share of the slack.
    fn most(self, parts: u32, level: u32) -> u64 {
        let used = f64::from(level) / f64::from(self.levels.max(1));
        let most = self.mean * f64::from(parts) * (1.0 + self.slack * used);
        // The mean may be a fraction, which matters for parts of few vertices.
        let least = (self.mean * f64::from(parts)).ceil();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "weights are far below 2^53"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a product of what is not negative")]
        {
            most.floor().max(least) as u64
        }
    }

    /// The parts of a piece, each with its vertices of the whole graph.
    fn cut(self, job: Job) -> Vec<(u32, Vec<u32>)> {
        if job.parts == 1 {
            return vec![(job.first_part, job.members)];
        }

        // Two sides, each of half of the parts.
        let second = job.parts / 2;
        let first = job.parts - second;
        let weight = job.graph.weight();
        let asked = Bisection {
            first: weight * u64::from(first) / u64::from(job.parts),
            most: [first, second].map(|parts| self.most(parts, job.level)),
            seed: job.seed,
            coarsest: 80,
            tries: 8,
            passes: 8,
            patience: 25,
        };
        let side = halves(&job.graph, &asked);

        // Each side is a job of its own.
        let [a, b] = job.graph.split(&side);
        let pieces = [
            (a, job.first_part, first),
            (b, job.first_part + first, second),
        ];
        let jobs = pieces.map(|((graph, inside), first_part, parts)| Job {
            graph,
            members: inside.iter().map(|&i| job.members[i as usize]).collect(),
            first_part,
            parts,
            level: job.level + 1,
            seed: SplitMix64(job.seed ^ u64::from(first_part)).next(),
        });
        parallel::map(jobs.into(), |job| self.cut(job)).concat()
    }
}

/// Moves vertices to the neighbouring part with most of their edges, as long as the cut gets
/// smaller, in at most eight passes.
fn refine(graph: &Graph, part_of: &mut [u32], parts: u32, most: u64) {
    let mut weights = part_weights(graph, part_of, parts);
    let mut links: Vec<(u32, u64)> = Vec::new();

    for _ in 0..8 {
        let mut is_better = false;
        for vertex in 0..index32(graph.vertex_count()) {
            // The weight of the edges to each part, its own part first.
            let here = part_of[vertex as usize];
            links.clear();
            links.push((here, 0));
            for &(other, weight) in graph.row(vertex) {
                let part = part_of[other as usize];
                match links.iter_mut().find(|link| link.0 == part) {
                    Some(link) => link.1 += u64::from(weight),
                    None => links.push((part, u64::from(weight))),
                }
            }

            // The part with most; ties to the lighter part, which leaves room in the heavier one.
            let weight = u64::from(graph.weights[vertex as usize]);
            let inside = links[0].1;
            let fits = |link: &&(u32, u64)| weights[link.0 as usize] + weight <= most;
            let best = links[1..].iter().filter(fits);
            let best =
                best.max_by_key(|link| (link.1, std::cmp::Reverse(weights[link.0 as usize])));
            let Some(&(part, outside)) = best else {
                continue;
            };

            // Move the vertex if that cuts less, or as much with better balance.
            let evens = weights[part as usize] + weight < weights[here as usize];
            if outside > inside || (outside == inside && evens) {
                is_better |= outside > inside;
                weights[here as usize] -= weight;
                weights[part as usize] += weight;
                part_of[vertex as usize] = part;
            }
        }
        if !is_better {
            break;
        }
    }
}
