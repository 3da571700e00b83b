//! Large meshes in parts, on as many threads as there are.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use super::mask::Mask;
use super::preset::preset;
use super::rollout::{Caller, Rollouts};
use super::settings::Settings;
use super::slabs;
use super::state::{CacheLimits, State};
use crate::faces::Faces;
use crate::first_use::FirstUse;
use crate::index::index32;
use crate::order::polygons::polygon_of_each_face;
use crate::order::target::{Effort, Target};
use crate::parallel;
use crate::permutation::{FaceOrder, Permutation};
use crate::progress::{Budget, Progress};

/// The fewest faces in a part. A part starts with a cold
/// cache and transforms the vertices at its border once more than the whole mesh would: at this size
/// that costs less than a hundredth.
const PART: usize = 1 << 17;

/// 2⁶⁴ over the golden ratio: its multiples, as seeds, have little in common.
const GOLDEN_RATIO: u64 = 0x9e37_79b9_7f4a_7c15;

/// A search for an order, and the caller to report to.
pub(in crate::order) struct Search<'a> {
    pub(in crate::order) target: Target,
    pub(in crate::order) effort: Effort,
    pub(in crate::order) seed: u64,
    pub(in crate::order) keep_corners: bool,
    pub(in crate::order) budget: Budget,
    pub(in crate::order) progress: &'a dyn Progress,
}

impl Search<'_> {
    /// The order that the search finds, part by part; polygons that begin at `starts` stay whole.
    ///
    /// The same for any number of threads, unless the caller stops or hurries it.
    pub(in crate::order) fn face_order(
        &self,
        faces: Faces<'_>,
        starts: Option<&[u32]>,
    ) -> FaceOrder {
        // Cut large meshes.
        let face_count = faces.len();
        let polygons = starts.map(polygon_of_each_face);
        let (order, ends) = match part_count(face_count) {
            1 => (Permutation::identity(face_count), vec![face_count]),
            parts => slabs::compact_parts(faces, parts, polygons.as_deref()),
        };

        // Each part gets its own vertex numbers, its own random numbers and its share of the steps.
        let settings = preset(self.target, self.effort);
        let caller = Caller {
            progress: self.progress,
            faces: face_count,
            drawn: AtomicUsize::new(0),
            is_stopped: AtomicBool::new(false),
        };
        let mut numbers = FirstUse::new(faces.vertex_count(), 3 * face_count);
        let mut start = 0;
        let parts = ends.iter().map(|&end| {
            let members = &order.new_to_old()[start..end];
            let corners = members.iter().map(|&face| faces.as_slice()[face as usize]);
            let corners = corners.map(|face| face.map(|vertex| numbers.number(vertex)));
            let part = Part {
                faces: corners.collect(),
                vertex_count: numbers.finish().len(),
                polygons: polygons
                    .as_ref()
                    .map_or(Vec::new(), |polygons| polygons_of(members, polygons)),
                keep_corners: self.keep_corners || starts.is_some(),
                seed: self.seed ^ (start as u64).wrapping_mul(GOLDEN_RATIO),
                settings: &settings,
                steps: self.budget.share(start..end, face_count).steps(),
                caller: &caller,
            };
            start = end;
            part
        });

        // Search, and put what was found in place of the parts.
        let ordered = parallel::map(parts.collect(), |part: Part<'_>| part.search());
        FaceOrder::from(order).then(&joined(ordered, face_count))
    }
}

/// The number of parts: a power of two, to divide evenly among threads.
fn part_count(faces: usize) -> usize {
    match faces / PART {
        0 | 1 => 1,
        most => 1 << most.ilog2(),
    }
}

/// The parts one after the other.
///
/// Each part ends with its last full batch, so that the batches of the next part start where that
/// part planned them. The few faces left over from all parts come last.
fn joined(parts: Vec<Found>, face_count: usize) -> FaceOrder {
    let mut new_to_old = Vec::with_capacity(face_count);
    let mut rotations = Vec::with_capacity(face_count);
    let mut left_over = Vec::new();
    let mut start = 0;

    for part in parts {
        // Faces are numbered from 0 in each part.
        let in_full_batches = part.order.len() - part.left_over;
        for (i, &face) in part.order.new_to_old().iter().enumerate() {
            let (face, rotation) = (face + start, part.order.rotation(i));
            if i < in_full_batches {
                new_to_old.push(face);
                rotations.push(rotation);
            } else {
                left_over.push((face, rotation));
            }
        }
        start += index32(part.order.len());
    }

    for (face, rotation) in left_over {
        new_to_old.push(face);
        rotations.push(rotation);
    }

    let permutation = Permutation::from_algorithm(new_to_old);
    FaceOrder::new(permutation, rotations).expect("one rotation below 3 a face")
}

/// Where the polygon of each member begins and ends among the members, which hold whole polygons.
///
/// Callers hand over polygons as `starts`. Here each face has the range of its polygon instead:
/// that form can be picked face by face.
fn polygons_of(members: &[u32], polygons: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let place = |(i, &face): (u32, &u32)| {
        let [start, end] = polygons[face as usize];
        [i + start - face, i + end - face]
    };
    (0..).zip(members).map(place).collect()
}

