//! Against brute force at every level, and the laws of every update.

use proptest::prelude::*;

use super::oracle::{self, Levels};
use super::*;
use crate::order::baselines;
use crate::permutation::{FaceOrder, Permutation};
use crate::progressive::history::{History, HistoryBuilder, NewRecord};
use crate::progressive::made;
use crate::random::SplitMix64;

/// Any history: collapses of a grid or a sphere, or records that no simplifier makes of these and of
/// random faces.
fn histories() -> impl Strategy<Value = History> {
    let surface = prop_oneof![
        (1_u32..9, 1_u32..9).prop_map(|(columns, rows)| made::grid(columns, rows)),
        (0_u32..3).prop_map(made::sphere),
    ];
    let faces = (1_u32..30).prop_flat_map(|n| prop::collection::vec([0..n, 0..n, 0..n], 0..60));
    let any_faces = prop_oneof![surface.clone(), faces];
    let any_records = (any_faces, 0_u32..4, 0_usize..30, any::<u64>());
    prop_oneof![
        (surface, any::<u64>()).prop_map(|(faces, seed)| made::collapses(&faces, seed)),
        any_records.prop_map(|(faces, unused, count, seed)| {
            let used = faces.as_flattened().iter().max().map_or(0, |last| last + 1);
            made::any_records(&faces, used + unused, count, seed)
        }),
    ]
}

fn random_order(history: &History, seed: u64) -> FaceOrder {
    let count = history.full_faces().len();
    let turns = baselines::random(count, seed ^ 1);
    let turns = turns.new_to_old().iter().map(|turn| (turn % 3) as u8);
    FaceOrder::new(Permutation::random(count, seed), turns.collect()).unwrap()
}

/// Walks up and down and compares each level that it comes to.
macro_rules! check_walk {
    ($update:ident, $history:expr, $order:expr, $levels:expr, $seed:expr) => {{
        let (history, order, levels): (&History, &FaceOrder, Levels) = ($history, $order, $levels);
        let mut random = SplitMix64($seed);
        let mut sequence = $update::new(history, order).unwrap();
        let (mut numbers, mut faces) = (Vec::new(), Vec::new());
        for step in 0..40 {
            let level = match step {
                // Each level once on the way down, then any.
                _ if step < history.len().min(20) => step,
                39 => 0,
                _ => random.below(history.len() + 1),
            };
            match random.below(4) {
                0 if sequence.level() < history.len() => assert!(sequence.coarsen()),
                1 if sequence.level() > 0 => assert!(sequence.refine()),
                _ => sequence.go_to(level),
            }
            if step == 39 {
                sequence.go_to(0);
                sequence.emit_faces(&mut faces);
                assert_eq!(faces, order.apply(history.full_faces().as_slice()));
            }
            sequence.emit(&mut numbers);
            assert_eq!(numbers, levels[sequence.level()]);

            numbers.sort_unstable();
            assert_eq!(numbers, history.faces_at(sequence.level()));
            assert_eq!(numbers.len(), history.face_count(sequence.level()));
        }
        assert!(!sequence.refine());
        sequence.go_to(history.len());
        assert!(!sequence.coarsen());
    }};
}

proptest! {
    #[test]
    fn each_level_is_as_the_papers_say(
        history in histories(), order in any::<u64>(), walk in any::<u64>()
    ) {
        let order = &random_order(&history, order);
        let history = &history;
        check_walk!(SimpleUpdate, history, order, oracle::simple(history, order), walk);
        check_walk!(SmartUpdate, history, order, oracle::smart(history, order), walk);
        check_walk!(AdaptiveUpdate, history, order, oracle::adaptive(history, order), walk);
    }
}

/// A fan of eight faces around vertex 8, which is then filled otherwise.
fn fan(inserted: &[[u32; 3]]) -> History {
    let faces: Vec<[u32; 3]> = (0..8).map(|i| [i, (i + 1) % 8, 8]).collect();
    let mut builder = HistoryBuilder::new(&faces);
    let record = NewRecord {
        removed_vertices: &[8],
        removed_faces: &[0, 1, 2, 3, 4, 5, 6, 7],
        inserted_faces: inserted,
        ..NewRecord::default()
    };
    builder.push(&record).unwrap();
    builder.finish()
}

#[test]
fn a_shared_edge_comes_before_a_shared_vertex() {
    // 8: [0, 2, 4] and 9: [4, 6, 0] share one vertex with two faces each, the ears an edge.
    let ears = [[0, 1, 2], [2, 3, 4], [4, 5, 6], [6, 7, 0]];
    let history = fan(&[&[[0, 2, 4], [4, 6, 0]][..], &ears[..]].concat());
    let mut sequence = SmartUpdate::new(&history, &FaceOrder::identity(8)).unwrap();
    sequence.coarsen();
    let mut numbers = Vec::new();
    sequence.emit(&mut numbers);
    // Ears take the places of faces 0, 2, 4 and 6; then 8 and 9 those of faces 1 and 3.
    assert_eq!(numbers, [10, 8, 11, 9, 12, 13]);
}

#[test]
fn faces_that_no_place_is_left_for_go_behind_the_last() {
    let more: Vec<[u32; 3]> = (0..10).map(|i| [i % 8, (i + 1) % 8, (i + 3) % 8]).collect();
    let history = fan(&more);
    let mut numbers = Vec::new();
    let mut sequence = SimpleUpdate::new(&history, &FaceOrder::identity(8)).unwrap();
    sequence.coarsen();
    sequence.emit(&mut numbers);
    assert_eq!(numbers, (8..18).collect::<Vec<_>>());
    let mut sequence = SmartUpdate::new(&history, &FaceOrder::identity(8)).unwrap();
    sequence.coarsen();
    sequence.emit(&mut numbers);
    assert_eq!(numbers[8..], [16, 17]);
}

#[test]
fn a_record_with_too_many_pairs_is_filled_from_the_front() {
    let rim = 3000;
    let faces: Vec<[u32; 3]> = (0..rim).map(|i| [i, (i + 1) % rim, rim]).collect();
    let removed: Vec<u32> = (0..rim).collect();
    let inserted: Vec<[u32; 3]> = (1..rim - 1).rev().map(|i| [0, i, i + 1]).collect();
    let mut builder = HistoryBuilder::new(&faces);
    let record = NewRecord {
        removed_vertices: &[rim],
        removed_faces: &removed,
        inserted_faces: &inserted,
        ..NewRecord::default()
    };
    builder.push(&record).unwrap();
    let history = builder.finish();
    let order = FaceOrder::identity(faces.len());
    let mut sequence = SmartUpdate::new(&history, &order).unwrap();
    sequence.coarsen();
    let mut numbers = Vec::new();
    sequence.emit(&mut numbers);
    assert_eq!(numbers, (rim..2 * rim - 2).collect::<Vec<_>>());
}

#[test]
fn an_order_of_another_length_is_refused() {
    let history = fan(&[]);
    let short = FaceOrder::identity(7);
    let error = AdaptiveUpdate::new(&history, &short).unwrap_err();
    assert_eq!(
        error.to_string(),
        "face order of the full mesh: expected 8 entries, found 7"
    );
    assert!(SimpleUpdate::new(&history, &short).is_err());
    assert!(SmartUpdate::new(&history, &short).is_err());
}
