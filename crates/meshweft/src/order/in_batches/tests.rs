use super::*;
use crate::cache::{self, CacheModel};
use crate::order::polygons::polygon_of_each_face;
use crate::random::SplitMix64;

/// A mesh of soups, strips and grids, with degenerate faces and vertices in other blocks.
fn soup(case: u32) -> Vec<[u32; 3]> {
    let mut numbers = SplitMix64(case.into());
    let count = 1 + numbers.below(300);
    let span = 3 + numbers.below(90);
    let base = [0, 65_520, 200_000][numbers.below(3)];
    let scatter = [1, 1, 6, 40][numbers.below(4)];
    let mut faces = Vec::new();
    for i in 0..count {
        let near = i / 2 % span + base;
        let corner = |numbers: &mut SplitMix64| index32(near + numbers.below(2 + scatter));
        let [a, b] = [0; 2].map(|_| corner(&mut numbers));
        faces.push(match scatter {
            1 => [index32(near), index32(near + 1), index32(near + 12 + i % 3)],
            _ => [a, b, corner(&mut numbers)],
        });
    }
    faces
}

fn settings(case: u32) -> InBatches {
    let reach = [32, 32, 2, 5][case as usize % 4];
    InBatches {
        starts: [1, 8, 32][case as usize % 3],
        reach,
        beside: if reach < 32 { 64 } else { 0 },
    }
}

/// What the cards' own rules count, before and after: never more invocations, and no face lost.
#[test]
fn never_adds_an_invocation() {
    let (mut fewer, mut cycles) = (0, [0, 0]);
    for case in 0..10_000 {
        let faces = soup(case);
        let identity = FaceOrder::identity(faces.len());
        let order = settings(case).follow(&faces, &identity);
        let [before, after] = [&faces, &order.apply(&faces)].map(nvidia::counts);
        assert!(after.invocations <= before.invocations, "case {case}");
        assert_eq!(order.rotations(), identity.rotations());
        fewer += usize::from(after.invocations < before.invocations);
        cycles[0] += before.setup_cycles;
        cycles[1] += after.setup_cycles;
    }
    assert!(fewer > 100 && cycles[1] < cycles[0], "{fewer} {cycles:?}");
}

/// Within the batches that the card cut before, if nothing fell out of their window.
#[test]
fn batches_keep_their_faces() {
    let mut compared = 0;
    for case in 0..4000 {
        let faces = soup(case);
        let starts_of_batches = |faces: &[[u32; 3]]| {
            let mut card = Batcher::new();
            let mut starts = Vec::new();
            for (number, face) in faces.iter().enumerate() {
                if card.primitives() == 0 || !card.fits(*face) {
                    starts.push(number);
                }
                card.draw(face, 0);
            }
            (starts, card.invocations())
        };
        let (before, invocations) = starts_of_batches(&faces);
        let distinct = nvidia::counts(&faces).distinct_vertices;
        let is_plain = |[a, b, c]: &[u32; 3]| {
            a != b && b != c && c != a && a >> 16 == b >> 16 && b >> 16 == c >> 16
        };
        if distinct != invocations || !faces.iter().all(is_plain) {
            continue;
        }
        compared += 1;
        let order = settings(case).follow(&faces, &FaceOrder::identity(faces.len()));
        assert_eq!(
            starts_of_batches(&order.apply(&faces)).0,
            before,
            "case {case}"
        );
        for (i, &start) in before.iter().enumerate() {
            let end = before.get(i + 1).copied().unwrap_or(faces.len());
            let mut members = order.new_to_old()[start..end].to_vec();
            members.sort_unstable();
            assert!((start..end).map(index32).eq(members), "case {case}");
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Small batches against every order of their faces.
#[test]
fn small_batches_come_near_the_best_of_all_orders() {
    fn least(faces: &mut [[u32; 3]], from: usize) -> u64 {
        if from == faces.len() {
            return nvidia::counts(&*faces).setup_cycles;
        }
        let cycles = (from..faces.len()).map(|other| {
            faces.swap(from, other);
            let cycles = least(faces, from + 1);
            faces.swap(from, other);
            cycles
        });
        cycles.min().unwrap_or(u64::MAX)
    }
    let (mut best, mut found) = (0, 0);
    for case in 0..60 {
        // Seven faces of a fan of strips, as they come.
        let mut numbers = SplitMix64(case);
        let mut faces: Vec<[u32; 3]> = (0..7)
            .map(|_| {
                let [x, y] = [0; 2].map(|_| index32(numbers.below(4)));
                [x * 5 + y, x * 5 + y + 1, x * 5 + y + 5]
            })
            .collect();
        let order = InBatches::default().follow(&faces, &FaceOrder::identity(faces.len()));
        found += nvidia::counts(&order.apply(&faces)).setup_cycles;
        best += least(&mut faces, 0);
    }
    assert!(
        found >= best && found * 100 <= best * 102,
        "{found} for {best}"
    );
}

#[test]
fn polygons_stay_whole() {
    for case in 0..300 {
        let faces = soup(case);
        let mut starts: Vec<u32> = (0..index32(faces.len()))
            .filter(|i| i % 5 != 1 && i % 7 != 3)
            .collect();
        starts.push(index32(faces.len()));
        let polygons = polygon_of_each_face(&starts);
        let order = settings(case).follow_whole(
            Faces::from(&faces),
            &FaceOrder::identity(faces.len()),
            Some(&polygons),
        );
        let mut at = 0;
        while at < faces.len() {
            let [start, end] = polygons[order.new_to_old()[at] as usize];
            for face in start..end {
                assert_eq!(order.new_to_old()[at], face, "case {case}");
                at += 1;
            }
        }
    }
}

#[test]
fn degenerate_faces_and_faces_across_blocks_stay() {
    let faces = [
        [0, 1, 2],
        [3, 3, 4],
        [1, 2, 3],
        [65_535, 65_536, 1],
        [4, 5, 6],
    ];
    for starts in [1, 32] {
        let pass = InBatches {
            starts,
            ..InBatches::ALONE
        };
        assert!(pass.follow(&faces, &FaceOrder::identity(5)).is_identity());
    }
    assert!(
        InBatches::ALONE
            .follow(&[], &FaceOrder::identity(0))
            .is_identity()
    );
}

#[test]
fn a_fifo_cache_beside_is_looked_after() {
    // A strip: nothing is gained by leaving its order.
    let strip: Vec<[u32; 3]> = (0..400).map(|i| [i, i + 1, i + 2]).collect();
    let order = InBatches::BESIDE_OTHERS.follow(&strip, &FaceOrder::identity(400));
    let misses = |faces: &[[u32; 3]]| cache::misses(faces, CacheModel::fifo(BESIDE_SIZE));
    assert_eq!(misses(&order.apply(&strip)), misses(&strip));
}

/// What the pass counts by itself is what the card counts.
#[test]
fn invocations_are_known_without_drawing_full_batches() {
    for case in 0..2000 {
        let faces = soup(case);
        let mut pass = Pass::<false>::new(InBatches::ALONE, &faces, None);
        pass.run(true);
        let order = Permutation::new(pass.new_to_old.clone()).unwrap();
        let counted = nvidia::counts(&order.apply(&faces)).invocations;
        assert_eq!(pass.invocations(), counted, "case {case}");
    }
}
