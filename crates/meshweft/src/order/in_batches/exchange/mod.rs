//! Faces exchanged between the batches of an order, so that these have fewer vertices.
//!
//! A batch begins empty, so its invocations are its vertices, and which batch comes first does not matter:
//! to draw with few invocations is to cut the faces in parts of 32 with few vertices each. A search that
//! draws face by face fills each batch well and leaves scraps between them. Here all batches change
//! together: faces move from part to part at random (`annealing`), then every part gets its size
//! back (`balance`). Read `exchanged` first.

mod annealing;
mod balance;
mod parts;
#[cfg(test)]
mod tests;

pub(in crate::order) use annealing::Annealing;

use crate::cache::nvidia::{BATCH_FACES, Batcher, LANES};
use crate::first_use::FirstUse;
use crate::index::{block_of, index32};
use crate::parallel;
use crate::progress::Progress;
use balance::balance;
use parts::Parts;

/// Faces of a batch.
const SIZE: usize = BATCH_FACES as usize;

/// The batches that exchange faces with each other: as many as there are in a part of a search.
const WINDOW: usize = 1 << 12;

/// 2⁶⁴ over the golden ratio: its multiples, as seeds, have little in common.
const GOLDEN_RATIO: u64 = 0x9e37_79b9_7f4a_7c15;

/// New places for faces that are `ordered` (`out[i] = ordered[places[i]]`), so that full batches have fewer
/// vertices; the batches stay where they are. The same for any number of threads, unless the caller
/// stops it or its time is over.
///
/// A batch keeps its faces if it is not full, or has a degenerate one or one across a border between
/// blocks of 65,536 vertices.
///
/// Time O(sweeps · faces), space 60 bytes a face.
pub(in crate::order) fn exchanged(
    ordered: &[[u32; 3]],
    vertex_count: usize,
    annealing: &Annealing,
    seed: u64,
    progress: &dyn Progress,
) -> Vec<u32> {
    exchanged_in_windows(ordered, vertex_count, annealing, (seed, WINDOW), progress)
}

/// As [`exchanged`], with windows of so many batches.
fn exchanged_in_windows(
    ordered: &[[u32; 3]],
    vertex_count: usize,
    annealing: &Annealing,
    (seed, window): (u64, usize),
    progress: &dyn Progress,
) -> Vec<u32> {
    // Windows of full batches, each with its own vertex numbers.
    let starts = starts_of_full_batches(ordered);
    let mut numbers = FirstUse::new(vertex_count, 3 * ordered.len());
    let windows = starts.chunks(window).map(|starts| {
        let batches = starts.iter().map(|&start| &ordered[start..start + SIZE]);
        let mut local = |face: &[u32; 3]| face.map(|vertex| numbers.number(vertex));
        let faces: Vec<[u32; 3]> = batches.flatten().map(&mut local).collect();
        let seed = seed ^ (starts[0] as u64).wrapping_mul(GOLDEN_RATIO);
        (starts, faces, numbers.finish().len(), seed)
    });
    let found = parallel::map(windows.collect(), |(starts, faces, vertex_count, seed)| {
        let mut parts = Parts::new(&faces, vertex_count, SIZE, LANES);
        annealing.run(&mut parts, seed, progress);
        let is_balanced = balance(&mut parts);
        (starts, is_balanced.then(|| parts.part_of().to_vec()))
    });

    // The faces of each part in its batch's place, in their old order.
    let mut places: Vec<u32> = (0..index32(ordered.len())).collect();
    for (starts, part_of) in found {
        let mut next = starts.to_vec();
        for (face, part) in part_of.into_iter().flatten().enumerate() {
            let next = &mut next[usize::from(part)];
            places[*next] = index32(starts[face / SIZE] + face % SIZE);
            *next += 1;
        }
    }
    places
}

/// Where the batches begin that have 32 faces, all in one block and none degenerate.
fn starts_of_full_batches(ordered: &[[u32; 3]]) -> Vec<usize> {
    let mut card = Batcher::new();
    let mut starts = Vec::new();
    let mut plain = 0;
    let mut block = 0;
    for (number, &face) in ordered.iter().enumerate() {
        card.draw(&face, 0);
        if card.primitives() == 1 {
            plain = 0;
            block = block_of(face[0]);
        }
        let [a, b, c] = face;
        let is_plain = a != b && b != c && c != a && face.map(block_of) == [block; 3];
        plain += usize::from(is_plain);
        if plain == SIZE {
            starts.push(number + 1 - SIZE);
        }
    }
    starts
}
