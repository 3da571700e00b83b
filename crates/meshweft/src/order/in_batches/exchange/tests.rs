use super::*;
use crate::permutation::Permutation;
use crate::random::{SplitMix64, shuffled};

const SHORT: Annealing = Annealing {
    sweeps: 20,
    temperatures: [20_000, 5_000],
    size: 8,
};

/// Batches of 32 faces each: strips, grids and soups, each faces of other vertices.
fn batches(case: u64, count: usize) -> Vec<[u32; 3]> {
    let mut numbers = SplitMix64(case);
    let mut faces = Vec::new();
    while faces.len() < count * SIZE {
        let base = faces.len() / 2;
        let width = 2 + numbers.below(9);
        let scatter = numbers.below(3);
        for i in 0..SIZE {
            let at = base + i / 2 % width + i / 2 / width * (width + 1);
            let face = match i % 2 {
                0 => [at, at + 1, at + width + 1],
                _ => [
                    at + 1,
                    at + width + 2 + numbers.below(1 + scatter),
                    at + width + 1,
                ],
            };
            faces.push(face.map(index32));
        }
    }
    faces
}

/// A grid of `side` × `side` squares in tiles of 8 × 2, column by column: each is a batch of 27
/// vertices.
fn grid(side: u32) -> Vec<[u32; 3]> {
    let square = |[x, y]: [u32; 2]| {
        let corner = y * (side + 1) + x;
        let above = corner + side + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let mut squares: Vec<[u32; 2]> = (0..side * side).map(|i| [i % side, i / side]).collect();
    squares.sort_by_key(|[x, y]| [y / 2, *x]);
    squares.into_iter().flat_map(square).collect()
}

/// The vertices of each part, counted from the faces.
fn vertices(faces: &[[u32; 3]], part_of: &[u16], part: u16) -> usize {
    let is_in = |&(_, &of): &(&[u32; 3], &u16)| of == part;
    let members = faces.iter().zip(part_of).filter(is_in);
    let mut vertices: Vec<u32> = members.flat_map(|(face, _)| *face).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.len()
}

/// Every move changes what a recount of its parts says, and no part takes more vertices than it may.
#[test]
fn moves_change_what_a_recount_says() {
    let mut moves = 0;
    for case in 0..60 {
        let faces = batches(case, 6);
        let vertex_count = faces
            .as_flattened()
            .iter()
            .max()
            .map_or(0, |&v| v as usize + 1);
        let mut parts = Parts::new(&faces, vertex_count, SIZE, LANES);
        let mut numbers = SplitMix64(case);
        for _ in 0..300 {
            let face = index32(numbers.below(faces.len()));
            let random = index32(numbers.below(1 << 32));
            let Some(to) = parts.neighbour(face, random) else {
                continue;
            };
            let from = parts.part(face);
            let before = [from, to].map(|part| vertices(&faces, parts.part_of(), part));
            let Some(change) = parts.change(face, to) else {
                let mut moved = parts.part_of().to_vec();
                moved[face as usize] = to;
                assert!(vertices(&faces, &moved, to) > LANES as usize);
                continue;
            };
            parts.shift(face, to);
            let after = [from, to].map(|part| vertices(&faces, parts.part_of(), part));
            assert_eq!(before[0] - after[0], usize::try_from(change.gone).unwrap());
            assert_eq!(after[1] - before[1], usize::try_from(change.new).unwrap());
            assert!(after[1] <= LANES as usize);
            moves += 1;
        }

        // And every part gets its size back.
        if balance(&mut parts) {
            for part in 0..6 {
                let size = parts.part_of().iter().filter(|&&of| of == part).count();
                assert_eq!(size, SIZE, "case {case}");
                assert!(vertices(&faces, parts.part_of(), part) <= LANES as usize);
            }
        }
    }
    assert!(moves > 1000, "{moves}");
}

/// Batches stay full, and others keep their faces.
#[test]
fn full_batches_stay_full() {
    for case in 0..300 {
        let mut faces = batches(case, 9);
        if case % 3 == 0 {
            faces[40] = [7, 7, 8];
            faces.truncate(8 * SIZE + 5);
        }
        let places = exchanged(&faces, 4000, &SHORT, case, &());
        let order = Permutation::new(places).unwrap();
        let exchanged = order.apply(&faces);
        let full = starts_of_full_batches(&faces);
        let kept = |&face: &usize| {
            !full
                .iter()
                .any(|&start| (start..start + SIZE).contains(&face))
        };
        for face in (0..faces.len()).filter(kept) {
            assert_eq!(order.new_to_old()[face], index32(face), "case {case}");
        }
        for start in full {
            let batch = &exchanged[start..start + SIZE];
            let mut vertices = batch.as_flattened().to_vec();
            vertices.sort_unstable();
            vertices.dedup();
            assert!(vertices.len() <= LANES as usize, "case {case}");
        }
    }
}

/// Between straight borders few exchanges pay at once.
#[test]
fn tiles_of_a_grid_get_fewer_vertices() {
    let faces = grid(64);
    let annealing = Annealing {
        sweeps: 300,
        ..SHORT
    };
    let order = Permutation::new(exchanged(&faces, 65 * 65, &annealing, 1, &())).unwrap();
    let vertices_of = |faces: &[[u32; 3]]| -> usize {
        let batches = faces.chunks(SIZE);
        batches.map(|batch| vertices(batch, &[0; SIZE], 0)).sum()
    };
    let [before, after] = [&faces, &order.apply(&faces)].map(|faces| vertices_of(faces));
    let batches = faces.len() / SIZE;
    assert_eq!(before, batches * 27);
    assert!(after < before, "{after} of {before}");
}

/// Windows do not know each other, and their order of work does not matter.
#[test]
fn windows_are_exchanged_one_by_one() {
    let faces = grid(64);
    let all = exchanged_in_windows(&faces, 65 * 65, &SHORT, (7, 50), &());
    for (number, window) in all.chunks(50 * SIZE).enumerate() {
        let start = index32(number * 50 * SIZE);
        assert!(
            window
                .iter()
                .all(|&face| face >= start && face < start + index32(50 * SIZE))
        );
        // As if it were alone, but for the random numbers.
        let seed = 7 ^ u64::from(start).wrapping_mul(GOLDEN_RATIO);
        let faces = &faces[start as usize..start as usize + window.len()];
        let alone = exchanged_in_windows(faces, 65 * 65, &SHORT, (seed, 50), &());
        assert!(alone.iter().zip(window).all(|(a, b)| a + start == *b));
    }
}

#[test]
fn what_has_no_full_batch_stays() {
    for count in [0, 1, 31] {
        let faces = &grid(8)[..count];
        let places = exchanged(faces, 81, &SHORT, 0, &());
        assert!(
            places
                .iter()
                .enumerate()
                .all(|(i, &place)| i == place as usize)
        );
    }
    // Faces far from each other have nothing to exchange.
    let apart: Vec<[u32; 3]> = (0..320).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let order = shuffled(320, 1);
    let faces: Vec<[u32; 3]> = order.iter().map(|&face| apart[face as usize]).collect();
    let places = exchanged(&faces, 960, &SHORT, 0, &());
    assert!(
        places
            .iter()
            .enumerate()
            .all(|(i, &place)| i == place as usize)
    );
}
