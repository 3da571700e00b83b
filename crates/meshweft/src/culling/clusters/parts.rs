//! Compact parts of a mesh, merged side by side.

use super::face_cluster::{FaceCluster, gathered};
use super::masks::Mask;
use super::merge::{Merging, Price};
use super::moves;
use super::seen::Seen;
use crate::faces::Faces;
use crate::first_use::FirstUse;
use crate::geometry::double::{add, widened};
use crate::index::index32;
use crate::parallel;

/// How many faces a part has, at most.
const PART: usize = 1 << 15;

/// Faces in clusters; with the price of a `card`, most of them of whole batches.
///
/// First those of each part that touch no other part are merged, then all that is left: the result depends on the parts, and
/// not on the number of threads.
pub(super) fn clusters<const WORDS: usize>(
    seen: &Seen<'_, WORDS>,
    price: Price,
    card: Option<Price>,
) -> Vec<FaceCluster<WORDS>> {
    // From here on a face is its place among those.
    let (mesh, some, masks) = (seen.mesh, seen.faces, seen.masks);
    let faces = seen.corners();
    let faces = Faces::of_checked(&faces, mesh.vertex_count());
    let parts = parts(faces.as_slice(), mesh.positions());
    let mut first_of: Vec<u32> = (0..index32(faces.len())).collect();
    if parts.len() > 1 {
        let is_between = between(faces, &parts);
        let merged = parallel::map(parts, |part: Vec<u32>| {
            let mut numbers = FirstUse::new(faces.vertex_count(), 3 * part.len());
            let corners = part.iter().map(|&face| faces.as_slice()[face as usize]);
            let corners: Vec<[u32; 3]> = corners
                .map(|face| face.map(|vertex| numbers.number(vertex)))
                .collect();
            let used = numbers.finish();
            let masks: Vec<Mask<WORDS>> = part.iter().map(|&face| masks[face as usize]).collect();
            let apart: Vec<u32> = (0..index32(part.len())).collect();
            let is_fixed = |vertex: u32| is_between[used[vertex as usize] as usize];
            let faces = Faces::of_checked(&corners, used.len());
            let first_of = Merging::new(faces, &masks, apart, price, is_fixed).run();
            (part, first_of)
        });
        for (part, first_in_part) in merged {
            for (&face, &first) in part.iter().zip(&first_in_part) {
                first_of[face as usize] = part[first as usize];
            }
        }
    }
    let mut first_of = Merging::new(faces, masks, first_of, price, |_| false).run();
    moves::improve(faces, masks, &mut first_of, price);

    if let Some(price) = card {
        moves::fill_batches(faces, masks, &mut first_of, price);
    }
    let runs = some.iter().map(std::slice::from_ref);
    gathered(seen, runs.zip(first_of))
}

/// Faces, by where they are, cut in halves across the longest side until each part is small.
fn parts(faces: &[[u32; 3]], positions: &[[f32; 3]]) -> Vec<Vec<u32>> {
    let middle_of = |face: &[u32; 3]| {
        let corners = face.map(|vertex| widened(positions[vertex as usize]));
        add(add(corners[0], corners[1]), corners[2])
    };
    let middles: Vec<[f64; 3]> = faces.iter().map(middle_of).collect();
    let mut done = Vec::new();
    let mut left: Vec<Vec<u32>> = vec![(0..index32(faces.len())).collect()];
    while let Some(mut part) = left.pop() {
        if part.len() <= PART {
            part.sort_unstable();
            done.push(part);
            continue;
        }
        let span = |axis: usize| {
            let along = part.iter().map(|&face| middles[face as usize][axis]);
            let along = along.filter(|x| x.is_finite());
            let ends = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            ends.1 - ends.0
        };
        let spans = [0, 1, 2].map(span);
        let axis = (0..3)
            .max_by(|&a, &b| spans[a].total_cmp(&spans[b]))
            .unwrap_or(0);
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&a, &b| {
            let along = |face: u32| middles[face as usize][axis];
            along(a).total_cmp(&along(b)).then(a.cmp(&b))
        });
        let rest = part.split_off(half);
        left.extend([rest, part]);
    }
    done
}

/// Whether each vertex is in faces of several parts.
fn between(faces: Faces<'_>, parts: &[Vec<u32>]) -> Vec<bool> {
    const NONE: u32 = u32::MAX;
    let mut part_of = vec![NONE; faces.vertex_count()];
    let mut is_between = vec![false; faces.vertex_count()];
    for (part, members) in (0..).zip(parts) {
        for &face in members {
            for vertex in faces.as_slice()[face as usize] {
                let known = &mut part_of[vertex as usize];
                is_between[vertex as usize] |= *known != NONE && *known != part;
                *known = part;
            }
        }
    }
    is_between
}
