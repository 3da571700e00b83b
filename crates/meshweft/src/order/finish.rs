//! What is done to the order that a search found, for a card among the caches of its target.

use crate::cache::CacheModel;
use crate::cache::nvidia;
use crate::faces::Faces;
use crate::order::in_batches::{Annealing, BESIDE_SIZE, InBatches, exchanged};
use crate::order::polygons::polygon_of_each_face;
use crate::order::target::{Effort, Target};
use crate::order::turn_corners::turn_corners;
use crate::permutation::{FaceOrder, Permutation};
use crate::progress::Progress;

/// The end of a search.
#[derive(Clone, Copy)]
pub(in crate::order) struct Finish<'a> {
    pub(in crate::order) target: Target,
    pub(in crate::order) effort: Effort,
    pub(in crate::order) seed: u64,
    pub(in crate::order) keep_corners: bool,
    /// Polygons that stay whole, as for the search.
    pub(in crate::order) starts: Option<&'a [u32]>,
    /// The caller, who may stop an exchange.
    pub(in crate::order) progress: &'a dyn Progress,
}

impl Finish<'_> {
    /// What a search `found`, with the faces inside the batches of an NVIDIA card in the order that it sets up
    /// faster, if the target has such a card, and if it has nothing else, with faces exchanged between
    /// batches.
    pub(in crate::order) fn of(&self, faces: Faces<'_>, found: FaceOrder) -> FaceOrder {
        let pass = match self.target {
            Target::Universal => InBatches::BESIDE_OTHERS,
            Target::Cache(CacheModel::Nvidia) => InBatches {
                starts: if self.effort == Effort::Fast { 8 } else { 32 },
                ..InBatches::ALONE
            },
            Target::Cache(_) => return found,
        };
        let polygons = self.starts.map(polygon_of_each_face);
        let order = pass.follow_whole(faces, &found, polygons.as_deref());

        match self.target {
            // The search turned the corners for its first cache.
            Target::Universal if !self.keep_corners && self.starts.is_none() => {
                turn_corners(faces, &order, CacheModel::fifo(BESIDE_SIZE))
            }
            Target::Universal => order,
            _ => self.exchanged(faces, order, pass),
        }
    }

    /// The order with faces exchanged between batches, and moved by the pass, if that is better.
    fn exchanged(&self, faces: Faces<'_>, order: FaceOrder, pass: InBatches) -> FaceOrder {
        let annealing = annealing(self.effort).filter(|_| self.starts.is_none());
        let Some(annealing) = annealing else {
            return order;
        };
        let ordered = order.apply(faces.as_slice());
        let (seed, progress) = (self.seed, self.progress);
        let places = exchanged(&ordered, faces.vertex_count(), &annealing, seed, progress);
        let other = order.then(&Permutation::from_algorithm(places).into());
        let other = pass.follow_whole(faces, &other, None);

        let before = nvidia::counts(&ordered);
        let after = nvidia::counts(&other.apply(faces.as_slice()));
        let is_better = after.invocations <= before.invocations
            && after.warps <= before.warps
            && after.cost() < before.cost();
        if is_better { other } else { order }
    }
}

/// How long faces are exchanged, and how far uphill; not at effort `fast`.
///
/// More sweeps gain slowly: four times as many .2 to .3 %. A hotter start loses what the search found.
fn annealing(effort: Effort) -> Option<Annealing> {
    match effort {
        Effort::Fast => None,
        Effort::Best => Some(Annealing {
            sweeps: 100,
            temperatures: [13_500, 6_500],
            size: 8,
        }),
        Effort::Max => Some(Annealing {
            sweeps: 6000,
            temperatures: [17_500, 8_000],
            size: 8,
        }),
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::index::index32;
    use crate::random::{SplitMix64, shuffled};

    /// A grid of squares with some corners moved elsewhere, its faces shuffled a little.
    fn soup(case: u64) -> (Vec<[u32; 3]>, usize) {
        let mut numbers = SplitMix64(case);
        let (width, height) = (2 + numbers.below(20), 2 + numbers.below(20));
        let wild = [usize::MAX, 50, 8][numbers.below(3)];
        let base = [0, 65_400][numbers.below(2)];
        let mut faces = Vec::new();
        for square in 0..width * height {
            let at = base + square / width * (width + 1) + square % width;
            let above = at + width + 1;
            for face in [[at, at + 1, above], [at + 1, above + 1, above]] {
                let mut face = face.map(index32);
                if numbers.below(wild) == 0 {
                    face[numbers.below(3)] = index32(base + numbers.below(width * height));
                }
                faces.push(face);
            }
        }
        if case.is_multiple_of(3) {
            let order = shuffled(faces.len(), case);
            faces = order.iter().map(|&face| faces[face as usize]).collect();
        }
        (faces, base + (width + 1) * (height + 1))
    }

    struct Stopped;

    impl Progress for Stopped {
        fn report(&self, _: f64) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }

    fn finish(seed: u64) -> Finish<'static> {
        Finish {
            target: CacheModel::Nvidia.into(),
            effort: Effort::Best,
            seed,
            keep_corners: true,
            starts: None,
            progress: &(),
        }
    }

    /// By a recount of the order: never an invocation or a warp more than the pass alone gives.
    #[test]
    fn an_exchange_never_costs_an_invocation_or_a_warp() {
        let mut fewer = 0;
        for case in 0..150 {
            let (faces, vertex_count) = soup(case);
            let checked = Faces::of_checked(&faces, vertex_count);
            let found = FaceOrder::identity(faces.len());
            let alone = Finish {
                progress: &Stopped,
                ..finish(case)
            };
            let [before, after] = [alone, finish(case)].map(|finish| {
                let order = finish.of(checked, found.clone());
                Permutation::new(order.new_to_old().to_vec()).unwrap();
                nvidia::counts(&order.apply(&faces))
            });
            assert!(after.invocations <= before.invocations, "case {case}");
            assert!(after.warps <= before.warps, "case {case}");
            fewer += usize::from(after.invocations < before.invocations);
        }
        assert!(fewer > 10, "{fewer}");
    }

    #[test]
    fn polygons_and_orders_that_were_stopped_exchange_nothing() {
        let mut compared = 0;
        for case in 0..60 {
            let (faces, vertex_count) = soup(case);
            let checked = Faces::of_checked(&faces, vertex_count);
            let found = FaceOrder::identity(faces.len());
            let stopped = Finish {
                progress: &Stopped,
                ..finish(case)
            };
            let stopped = stopped.of(checked, found.clone());
            if finish(case).of(checked, found.clone()) == stopped {
                continue;
            }
            let starts: Vec<u32> = (0..=index32(faces.len())).collect();
            let whole = Finish {
                starts: Some(&starts),
                ..finish(case)
            };
            assert_eq!(whole.of(checked, found), stopped, "case {case}");
            compared += 1;
        }
        assert!(compared > 3, "{compared}");
    }
}
