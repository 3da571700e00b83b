//! Balanced cuts of graphs: few edges between parts of similar weight.
//!
//! Multilevel bisection (G. Karypis, V. Kumar: *A Fast and High Quality Multilevel Scheme for
//! Partitioning Irregular Graphs*, SIAM Journal on Scientific Computing 20, 1998,
//! doi:10.1137/S1064827595287997). The graph is made coarser by contracting heavy edges until it is
//! tiny. The tiny graph is cut by growing one side from a start vertex. On the way back each finer
//! graph inherits the cut and moves vertices across it ([`Multilevel`]). For more parts the halves
//! are cut again, in parallel; at the end vertices move between any two parts.
//!
//! Parts of an exact number of vertices of a mesh (`exact`) are cut the same way from a graph of small
//! clusters; then vertices move between neighbouring parts, at the cost of the border alone
//! (`exchange`), until all sizes are exact.
//!
//! Read `graph`, then `bisection`; most of the quality comes from `refine`.

mod bisection;
mod clusters;
mod coarsen;
mod exact;
mod exchange;
mod graph;
mod k_way;
mod links;
#[cfg(feature = "metis")]
mod metis;
mod refine;

pub(crate) use bisection::{Bisection, halves};
pub(crate) use coarsen::coarser;
pub(crate) use exact::exact_parts;
pub(crate) use exchange::NO_PART;
pub use graph::Graph;
pub use k_way::Multilevel;
#[cfg(feature = "metis")]
pub use metis::{Metis, MetisError};

use crate::index::index32;

/// The weight of all edges between different parts; `parts[vertex]` is the part of each vertex.
///
/// # Panics
/// If there are fewer entries than vertices.
///
/// # Complexity
/// Time O(vertices + edges).
#[must_use]
pub fn edge_cut(graph: &Graph, parts: &[u32]) -> u64 {
    let mut cut = 0;
    for (vertex, &part) in (0..index32(graph.vertex_count())).zip(parts) {
        let is_cut = |(other, _): &(u32, u32)| parts[*other as usize] != part;
        let edges = graph.neighbours(vertex).filter(is_cut);
        cut += edges.map(|(_, weight)| u64::from(weight)).sum::<u64>();
    }
    cut / 2
}

/// The weight of the heaviest of `count` parts, over the mean: 1 if all weigh the same.
///
/// # Panics
/// If a part is not below `count`.
#[must_use]
pub fn imbalance(graph: &Graph, parts: &[u32], count: u32) -> f64 {
    let weights = part_weights(graph, parts, count);
    let most = weights.iter().max().copied().unwrap_or_default();
    most as f64 * f64::from(count) / (graph.weight() as f64).max(1.0)
}

fn part_weights(graph: &Graph, parts: &[u32], count: u32) -> Vec<u64> {
    let mut weights = vec![0; count as usize];
    for (&part, &weight) in parts.iter().zip(&graph.weights) {
        weights[part as usize] += u64::from(weight);
    }
    weights
}

#[cfg(test)]
mod tests;
