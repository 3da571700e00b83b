//! One order for every cache: the best of several among those that are nowhere above the floor.
//!
//! The *floor* is the order by linear-speed optimisation ([`linear_speed`]), which is meshoptimizer's. A
//! search misses less in nearly all caches on nearly all meshes, but none that we know does so in all of
//! them on every mesh: where vertices of ordinary valence end at hubs, as between the caps of swept
//! walls, finishing one vertex after the other leaves them behind with the hub's face. So both are
//! found, and an order counts only if it is above the floor in no model that [`Target::Universal`] stands
//! for, nor in the setup cycles of NVIDIA cards. Of these the one of least cost is taken. The floor is one
//! of them, so there always is one.
//!
//! Read [`Universal::face_order`] first.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::cache::{CacheModel, misses_of, nvidia};
use crate::faces::Faces;
#[cfg(any(test, doc))]
use crate::order::baselines::linear_speed;
use crate::order::in_batches::{BESIDE_SIZE, InBatches};
use crate::order::linear_speed::linear_speed_within_limits;
use crate::order::search::Search;
use crate::order::target::Effort;
#[cfg(doc)]
use crate::order::target::Target;
use crate::order::turn_corners::turn_corners;
use crate::parallel;
use crate::permutation::FaceOrder;
use crate::progress::{PartOfWork, Progress};

/// What a miss in the smallest cache weighs, in 64ths of a setup cycle, while faces are moved inside batches: the
/// more, the fewer misses it has, and the more cycles there are. The first that does not bring more cycles than
/// the floor has is taken.
const BESIDE: [u32; 3] = [256, 128, InBatches::BESIDE_OTHERS.beside];

/// Up to how much of the progress the first search comes.
const FIRST_SEARCH: f64 = 0.8;

/// How the universal order of a mesh without polygons is found.
pub(in crate::order) struct Universal<'a> {
    /// Its progress is that of all.
    pub(in crate::order) search: Search<'a>,
    /// How many searches are tried at most, each with another seed, until one is nowhere above the floor.
    pub(in crate::order) tries: u64,
}

/// An order, the faces in it, and what they cost.
struct CountedOrder {
    order: FaceOrder,
    counts: UniversalCounts,
}

impl Universal<'_> {
    /// The order of least cost among those nowhere above the floor: the faces as they are, what a search finds, the
    /// floor.
    ///
    /// If the caller stops it, what the search has until then; without a floor where that takes too long
    /// ([`linear_speed_within_limits`]).
    pub(in crate::order) fn face_order(&self, faces: Faces<'_>) -> FaceOrder {
        // Floor and search are two jobs. The search reports; once it is done the floor does.
        let part = PartOfWork::new(self.search.progress, 0.0, FIRST_SEARCH);
        let is_searched = AtomicBool::new(false);
        let goes_on = || match is_searched.load(Ordering::Relaxed) {
            true => part.report(1.0).is_continue(),
            false => !part.is_stopped(),
        };
        let (mut found, floor) = parallel::join(
            || {
                let search = self.search.with_progress(&part, 0);
                let found = search.face_order(faces, None);
                is_searched.store(true, Ordering::Relaxed);
                found
            },
            || {
                let floor = linear_speed_within_limits(faces, &goes_on);
                floor.map(|floor| CountedOrder::new(faces, floor))
            },
        );
        let Some(floor) = floor.filter(|_| !part.is_stopped()) else {
            let _ = self.search.progress.report(1.0);
            return self.in_batches(faces, &found, InBatches::BESIDE_OTHERS.beside);
        };

        // A search nowhere above the floor.
        let mut best = self.admitted(faces, &found, &floor.counts);
        for seed in 1..self.tries {
            let tried = seed as f64 / self.tries as f64;
            let start = FIRST_SEARCH + (1.0 - FIRST_SEARCH) * tried;
            let part = PartOfWork::new(self.search.progress, start, start);
            if best.is_some() || part.report(0.0).is_break() {
                break;
            }
            found = self
                .search
                .with_progress(&part, seed)
                .face_order(faces, None);
            best = self.admitted(faces, &found, &floor.counts);
        }

        // The least, the faces as they are before all that cost as much.
        let as_they_are =
            CountedOrder::within(faces, FaceOrder::identity(faces.len()), &floor.counts);
        let counted = as_they_are.into_iter().chain(best).chain([floor]);
        let least = counted.min_by_key(|found| found.counts.cost());
        let _ = self.search.progress.report(1.0);
        least.map_or(found, |found| found.order)
    }

    /// What a search found, moved inside batches so that it is nowhere above the floor.
    fn admitted(
        &self,
        faces: Faces<'_>,
        found: &FaceOrder,
        floor: &UniversalCounts,
    ) -> Option<CountedOrder> {
        // In these models moves inside batches change next to nothing.
        let ordered = found.apply(faces.as_slice());
        let ordered = Faces::of_checked(&ordered, faces.vertex_count());
        if is_above(&misses_of(ordered, &LARGE), &floor.large) {
            return None;
        }

        // The first weight is often too much, and a pass more is dear only beside a short search.
        let skipped = usize::from(self.search.effort == Effort::Fast);
        for &beside in &BESIDE[skipped..] {
            let order = self.in_batches(faces, found, beside);
            match CountedOrder::within(faces, order, floor) {
                Ok(found) => return Some(found),
                // Less weight for misses brings fewer cycles, and nothing else.
                Err(Above::SetupCycles) => {}
                Err(Above::Misses) => return None,
            }
        }
        None
    }

    /// An order with the faces moved inside batches, and their corners turned.
    fn in_batches(&self, faces: Faces<'_>, found: &FaceOrder, beside: u32) -> FaceOrder {
        let pass = InBatches {
            beside,
            ..InBatches::BESIDE_OTHERS
        };
        let order = pass.follow(faces, found);
        match self.search.keep_corners {
            true => order,
            false => turn_corners(faces, &order, CacheModel::fifo(BESIDE_SIZE)),
        }
    }
}

