//! Compared with brute force.

use proptest::prelude::*;

use super::*;
use crate::faces::Faces;
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

/// Soups: few vertices named by random faces, some of them degenerate, some vertices unused.
fn soups() -> impl Strategy<Value = (Vec<[u32; 3]>, usize)> {
    (1..200_u32).prop_flat_map(|n| {
        let faces = prop::collection::vec([0..n, 0..n, 0..n], 0..2 * n as usize);
        faces.prop_map(move |faces| (faces, n as usize + 3))
    })
}

/// For each vertex of the faces, how many edges it has to each other one.
fn edges_by_brute_force(faces: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for face in faces {
        let mut corners = face.to_vec();
        corners.sort_unstable();
        corners.dedup();
        for (i, &a) in corners.iter().enumerate() {
            edges.extend(corners[i + 1..].iter().map(|&b| [a, b]));
        }
    }
    edges
}

fn cut_by_brute_force(faces: &[[u32; 3]], parts: &[u32]) -> usize {
    let is_cut = |[a, b]: &&[u32; 2]| parts[*a as usize] != parts[*b as usize];
    edges_by_brute_force(faces).iter().filter(is_cut).count()
}

proptest! {
    #[test]
    fn exact_parts_are_exact((faces, vertex_count) in soups(), size in 1..90_usize) {
        let parts = exact_parts(Faces::of_checked(&faces, vertex_count), size);
        let mut is_used = vec![false; vertex_count];
        faces.as_flattened().iter().for_each(|&v| is_used[v as usize] = true);
        let used = is_used.iter().filter(|&&used| used).count();

        let mut sizes = vec![0; used.div_ceil(size)];
        for (&part, is_used) in parts.iter().zip(is_used) {
            prop_assert_eq!(part != NO_PART, is_used);
            if is_used {
                sizes[part as usize] += 1;
            }
        }
        for (part, &found) in sizes.iter().enumerate() {
            prop_assert_eq!(found, size.min(used - part * size));
        }
    }

    #[test]
    fn an_exchange_keeps_its_word(
        (faces, vertex_count) in soups(), seed in any::<u64>(), given in -5..6_i64
    ) {
        let links = links::Links::new(Faces::of_checked(&faces, vertex_count));
        let edges: Vec<[u32; 2]> = links.edges().collect();
        let mut sorted: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        let mut expected = edges_by_brute_force(&faces);
        sorted.sort_unstable();
        expected.sort_unstable();
        prop_assert_eq!(sorted, expected);

        // Three parts at random; vertices move between the first two.
        let mut random = SplitMix64(seed);
        let vertices = 0..index32(vertex_count);
        let part = |vertex| match links.is_used(vertex) {
            true => index32(random.below(3)),
            false => NO_PART,
        };
        let before: Vec<u32> = vertices.map(part).collect();
        let mut exchange = exchange::Exchange::new(&links, before.clone(), 3);
        let sizes = exchange.sizes.clone();
        let is_better = exchange.pass([0, 1], given..=given);
        let after = &exchange.part_of;
        let [cut, cut_after] = [&before, after].map(|parts| cut_by_brute_force(&faces, parts));
        let is_moved = exchange.sizes != sizes;
        prop_assert!(cut_after <= cut || is_moved, "{} {}", cut, cut_after);
        prop_assert_eq!(is_better, after != &before);
        for part in 0..3 {
            let count = after.iter().filter(|&&p| p == index32(part)).count();
            prop_assert_eq!(exchange.sizes[part], count);
        }
        let still = before.iter().zip(after).all(|(a, b)| a == b || a + b == 1);
        prop_assert!(still, "only between the two");
    }
}

#[test]
fn exact_cuts_of_tiny_meshes_are_near_the_least() {
    let mut random = SplitMix64(5);
    let (mut sum, mut least_sum) = (0, 0);
    for _ in 0..200 {
        let count = 4 + random.below(7);
        let faces: Vec<[u32; 3]> = (0..count)
            .map(|_| [(); 3].map(|()| index32(random.below(count))))
            .collect();
        let parts = exact_parts(Faces::of_checked(&faces, count), count.div_ceil(2));
        sum += cut_by_brute_force(&faces, &parts);

        // All ways to choose as many for the first part.
        let first = parts.iter().filter(|&&part| part == 0).count();
        let used: Vec<usize> = (0..count).filter(|&v| parts[v] != NO_PART).collect();
        let ways = (0_u32..1 << used.len()).filter(|bits| bits.count_ones() as usize == first);
        let cut = |bits: u32| {
            let mut parts = vec![1; count];
            for (i, &vertex) in used.iter().enumerate() {
                parts[vertex] = 1 - (bits >> i & 1);
            }
            cut_by_brute_force(&faces, &parts)
        };
        least_sum += ways.map(cut).min().unwrap_or(0);
    }
    assert!(
        sum >= least_sum && sum * 100 <= least_sum * 110,
        "{sum}, least {least_sum}"
    );
}

/// A square grid of `side` × `side` squares.
fn squares(side: u32) -> Vec<[u32; 3]> {
    let square = |i: u32| {
        let corner = i / side * (side + 1) + i % side;
        let above = corner + side + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    (0..side * side).flat_map(square).collect()
}

#[test]
fn exact_parts_of_a_square_have_short_borders() {
    let (side, size) = (127, 1000);
    let faces = squares(side);
    let vertex_count = 128 * 128;
    let shuffled = crate::Permutation::random(vertex_count, 3).old_to_new();
    let faces: Vec<_> = faces
        .iter()
        .map(|face| face.map(|v| shuffled[v as usize]))
        .collect();
    let parts = exact_parts(Faces::of_checked(&faces, vertex_count), size);
    let across = faces.iter().filter(|face| {
        let [a, b, c] = face.map(|v| parts[v as usize]);
        a != b || b != c
    });
    // 17 parts of about 32 x 32: as many borders as a square of 4 x 4 of them has, and a fifth more.
    let across = across.count();
    assert!(across <= 6 * 128 * 2 * 6 / 5, "{across}");
}

#[test]
fn exact_parts_keep_whole_what_can_be() {
    // A thousand separate strips of 20 vertices, by twos: no strip needs to be cut.
    let strip = |s: u32| (0..18).map(move |i| [i, i + 1, i + 2].map(|v| 20 * s + v));
    let faces: Vec<_> = (0..1000).flat_map(strip).collect();
    let parts = exact_parts(Faces::of_checked(&faces, 20_000), 6400);
    let cut = cut_by_brute_force(&faces, &parts);
    assert!(cut <= 12, "{cut}");
}

#[test]
fn exact_parts_of_a_hub_take_no_longer_than_linear() {
    // A fan of 100,000 faces around one vertex, and one face twice.
    let mut faces: Vec<_> = (1..100_001).map(|i| [0, i, i + 1]).collect();
    faces.push([0, 1, 2]);
    let parts = exact_parts(Faces::of_checked(&faces, 100_002), 1 << 16);
    assert_eq!(parts.iter().filter(|&&part| part == 0).count(), 1 << 16);
}

#[cfg(feature = "parallel")]
#[test]
fn exact_parts_do_not_depend_on_threads() {
    let faces = squares(100);
    let faces = Faces::of_checked(&faces, 101 * 101);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| exact_parts(faces, 777))
    };
    assert_eq!(on(1), on(4));
}