/// Faces that are ordered independently of the others.
struct Part<'a> {
    faces: Vec<[u32; 3]>,
    vertex_count: usize,
    /// Where the polygon of each face begins and ends; empty if there are no polygons.
    polygons: Vec<[u32; 2]>,
    keep_corners: bool,
    seed: u64,
    settings: &'a Settings,
    /// How many rounds may look ahead.
    steps: u64,
    caller: &'a Caller<'a>,
}

/// The order of a part.
struct Found {
    order: FaceOrder,
    /// How many faces are last in the order because their batch is not full.
    left_over: usize,
}

impl Part<'_> {
    /// Chooses the traversal for the modelled caches and the length of the window.
    fn search(&self) -> Found {
        let (first, second) = (self.settings.first, self.settings.second);
        let is_short = self.settings.window <= u64::SPAN;
        match (second, is_short) {
            (None, true) => self.run::<u64, 1>([first]),
            (None, false) => self.run::<u128, 1>([first]),
            (Some(second), true) => self.run::<u64, 2>([first, second]),
            (Some(second), false) => self.run::<u128, 2>([first, second]),
        }
    }

    /// Draws the whole part.
    fn run<M: Mask, const CACHES: usize>(&self, limits: [CacheLimits; CACHES]) -> Found {
        let faces = Faces::of_checked(&self.faces, self.vertex_count);
        let mut state = State::<M, CACHES>::new(faces, limits);
        state.window = self.settings.window;
        state.windows = self.settings.windows;
        state.keep_corners = self.keep_corners;
        state.polygons = &self.polygons;

        let state = Rollouts::new(state, self.settings, self.seed).run(self.steps, self.caller);

        // With polygons a batch may end within one, which must not be torn.
        let left_over = match self.polygons.is_empty() {
            true => state.faces_in_batch(),
            false => 0,
        };

        let order = Permutation::from_algorithm(state.new_to_old);
        Found {
            order: FaceOrder::new(order, state.rotations).expect("one rotation below 3 a face"),
            left_over,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache::{self, CacheModel};
    use crate::first_use::Compact;

    /// A square grid of `side` × `side` squares, row by row.
    fn grid(side: u32) -> Vec<[u32; 3]> {
        let square = |i: u32| {
            let corner = i / side * (side + 1) + i % side;
            let above = corner + side + 1;
            [[corner, corner + 1, above], [corner + 1, above + 1, above]]
        };
        (0..side * side).flat_map(square).collect()
    }

    #[test]
    fn batches_stay_aligned_across_parts() {
        for model in [CacheModel::Nvidia, CacheModel::AMD] {
            let settings = preset(Target::Cache(model), Effort::Fast);
            let caller = Caller {
                progress: &(),
                faces: 0,
                drawn: AtomicUsize::new(0),
                is_stopped: AtomicBool::new(false),
            };
            let (mut parts, mut faces, mut separately) = (Vec::new(), Vec::new(), 0);

            // Three grids of their own vertices: the misses of the full batches of each alone.
            for side in [9, 14, 23] {
                let part = Part {
                    faces: grid(side),
                    vertex_count: ((side + 1) * (side + 1)) as usize,
                    polygons: Vec::new(),
                    keep_corners: false,
                    seed: 0,
                    settings: &settings,
                    steps: u64::MAX,
                    caller: &caller,
                };
                let found = part.search();
                let kept = found.order.len() - found.left_over;
                let alone = found.order.apply(&grid(side));
                separately += cache::misses(&alone[..kept], model);

                let before = index32(faces.len());
                let moved = |face: [u32; 3]| face.map(|v| v + 1000 * before);
                faces.extend(grid(side).into_iter().map(moved));
                parts.push(found);
            }
            let left_over: usize = parts.iter().map(|part| part.left_over).sum();
            assert!(left_over > 0, "{model}: nothing to keep aligned");

            // Joined, the full batches miss as often.
            let order = joined(parts, faces.len());
            let kept = faces.len() - left_over;
            assert_eq!(
                cache::misses(&order.apply(&faces)[..kept], model),
                separately
            );
        }
    }

    #[test]
    fn parts_are_compact_and_complete() {
        let faces = grid(120);
        let shuffled = crate::order::baselines::random(faces.len(), 1).apply(&faces);
        let (order, ends) =
            slabs::compact_parts(Faces::new(&shuffled, 121 * 121).unwrap(), 7, None);
        assert_eq!(ends.len(), 7);
        let mut start = 0;
        for &end in &ends {
            assert!(end - start >= 4000);
            let part = &order.apply(&shuffled)[start..end];
            let part = Compact::new(Faces::new(part, 121 * 121).unwrap());
            let vertices = part.faces().vertex_count();
            // A compact piece of n faces has about n / 2 vertices and a short border.
            assert!(
                vertices * 2 < (end - start) * 11 / 10,
                "{vertices} of {}",
                end - start
            );
            start = end;
        }
        assert_eq!(start, faces.len());
    }
}