impl CountedOrder {
    fn new(faces: Faces<'_>, order: FaceOrder) -> Self {
        let ordered = order.apply(faces.as_slice());
        let counts = UniversalCounts::of(Faces::of_checked(&ordered, faces.vertex_count()));
        Self { order, counts }
    }

    /// An order that is nowhere above the floor.
    fn within(faces: Faces<'_>, order: FaceOrder, floor: &UniversalCounts) -> Result<Self, Above> {
        let ordered = order.apply(faces.as_slice());
        let counts =
            UniversalCounts::within(Faces::of_checked(&ordered, faces.vertex_count()), floor)?;
        Ok(Self { order, counts })
    }
}

/// Whether the faces in this order are above the floor in some model, which linear-speed optimisation makes of
/// them as they are.
///
/// Time and space as [`linear_speed`].
pub(crate) fn is_above_floor(faces: Faces<'_>, order: &FaceOrder) -> bool {
    linear_speed_within_limits(faces, &|| true).is_some_and(|floor| {
        let floor = CountedOrder::new(faces, floor);
        CountedOrder::within(faces, order.clone(), &floor.counts).is_err()
    })
}

/// Where an order is above the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Above {
    /// In the misses or invocations of a model at least.
    Misses,
    /// In the setup cycles of NVIDIA cards alone.
    SetupCycles,
}

/// What an order costs in each model that [`Target::Universal`] stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct UniversalCounts {
    /// The misses of all models but that of NVIDIA cards.
    small: Vec<u64>,
    large: Vec<u64>,
    card: nvidia::DrawCounts,
}

/// The models but that of NVIDIA cards, which has more counts than misses: those of small caches, and those of large
/// ones.
const SMALL: [CacheModel; 4] = [
    CacheModel::fifo(10),
    CacheModel::fifo(12),
    CacheModel::fifo(16),
    CacheModel::fifo(24),
];
const LARGE: [CacheModel; 4] = [
    CacheModel::fifo(32),
    CacheModel::fifo(64),
    CacheModel::AMD,
    CacheModel::INTEL,
];

impl UniversalCounts {
    /// Of faces in this order.
    pub(crate) fn of(faces: Faces<'_>) -> Self {
        Self {
            small: misses_of(faces, &SMALL),
            large: misses_of(faces, &LARGE),
            card: nvidia::counts(faces),
        }
    }

    /// Of faces in this order, if they are nowhere above `floor`.
    ///
    /// Takes little time where they are above it in the first models.
    pub(crate) fn within(faces: Faces<'_>, floor: &Self) -> Result<Self, Above> {
        let large = misses_of(faces, &LARGE);
        if is_above(&large, &floor.large) {
            return Err(Above::Misses);
        }
        let small = misses_of(faces, &SMALL);
        if is_above(&small, &floor.small) {
            return Err(Above::Misses);
        }
        let card = nvidia::counts(faces);
        match floor.card {
            of_floor if card.invocations > of_floor.invocations => Err(Above::Misses),
            of_floor if card.setup_cycles > of_floor.setup_cycles => Err(Above::SetupCycles),
            _ => Ok(Self { small, large, card }),
        }
    }

    /// As [`Target::cost`].
    pub(crate) fn cost(&self) -> u64 {
        self.small.iter().chain(&self.large).sum::<u64>() + self.card.cost()
    }
}

