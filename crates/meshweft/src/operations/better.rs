//! Orders that are worth writing, and why a run on its own output finds none.
//!
//! An order is worth it if it lowers the misses of the target's caches, added up, by a two-hundredth.
//! What a greedy or a search finds depends a little on the order that it starts from, so ordering its
//! result once more may miss less by more than that: by chance in small meshes, where a few misses
//! are much, and where a shuffled input gave each vertex its faces in a poor order. So an order is
//! *checked*: its result is ordered once more, as a run on the output would do, and if that is worth
//! it too it is taken, and checked. What depends on the start falls with the number of faces: of 99
//! public meshes, as they are and shuffled, a search of one of 68,548 faces was the largest that found
//! so much again. So searches of more than [`MOST_CHECKED`](super::algorithm::MOST_CHECKED) faces,
//! which take longest, are not checked.
//!
//! A universal order is nowhere above the floor ([`is_above_floor`]). One that a check finds is nowhere above the floor of
//! what is checked, which is another one, so it may be above that of the faces as they were: then these are
//! ordered with other random numbers.
//!
//! A run on the output must see what the check saw: vertices come in the order of their first use,
//! whatever their numbers in the file, and each run of a mesh is judged on its own.

use super::algorithm::Algorithm;
use super::counts::VERTEX_SIZE;
use super::shared_progress::SharedProgress;
use crate::cache;
use crate::faces::Faces;
use crate::first_use::Compact;
use crate::order::{Target, is_above_floor, vertex_bands, vertex_fetch};
use crate::permutation::{FaceOrder, VertexOrder, renumber};

/// A gain below one in so many counts as none.
const SMALLEST_GAIN: u64 = 200;

/// How often another order is looked for where a check of the one before found a better one that is above the
/// floor. One public mesh of 250 needs one; after the last, the better one is taken all the same.
const MOST_RESTARTS: u64 = 4;

/// An order of the faces of one run.
pub(super) struct RunOrder {
    /// Moves nothing where no order is worth it.
    pub(super) order: FaceOrder,
    /// Pushes of the schedule that came with the order, for a controllable cache.
    pub(super) scheduled: u64,
    /// Why an order was not taken, if one was found and none was taken.
    pub(super) reason: Option<&'static str>,
}

impl Algorithm {
    /// Why an order with `after` misses for `before` is not taken; `None` if it is.
    pub(super) fn refusal(&self, before: u64, after: u64) -> Option<&'static str> {
        match (after < before, is_gain(before, after)) {
            _ if self.allows_worse() => None,
            (_, true) => None,
            (true, false) => Some("the order found misses less by too little to be an improvement"),
            (false, false) => Some("the order found does not miss less"),
        }
    }

    /// An order of the faces of one run that is worth it, the polygons that begin at `starts` kept
    /// whole.
    ///
    /// If the faces are those of a whole mesh, the caller has counted their misses, `of_whole`, and
    /// judges an order that is not to be checked: the report needs its misses in any case.
    pub(super) fn run_order(
        &self,
        faces: Faces<'_>,
        starts: Option<&[u32]>,
        of_whole: Option<u64>,
        progress: &SharedProgress<'_>,
    ) -> RunOrder {
        let is_checked = self.is_checked(faces.len(), progress);
        let (mut left, mut parts) = (faces.len(), if is_checked { 2 } else { 1 });
        let mut run = RunOrder {
            order: FaceOrder::identity(faces.len()),
            scheduled: 0,
            reason: None,
        };
        let mut now = Compact::new(faces);
        let mut starts = starts.map(<[u32]>::to_vec);
        let mut misses = of_whole;
        let mut restarts = 0;

        loop {
            // Order: the first time is half of the work, the check the other half.
            let part = progress.part(left.div_ceil(parts));
            let restart = if run.order.is_identity() { restarts } else { 0 };
            let algorithm = self.with_other_seed(restart);
            let (order, scheduled) = algorithm.order(now.faces(), starts.as_deref(), &part);
            part.finish();
            left -= left.div_ceil(parts);
            parts = 1;
            if order.is_identity() {
                break;
            }

            // Leave it to the caller.
            if !is_checked && of_whole.is_some() {
                (run.order, run.scheduled) = (order, scheduled);
                break;
            }

            // Judge.
            let vertex_count = now.faces().vertex_count();
            let ordered = order.apply(now.faces().as_slice());
            let before = misses.unwrap_or_else(|| self.target().cost(now.faces()));
            let after = Faces::of_checked(&ordered, vertex_count);
            let after = self.target().cost(after);
            if let Some(reason) = self.refusal(before, after) {
                run.reason = run.order.is_identity().then_some(reason);
                break;
            }

            // The universal order that a check finds has another floor than the faces had at first. If it is
            // above that one, another order is found for the faces as they were.
            let has_floor = self.target() == Target::Universal && starts.is_none();
            let is_of_check = !run.order.is_identity();
            if has_floor && is_of_check && restarts < MOST_RESTARTS {
                let whole = run.order.then(&order);
                if is_above_floor(faces, &whole) {
                    restarts += 1;
                    run.order = FaceOrder::identity(faces.len());
                    now = Compact::new(faces);
                    misses = of_whole;
                    continue;
                }
            }
            misses = Some(after);

            // Take it.
            starts = starts.map(|starts| moved_starts(&starts, &order));
            run.order = run.order.then(&order);
            run.scheduled = scheduled;
            if !is_checked || progress.is_stopped() {
                break;
            }
            now = now.reordered(ordered);
        }

        progress.part(left).finish();
        run
    }
}

/// Whether `after` misses for `before` are worth it.
pub(super) fn is_gain(before: u64, after: u64) -> bool {
    after < before && (before - after).saturating_mul(SMALLEST_GAIN) >= before
}

