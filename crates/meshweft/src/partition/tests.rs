//! Compared with brute force.

use proptest::prelude::*;

use super::*;
use crate::random::SplitMix64;

/// The least of all cuts with both sides within `most`.
fn least_cut(graph: &Graph, most: u64) -> u64 {
    let count = graph.vertex_count();
    let sides =
        (0_u32..1 << count).map(|bits| -> Vec<u32> { (0..count).map(|i| bits >> i & 1).collect() });
    let balanced = sides.filter(|side| {
        let weights = part_weights(graph, side, 2);
        weights.iter().all(|&weight| weight <= most)
    });
    balanced.map(|side| edge_cut(graph, &side)).min().unwrap()
}

/// Random edges among a few vertices.
fn graphs() -> impl Strategy<Value = Graph> {
    let edges = |n: u32| prop::collection::vec((0..n, 0..n, 1..4_u32), 0..3 * n as usize);
    (2..13_u32).prop_flat_map(move |n| {
        edges(n).prop_map(move |edges| Graph::from_edges(n as usize, &edges))
    })
}

proptest! {
    #[test]
    fn tiny_cuts_are_balanced(graph in graphs()) {
        let parts = Multilevel::default().partition(&graph);
        let most = graph.weight().div_ceil(2);
        prop_assert!(part_weights(&graph, &parts, 2).iter().all(|&weight| weight <= most));
        prop_assert!(edge_cut(&graph, &parts) >= least_cut(&graph, most));
    }

    #[test]
    fn parts_are_balanced_whatever_the_graph(
        graph in graphs(), parts in 1..16_u32, seed in any::<u64>()
    ) {
        let found = Multilevel { parts, seed, ..Default::default() }.partition(&graph);
        prop_assert_eq!(found.len(), graph.vertex_count());
        let weights = part_weights(&graph, &found, parts);
        let most = graph.weight().div_ceil(u64::from(parts));
        // A cut into uneven shares may round twice.
        prop_assert!(weights.iter().all(|&weight| weight <= most + 1), "{:?}", weights);
    }

    #[test]
    fn a_contraction_keeps_weights_and_cuts(graph in graphs(), seed in any::<u64>()) {
        let mut random = SplitMix64(seed);
        let Some((coarse, group_of)) = coarsen::coarser(&graph, 100, &mut random) else {
            return Ok(());
        };
        prop_assert_eq!(coarse.weight(), graph.weight());
        let parts: Vec<u32> = (0..index32(coarse.vertex_count())).map(|v| v % 2).collect();
        let fine: Vec<u32> = group_of.iter().map(|&group| parts[group as usize]).collect();
        prop_assert_eq!(edge_cut(&coarse, &parts), edge_cut(&graph, &fine));
    }

    #[test]
    fn halves_have_the_edges_that_are_not_cut(graph in graphs(), bits in any::<u32>()) {
        let side: Vec<bool> = (0..graph.vertex_count()).map(|i| bits >> i & 1 == 1).collect();
        let parts: Vec<u32> = side.iter().map(|&side| side.into()).collect();
        let inside = |graph: &Graph| graph.edges.entries().iter().map(|e| u64::from(e.1)).sum::<u64>() / 2;
        let [(a, in_a), (b, in_b)] = graph.split(&side);
        prop_assert_eq!(in_a.len() + in_b.len(), graph.vertex_count());
        prop_assert_eq!(inside(&a) + inside(&b) + edge_cut(&graph, &parts), inside(&graph));
    }
}

#[test]
fn tiny_cuts_are_near_the_least() {
    let mut random = SplitMix64(1);
    let mut below = |limit: u32| index32(random.below(limit as usize));
    let (mut sum, mut least_sum) = (0, 0);
    for _ in 0..300 {
        let count = 4 + below(8);
        let edges: Vec<_> = (0..2 * count)
            .map(|_| (below(count), below(count), 1 + below(3)))
            .collect();
        let graph = Graph::from_edges(count as usize, &edges);
        let parts = Multilevel::default().partition(&graph);
        sum += edge_cut(&graph, &parts);
        least_sum += least_cut(&graph, graph.weight().div_ceil(2));
    }
    assert!(sum * 100 <= least_sum * 103, "{sum}, least {least_sum}");
}

/// A square grid of `side` × `side` vertices.
fn grid(side: u32) -> Graph {
    let mut edges = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let vertex = y * side + x;
            if x + 1 < side {
                edges.push((vertex, vertex + 1, 1));
            }
            if y + 1 < side {
                edges.push((vertex, vertex + side, 1));
            }
        }
    }
    Graph::from_edges((side * side) as usize, &edges)
}

#[test]
fn a_square_is_cut_straight() {
    let graph = grid(64);
    for (parts, straight) in [(2, 64), (4, 128), (16, 384)] {
        let found = Multilevel {
            parts,
            ..Default::default()
        }
        .partition(&graph);
        assert!(imbalance(&graph, &found, parts) <= 1.03);
        let cut = edge_cut(&graph, &found);
        assert!(cut <= straight * 5 / 4, "{parts} parts: {cut}");
    }
}

#[test]
fn pieces_need_no_cut() {
    // Sixteen separate triangles.
    let edge = |i: u32, j: u32| (3 * (i / 3) + j, 3 * (i / 3) + (j + 1) % 3, 1);
    let edges: Vec<_> = (0..48).map(|i| edge(i, i % 3)).collect();
    let graph = Graph::from_edges(48, &edges);
    let found = Multilevel {
        parts: 4,
        ..Default::default()
    }
    .partition(&graph);
    assert_eq!(edge_cut(&graph, &found), 0);
    assert_eq!(imbalance(&graph, &found, 4), 1.0);
    let nothing = Multilevel {
        parts: 3,
        ..Default::default()
    }
    .partition(&Graph::from_edges(0, &[]));
    assert!(nothing.is_empty());
}

#[test]
fn the_dual_graph_of_odd_faces() {
    // An edge of three faces, a face twice, one that names a vertex twice.
    let faces = [
        [0, 1, 2],
        [1, 0, 3],
        [0, 1, 4],
        [5, 6, 7],
        [5, 6, 7],
        [8, 8, 9],
    ];
    let graph = Graph::dual(&faces);
    let degrees = (0..6).map(|face| graph.neighbours(face).count());
    assert_eq!(degrees.collect::<Vec<_>>(), [1, 2, 1, 1, 1, 0]);
    assert_eq!(graph.neighbours(3).next(), Some((4, 3)));
}
