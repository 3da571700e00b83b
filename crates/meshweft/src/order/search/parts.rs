//! Large meshes in parts, on as many threads as there are.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use super::super::block_faces::{BlockEnds, BlockFaces, is_in_blocks, turned_from};
use super::border::{Border, BorderFace};
use super::mask::Mask;
use super::preset::preset;
use super::rollout::{Caller, Rollouts};
use super::settings::Settings;
use super::slabs;
use super::state::{CacheLimits, State};
use crate::cache::CacheModel;
use crate::faces::{Faces, turned};
use crate::first_use::{Compact, FirstUse};
use crate::index::{block_of, index32};
use crate::order::k_cache_reorder::KCacheReorder;
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
    /// The same with another progress, and with another one's random numbers: 0 keeps its own.
    pub(in crate::order) fn with_progress<'a>(
        &self,
        progress: &'a dyn Progress,
        other: u64,
    ) -> Search<'a> {
        Search {
            seed: self.seed.wrapping_add(other),
            progress,
            ..*self
        }
    }

    /// The order that the search finds, part by part; polygons that begin at `starts` stay whole.
    ///
    /// The same for any number of threads, unless the caller stops or hurries it.
    pub(in crate::order) fn face_order(
        &self,
        faces: Faces<'_>,
        starts: Option<&[u32]>,
    ) -> FaceOrder {
        // Cut large meshes.
        let polygons = starts.map(polygon_of_each_face);
        let cut = self.cut(faces, polygons.as_deref());

        // Each part gets its own vertex numbers, its own random numbers and its share of the steps.
        let settings = preset(self.target, self.effort);
        let caller = Caller {
            progress: self.progress,
            faces: cut.blocks.iter().map(|ends| ends.inside).sum(),
            drawn: AtomicUsize::new(0),
            is_stopped: AtomicBool::new(false),
        };
        let face_count = faces.len();
        let mut numbers = FirstUse::new(faces.vertex_count(), 3 * face_count);
        let mut start = 0;
        let parts = cut.blocks.iter().map(|ends| {
            let members = &cut.order.new_to_old()[start..ends.all];
            let corners = |&face: &u32| faces.as_slice()[face as usize];
            let mut local = |face: [u32; 3]| face.map(|vertex| numbers.number(vertex));
            let (inside, across) = members.split_at(ends.inside - start);
            let keep_corners = self.keep_corners || starts.is_some();
            let part = Part {
                faces: inside.iter().map(corners).map(&mut local).collect(),
                border: across
                    .iter()
                    .map(corners)
                    .map(|face| BorderFace::new(face, local(face), keep_corners))
                    .collect(),
                hosts_border: !across.is_empty() && self.target == CacheModel::Nvidia.into(),
                vertex_count: numbers.finish().len(),
                polygons: polygons
                    .as_ref()
                    .map_or(Vec::new(), |polygons| polygons_of(members, polygons)),
                keep_corners,
                seed: self.seed ^ (start as u64).wrapping_mul(GOLDEN_RATIO),
                settings: &settings,
                steps: self.budget.share(start..ends.all, face_count).steps(),
                caller: &caller,
            };
            start = ends.all;
            part
        });

        // Search, and put what was found in place of the parts.
        let ordered = parallel::map(parts.collect(), |part: Part<'_>| part.search());
        let left = ordered.iter().map(|part| part.border_left).sum();
        let order = FaceOrder::from(cut.order).then(&joined(ordered, face_count));
        self.with_last_in_order(faces, order, left)
    }

    /// The faces sorted by part: by block where the vertices are in blocks, otherwise, if there are
    /// many, in compact slabs.
    ///
    /// Faces across the border of two blocks stand apart for targets with caches that forget their
    /// vertices where the block changes. Batches made for such a cache alone take them. For all caches
    /// together they come last, strip by strip: at the ends of batches FIFO caches would miss them (of
    /// 16 vertices, 1 % more on the dragon), which outweighs .7 % fewer batches.
    fn cut(&self, faces: Faces<'_>, polygons: Option<&[[u32; 2]]>) -> BlockFaces {
        if is_in_blocks(faces) {
            let forgets = match self.target {
                Target::Universal => true,
                Target::Cache(model) => model == CacheModel::Nvidia,
            };
            return BlockFaces::new(faces, polygons, forgets && polygons.is_none());
        }

        let (order, ends) = match part_count(faces.len()) {
            1 => (Permutation::identity(faces.len()), vec![faces.len()]),
            parts => slabs::compact_parts(faces, parts, polygons),
        };
        let ends = ends.iter().map(|&end| BlockEnds {
            inside: end,
            all: end,
        });
        BlockFaces {
            order,
            blocks: ends.collect(),
        }
    }

    /// The order with its last `count` faces, which are across borders and which no batch took, in a
    /// greedy order of their own.
    fn with_last_in_order(&self, faces: Faces<'_>, order: FaceOrder, count: usize) -> FaceOrder {
        if count == 0 {
            return order;
        }
        let start = order.len() - count;
        let last = order.new_to_old()[start..].iter();
        let last: Vec<[u32; 3]> = last.map(|&face| faces.as_slice()[face as usize]).collect();
        let compact = Compact::new(Faces::of_checked(&last, faces.vertex_count()));
        let greedy = KCacheReorder::default().face_order(compact.faces());

        // A face starts in the block that the one before it ends in.
        let mut block = None;
        let turn = |&face: &u32| {
            let rotation = match self.keep_corners {
                true => 0,
                false => turned_from(last[face as usize], block),
            };
            let [.., end] = turned(last[face as usize], rotation);
            block = Some(block_of(end));
            rotation
        };
        let rotations: Vec<u8> = greedy.new_to_old().iter().map(turn).collect();

        let moved = greedy.new_to_old().iter();
        let moved = moved.map(|&face| index32(start) + face);
        let permutation = (0..index32(start)).chain(moved).collect();
        let rotations = std::iter::repeat_n(0, start).chain(rotations).collect();
        let last = FaceOrder::new(Permutation::from_algorithm(permutation), rotations);
        order.then(&last.expect("one rotation below 3 a face"))
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
/// part planned them. The few faces left over from all parts come last, and after them those across
/// borders that no batch took.
fn joined(parts: Vec<Found>, face_count: usize) -> FaceOrder {
    let mut new_to_old = Vec::with_capacity(face_count);
    let mut rotations = Vec::with_capacity(face_count);
    let (mut left_over, mut border_left) = (Vec::new(), Vec::new());
    let mut start = 0;

    for part in parts {
        // Faces are numbered from 0 in each part.
        let in_batches = part.order.len() - part.border_left;
        let in_full_batches = in_batches - part.left_over;
        for (i, &face) in part.order.new_to_old().iter().enumerate() {
            let (face, rotation) = (face + start, part.order.rotation(i));
            if i < in_full_batches {
                new_to_old.push(face);
                rotations.push(rotation);
            } else if i < in_batches {
                left_over.push((face, rotation));
            } else {
                border_left.push((face, rotation));
            }
        }
        start += index32(part.order.len());
    }

    for (face, rotation) in left_over.into_iter().chain(border_left) {
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
    /// Faces across the border of the part's block, numbered after the others.
    border: Vec<BorderFace>,
    /// Whether its batches take them.
    hosts_border: bool,
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
    /// How many come after these because no batch took them across a border.
    border_left: usize,
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

        let border = Border::new(&self.border, &self.faces, self.vertex_count);
        if self.hosts_border {
            state.anchored = border.waiting_by_vertex();
        }

        let state = Rollouts::new(state, self.settings, self.seed).run(self.steps, self.caller);

        // With polygons a batch may end within one, which must not be torn.
        let left_over = match self.polygons.is_empty() {
            true => state.faces_in_batch(),
            false => 0,
        };

        let hosts = state.hosts;
        let order = Permutation::from_algorithm(state.new_to_old);
        let order = FaceOrder::new(order, state.rotations).expect("one rotation below 3 a face");
        let (order, border_left) = match self.border.is_empty() {
            true => (order, 0),
            false => border.woven(&self.faces, &order, &hosts),
        };
        Found {
            order,
            left_over,
            border_left,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache;

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
                    border: Vec::new(),
                    hosts_border: false,
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