/// Where the polygons that began at `starts` begin after `order`, and the end of the last.
fn moved_starts(starts: &[u32], order: &FaceOrder) -> Vec<u32> {
    let mut is_start = vec![false; order.len() + 1];
    for &start in starts {
        is_start[start as usize] = true;
    }
    let new_starts = (0_u32..).zip(order.new_to_old());
    let new_starts = new_starts.filter(|&(_, &old)| is_start[old as usize]);
    let end = starts.last().copied();
    new_starts.map(|(new, _)| new).chain(end).collect()
}

/// The vertices in the order of their first use; those of several levels of detail, fine to coarse, in bands.
pub(super) fn vertex_order(levels: &[Faces<'_>]) -> VertexOrder {
    match levels {
        [only] => vertex_fetch(*only),
        _ => vertex_bands(levels),
    }
}

/// That order, if it moves any vertex: where faces moved, or where it fetches less by what counts, summed over the levels.
pub(super) fn better_vertex_order(levels: &[Faces<'_>], faces_moved: bool) -> Option<VertexOrder> {
    let order = vertex_order(levels);
    if order.is_identity() {
        return None;
    }
    (faces_moved || fetches_less(&order, levels)).then_some(order)
}

/// Whether vertices in this order are fetched better by what counts, summed over the levels.
pub(super) fn fetches_less(order: &VertexOrder, levels: &[Faces<'_>]) -> bool {
    let old_to_new = order.permutation().old_to_new();
    let of_level = |faces: &Faces<'_>| {
        let mut renumbered = faces.as_slice().to_vec();
        renumber(&mut renumbered, &old_to_new);
        let renumbered = Faces::of_checked(&renumbered, faces.vertex_count());
        [*faces, renumbered].map(|faces| cache::fetched(faces, VERTEX_SIZE))
    };
    let [before, after] = levels
        .iter()
        .map(of_level)
        .fold([0; 2], |sums, own| [sums[0] + own[0], sums[1] + own[1]]);
    is_gain(before, after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operations::Options;
    use crate::order::Effort;
    use crate::permutation::Permutation;
    use crate::random::SplitMix64;

    #[test]
    fn a_two_hundredth_is_a_gain() {
        assert!(is_gain(1000, 995) && !is_gain(1000, 996));
        assert!(is_gain(90, 89), "small meshes are exact");
        assert!(!is_gain(0, 0) && !is_gain(1000, 1000) && !is_gain(1000, 2000));
        let algorithm = Algorithm::new(&Options::default());
        assert_eq!(algorithm.refusal(90, 89), None);
        let [little, nothing] = [996, 1000].map(|after| algorithm.refusal(1000, after));
        assert!(little.is_some() && nothing.is_some() && little != nothing);
        let worse = Options {
            allow_worse: true,
            ..Options::default()
        };
        assert_eq!(Algorithm::new(&worse).refusal(1000, 2000), None);
    }

    #[test]
    fn polygons_are_found_where_they_went() {
        let order: FaceOrder = Permutation::new(vec![3, 4, 0, 1, 2, 5]).unwrap().into();
        assert_eq!(moved_starts(&[0, 3, 5, 6], &order), [0, 2, 5, 6]);
        assert_eq!(moved_starts(&[0], &FaceOrder::identity(0)), [0]);
    }

    /// Soups, strips with holes and shuffled grids: what is checked is not taken further.
    #[test]
    fn what_was_ordered_is_not_ordered_again() {
        let mut numbers = SplitMix64(7);
        for case in 0..60_u32 {
            let side = 3 + case % 17;
            let square = |i: u32| {
                let corner = i / side * (side + 1) + i % side;
                let above = corner + side + 1;
                [[corner, corner + 1, above], [corner + 1, above + 1, above]]
            };
            let grid: Vec<[u32; 3]> = (0..side * side).flat_map(square).collect();
            let vertex_count = ((side + 1) * (side + 1)) as usize;
            let mut faces = Permutation::random(grid.len(), u64::from(case)).apply(&grid);
            faces.retain(|_| numbers.below(10) != 0);
            if case % 3 == 0 {
                faces.iter_mut().for_each(|face| {
                    face[0] = crate::index::index32(numbers.below(vertex_count));
                });
            }

            for target in ["universal", "fifo:12", "nvidia", "controllable:9"] {
                let algorithm = Algorithm::new(&Options {
                    target: target.parse().unwrap(),
                    effort: [Effort::Fast, Effort::Best][case as usize % 2],
                    ..Options::default()
                });
                // Two faces a polygon, the last may be one.
                let pairs: Vec<u32> = (0..crate::index::index32(faces.len())).step_by(2).collect();
                let pairs = [pairs, vec![crate::index::index32(faces.len())]].concat();
                for starts in [None, Some(pairs)] {
                    let progress = SharedProgress::new(&(), faces.len());
                    let of = |faces: &[[u32; 3]], starts: Option<&[u32]>| {
                        let faces = Faces::of_checked(faces, vertex_count);
                        algorithm.run_order(faces, starts, None, &progress)
                    };
                    let run = of(&faces, starts.as_deref());
                    let moved = starts.map(|starts| moved_starts(&starts, &run.order));
                    let ordered = run.order.apply(&faces);
                    let again = of(&ordered, moved.as_deref());
                    assert!(again.order.is_identity(), "{target}, case {case}");

                    // And no order is taken that does not gain.
                    let target = algorithm.target();
                    let (before, after) = (target.cost(&faces), target.cost(&ordered));
                    assert_eq!(is_gain(before, after), !run.order.is_identity());
                }
            }
        }
    }
}
