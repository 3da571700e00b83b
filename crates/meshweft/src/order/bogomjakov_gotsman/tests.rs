//! Compared with brute force.

use proptest::prelude::*;

use super::cut_tree::{CutTree, Cutting};
use super::linear_arrangement::{cost, oriented};
use super::*;
use crate::cache::{self, CacheModel};
use crate::mesh::Mesh;
use crate::order::baselines;
use crate::partition::Graph;
use crate::permutation::FaceOrder;

/// Random faces.
fn soups() -> impl Strategy<Value = Mesh> {
    (3..40_u32).prop_flat_map(|n| {
        prop::collection::vec([0..n, 0..n, 0..n], 0..80)
            .prop_map(move |faces| Mesh::connectivity_only(n as usize, faces).unwrap())
    })
}

/// A strip of squares, shuffled.
fn strip(squares: u32) -> Mesh {
    let square = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
    let faces: Vec<_> = (0..squares).flat_map(square).collect();
    let faces = baselines::random(faces.len(), 5).apply(&faces);
    Mesh::connectivity_only(2 * squares as usize + 2, faces).unwrap()
}

fn tree(mesh: &Mesh, piece: u32) -> CutTree {
    let graph = Graph::dual(mesh);
    let cutting = Cutting {
        piece,
        seed: 3,
        cutter: Cutter::Multilevel,
    };
    CutTree::new(&graph, &cutting)
}

/// Every sequence that swapping halves gives.
fn all_sequences(tree: &CutTree) -> Vec<Vec<u32>> {
    match tree {
        CutTree::Piece(faces) => vec![faces.clone()],
        CutTree::Cut(halves, _) => {
            let [first, second] = halves.each_ref().map(all_sequences);
            let pairs = first
                .iter()
                .flat_map(|a| second.iter().map(move |b| (a, b)));
            pairs
                .flat_map(|(a, b)| [[&a[..], b].concat(), [&b[..], a].concat()])
                .collect()
        }
    }
}

fn cost_in_order(mesh: &Mesh, sequence: &[u32]) -> u64 {
    let face = |&face: &u32| mesh.faces()[face as usize];
    cost(&sequence.iter().map(face).collect::<Vec<_>>())
}

fn is_order_of(order: &FaceOrder, mesh: &Mesh) -> bool {
    let mut faces = order.new_to_old().to_vec();
    faces.sort_unstable();
    faces.len() == mesh.face_count() && faces.iter().zip(0..).all(|(&face, i)| face == i)
}

proptest! {
    #[test]
    fn no_orientation_has_less_cost(
        corners in prop::collection::vec([0..7_u32, 0..7, 0..7], 1..9)
    ) {
        let mesh = Mesh::connectivity_only(7, corners).unwrap();
        let tree = tree(&mesh, 1);
        let all = all_sequences(&tree);
        let least = all.iter().map(|sequence| cost_in_order(&mesh, sequence)).min();
        let found = oriented(&tree, mesh.as_faces(), 6);
        prop_assert_eq!(Some(cost_in_order(&mesh, &found)), least);
    }

    #[test]
    fn a_few_levels_at_a_time_orient_the_same_tree(mesh in soups(), levels in 1..6_u32) {
        let tree = tree(&mesh, 1);
        let mut found = oriented(&tree, mesh.as_faces(), levels);
        found.sort_unstable();
        prop_assert!(found.into_iter().eq(0..u32::try_from(mesh.face_count()).unwrap()));
    }

    #[test]
    fn pieces_are_all_faces_and_no_larger_than_asked(mesh in soups(), piece in 1..20_u32) {
        let tree = tree(&mesh, piece);
        let mut faces = Vec::new();
        tree.for_each_face(&mut |face| faces.push(face));
        faces.sort_unstable();
        prop_assert_eq!(faces.len(), tree.len());
        prop_assert!(faces.into_iter().eq(0..u32::try_from(mesh.face_count()).unwrap()));
        prop_assert!(largest_piece(&tree) <= piece as usize);
    }

    #[test]
    fn soups_are_only_permuted(mesh in soups(), seed in any::<u64>()) {
        let orders = [
            RecursiveCut { seed, ..RecursiveCut::default() }.face_order(&mesh),
            LinearArrangement { seed, ..LinearArrangement::default() }.face_order(&mesh),
        ];
        for order in orders {
            prop_assert!(is_order_of(&order, &mesh));
        }
    }
}

fn largest_piece(tree: &CutTree) -> usize {
    match tree {
        CutTree::Piece(faces) => faces.len(),
        CutTree::Cut(halves, _) => halves.iter().map(largest_piece).max().unwrap(),
    }
}

#[test]
fn a_long_strip_is_drawn_from_end_to_end() {
    // Long enough for clusters, parts and threads.
    let mesh = strip(40_000);
    let order = RecursiveCut::default().face_order(&mesh);
    let misses = cache::misses(&order.apply(mesh.faces()), CacheModel::fifo(12));
    assert!(misses < 80_002 * 101 / 100, "{misses}");
    let order = LinearArrangement::default().face_order(&mesh);
    let cost = cost(&order.apply(mesh.faces()));
    assert!(cost < 80_000 * 2 * 101 / 100, "{cost}");
}

#[test]
fn corners_stay_where_they_must() {
    let mesh = strip(300);
    let orders = [
        RecursiveCut {
            keep_corners: true,
            ..RecursiveCut::default()
        }
        .face_order(&mesh),
        LinearArrangement {
            keep_corners: true,
            ..LinearArrangement::default()
        }
        .face_order(&mesh),
    ];
    for order in orders {
        assert!(order.rotations().iter().all(|&rotation| rotation == 0));
        assert!(is_order_of(&order, &mesh));
    }
}
