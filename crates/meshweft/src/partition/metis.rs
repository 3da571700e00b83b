//! The METIS library, to compare with.

use std::fmt;

use metis::option::{Seed, UFactor};

use super::graph::Graph;

/// Cuts a graph into parts by METIS (feature `metis`, which compiles its C code).
///
/// [`Multilevel`](super::Multilevel) does the same without C code.
#[derive(Debug, Clone, PartialEq)]
pub struct Metis {
    /// How many parts.
    pub parts: u32,
    /// How many times the mean a part may weigh; METIS sometimes exceeds it.
    pub imbalance: f64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Whether parts are made by halving; otherwise all are made at once and refined together.
    pub is_recursive: bool,
}

impl Default for Metis {
    fn default() -> Self {
        Self {
            parts: 2,
            imbalance: 1.03,
            seed: 0,
            is_recursive: true,
        }
    }
}

/// Why METIS made no parts.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum MetisError {
    /// There are more vertices, edges, weight or parts than 31 bits count.
    TooLarge,
    /// METIS reports an error; its text.
    Failed(String),
}

impl fmt::Display for MetisError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => f.write_str("the graph is too large for METIS: it counts to 2^31"),
            Self::Failed(reason) => write!(f, "METIS failed: {reason}"),
        }
    }
}

impl std::error::Error for MetisError {}

impl Metis {
    /// The part of each vertex, below [`parts`](Self::parts).
    ///
    /// # Errors
    /// [`MetisError`] if the graph is too large for METIS, or METIS fails.
    ///
    /// # Complexity
    /// Time O((vertices + edges) · log parts).
    pub fn partition(&self, graph: &Graph) -> Result<Vec<u32>, MetisError> {
        let number = |n: u32| i32::try_from(n).map_err(|_| MetisError::TooLarge);
        let numbers = |values: &mut dyn Iterator<Item = u32>| -> Result<Vec<i32>, MetisError> {
            values.map(number).collect()
        };
        let parts = number(self.parts)?;

        if self.parts < 2 || graph.edges.entries().is_empty() {
            // METIS refuses a graph without edges, for which any parts of similar weight are good.
            return Ok(super::Multilevel {
                parts: self.parts,
                imbalance: self.imbalance.max(1.0),
                seed: self.seed,
            }
            .partition(graph));
        }
        if graph.weight() > i32::MAX.unsigned_abs().into() {
            return Err(MetisError::TooLarge);
        }

        let offsets = numbers(&mut graph.edges.starts().iter().copied())?;
        let neighbours = numbers(&mut graph.edges.entries().iter().map(|edge| edge.0))?;
        let edge_weights = numbers(&mut graph.edges.entries().iter().map(|edge| edge.1))?;
        let weights = numbers(&mut graph.weights.iter().copied())?;
        #[expect(clippy::cast_possible_truncation, reason = "within what METIS takes")]
        let (slack, seed) = (
            ((self.imbalance - 1.0) * 1000.0).round().clamp(1.0, 1e6) as i32,
            (self.seed & 0x7fff_ffff) as i32,
        );

        let mut found = vec![0; graph.vertex_count()];
        let failed = |error: &dyn fmt::Display| MetisError::Failed(error.to_string());
        let metis = metis::Graph::new(1, parts, &offsets, &neighbours)
            .map_err(|error| failed(&error))?
            .set_vwgt(&weights)
            .set_adjwgt(&edge_weights)
            .set_option(UFactor(slack))
            .set_option(Seed(seed));
        let done = match self.is_recursive {
            true => metis.part_recursive(&mut found),
            false => metis.part_kway(&mut found),
        };
        done.map_err(|error| failed(&error))?;
        Ok(found.into_iter().map(i32::unsigned_abs).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partition::{edge_cut, imbalance};

    #[test]
    fn a_path_is_cut_once() {
        let edges: Vec<_> = (0..99).map(|i| (i, i + 1, 1)).collect();
        let graph = Graph::from_edges(100, &edges);
        for is_recursive in [true, false] {
            let metis = Metis {
                is_recursive,
                ..Metis::default()
            };
            let parts = metis.partition(&graph).unwrap();
            assert_eq!(edge_cut(&graph, &parts), 1);
            assert!(imbalance(&graph, &parts, 2) <= 1.03);
        }
    }

    #[test]
    fn graphs_that_metis_refuses_are_cut_all_the_same() {
        let graph = Graph::from_edges(4, &[]);
        let parts = Metis::default().partition(&graph).unwrap();
        assert_eq!(imbalance(&graph, &parts, 2), 1.0);
        let nothing = Graph::from_edges(0, &[]);
        assert!(Metis::default().partition(&nothing).unwrap().is_empty());
        let huge = Metis {
            parts: u32::MAX,
            ..Metis::default()
        };
        assert_eq!(huge.partition(&graph), Err(MetisError::TooLarge));
    }
}