/// Whether one of the counts is above its counterpart.
fn is_above(counts: &[u64], floor: &[u64]) -> bool {
    counts.iter().zip(floor).any(|(count, floor)| count > floor)
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::index::index32;
    use crate::order::target::Target;
    use crate::permutation::Permutation;
    use crate::progress::Budget;
    use crate::random::SplitMix64;

    /// Squares of a grid with some corners moved elsewhere, or faces of random corners.
    fn soup(case: u64) -> (Vec<[u32; 3]>, usize) {
        let mut numbers = SplitMix64(case);
        let (width, height) = (1 + numbers.below(24), 1 + numbers.below(24));
        let vertex_count = (width + 1) * (height + 1);
        let wild = [usize::MAX, 40, 6, 1][numbers.below(4)];
        let mut faces = Vec::new();
        for square in 0..width * height {
            let at = square / width * (width + 1) + square % width;
            let above = at + width + 1;
            for face in [[at, at + 1, above], [at + 1, above + 1, above]] {
                let mut face = face.map(index32);
                if numbers.below(wild) == 0 {
                    face[numbers.below(3)] = index32(numbers.below(vertex_count));
                }
                faces.push(face);
            }
        }
        if case.is_multiple_of(2) {
            faces = Permutation::random(faces.len(), case).apply(&faces);
        }
        (faces, vertex_count)
    }

    fn universal(seed: u64, effort: Effort, progress: &dyn Progress) -> Universal<'_> {
        let search = Search {
            target: Target::Universal,
            effort,
            seed,
            keep_corners: seed.is_multiple_of(3),
            budget: Budget::Unlimited,
            progress,
        };
        Universal { search, tries: 2 }
    }

    /// Counted one model after the other.
    #[test]
    fn no_order_is_above_the_floor_in_any_model() {
        let mut better = 0;
        for case in 0..400 {
            let (faces, vertex_count) = soup(case);
            let checked = Faces::of_checked(&faces, vertex_count);
            let effort = [Effort::Fast, Effort::Best][usize::from(case.is_multiple_of(2))];
            let order = universal(case, effort, &()).face_order(checked);
            Permutation::new(order.new_to_old().to_vec()).unwrap();
            let floor = linear_speed(checked).apply(&faces);
            let ordered = order.apply(&faces);
            for model in Target::UNIVERSAL {
                let [ours, least] =
                    [&ordered, &floor].map(|faces| crate::cache::misses(faces, model));
                assert!(ours <= least, "case {case}, {model}: {ours}, floor {least}");
            }
            let cycles = [&ordered, &floor].map(|faces| nvidia::counts(faces).setup_cycles);
            assert!(
                cycles[0] <= cycles[1],
                "case {case}: {cycles:?} setup cycles"
            );
            let costs = [&ordered, &floor, &faces].map(|faces| Target::Universal.cost(faces));
            assert!(costs[0] <= costs[1], "case {case}: {costs:?}");
            better += usize::from(costs[0] < costs[1]);
        }
        assert!(better > 30, "{better}");
    }

    #[test]
    fn faces_that_are_as_good_stay() {
        // A strip: each vertex is transformed once as it is.
        let strip: Vec<[u32; 3]> = (0..60).map(|i| [i, i + 1, i + 2]).collect();
        let order = universal(1, Effort::Best, &()).face_order(Faces::of_checked(&strip, 62));
        assert!(order.is_identity());
    }

    #[test]
    fn counts_say_where_an_order_is_above() {
        let (faces, vertex_count) = soup(8);
        let checked = Faces::of_checked(&faces, vertex_count);
        let counts = UniversalCounts::of(checked);
        assert_eq!(counts.cost(), Target::Universal.cost(checked));
        assert_eq!(
            UniversalCounts::within(checked, &counts),
            Ok(counts.clone())
        );

        let mut fewer = counts.clone();
        fewer.card.setup_cycles -= 1;
        assert_eq!(
            UniversalCounts::within(checked, &fewer),
            Err(Above::SetupCycles)
        );
        fewer.card.invocations -= 1;
        assert_eq!(UniversalCounts::within(checked, &fewer), Err(Above::Misses));
        for model in 0..4 {
            let mut fewer = [counts.clone(), counts.clone()];
            fewer[0].small[model] -= 1;
            fewer[1].large[model] -= 1;
            for fewer in fewer {
                assert_eq!(UniversalCounts::within(checked, &fewer), Err(Above::Misses));
            }
        }
        let mut models: Vec<CacheModel> = [SMALL, LARGE].concat();
        models.push(CacheModel::Nvidia);
        assert!(Target::UNIVERSAL.iter().all(|model| models.contains(model)));
        assert_eq!(models.len(), Target::UNIVERSAL.len());
    }

    struct Stopped;

    impl Progress for Stopped {
        fn report(&self, _: f64) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }

    #[test]
    fn an_order_that_is_stopped_is_complete() {
        let (faces, vertex_count) = soup(9);
        let checked = Faces::of_checked(&faces, vertex_count);
        let order = universal(9, Effort::Max, &Stopped).face_order(checked);
        assert_eq!(order.len(), faces.len());
        Permutation::new(order.new_to_old().to_vec()).unwrap();
    }
}
