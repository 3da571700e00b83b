//! A search with settings handed in, for the program that tunes them.
//!
//! Not for users: numbers come and go with the presets. How far and how often a search looks ahead is
//! not among them: that buys quality with time, and the effort decides on it.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use super::mask::Mask;
use super::preset::{MAX_SIZE, preset};
use super::rollout::{Caller, Rollouts};
use super::settings::Settings;
use super::state::{CacheLimits, State};
use crate::faces::Faces;
use crate::order::finish::Finish;
use crate::order::target::{Effort, Target};
use crate::order::vertex_fetch::vertex_fetch;
use crate::permutation::{FaceOrder, Permutation};

/// The names of the [`Numbers`].
pub const NAMES: [&str; 20] = [
    "window",
    "windows[0]",
    "windows[1]",
    "windows[2]",
    "weights.missing[0]",
    "weights.missing[1]",
    "weights.live",
    "weights.age",
    "weights.late",
    "weights.outside",
    "weights.outside_age",
    "score.exits[0]",
    "score.exits[1]",
    "score.windows[0]",
    "score.windows[1]",
    "score.windows[2]",
    "score.face",
    "score.age",
    "horizon.noise",
    "horizon.margin",
];

/// How many of them, the first, are whole: lengths of windows in pushes.
pub const WHOLE: usize = 4;

/// The largest value of each of the whole ones: the longer windows must fit in the ring of pushes.
pub const LONGEST: [u32; WHOLE] = [MAX_SIZE, 255, 255, 255];

/// What is tuned, by [`NAMES`]; a preset keeps all but the whole ones in 1024ths.
pub type Numbers = [f64; NAMES.len()];

/// The numbers of a preset.
#[must_use]
pub fn numbers(target: Target, effort: Effort) -> Numbers {
    let mut settings = preset(target, effort);
    let (whole, weights) = places(&mut settings);
    let whole = whole.map(|number| f64::from(*number));
    let weights = weights.map(|weight| *weight as f64 / 1024.0);

    let mut numbers = [0.0; NAMES.len()];
    numbers[..WHOLE].copy_from_slice(&whole);
    numbers[WHOLE..].copy_from_slice(&weights);
    numbers
}

/// The order of a search with these numbers, which otherwise is that of the target and the effort.
///
/// The mesh is searched as one part.
///
/// # Panics
/// If a whole number is below 1 or above [`LONGEST`].
#[must_use]
pub fn face_order<'a>(
    faces: impl Into<Faces<'a>>,
    target: Target,
    effort: Effort,
    numbers: &Numbers,
    seed: u64,
) -> FaceOrder {
    let mut settings = preset(target, effort);
    hand_in(numbers, &mut settings);

    // The numbers of vertices break ties: they are those of first use, as in `parts`.
    let given = faces.into();
    let renumbered = vertex_fetch(given).renumber(given.as_slice());
    let faces = Faces::of_checked(&renumbered, given.vertex_count());

    let first = settings.first;
    let is_short = settings.window <= u64::SPAN;
    let found = match (settings.second, is_short) {
        (None, true) => run::<u64, 1>(faces, &settings, [first], seed),
        (None, false) => run::<u128, 1>(faces, &settings, [first], seed),
        (Some(second), true) => run::<u64, 2>(faces, &settings, [first, second], seed),
        (Some(second), false) => run::<u128, 2>(faces, &settings, [first, second], seed),
    };
    let finish = Finish {
        target,
        effort,
        seed,
        keep_corners: false,
        starts: None,
        progress: &(),
    };
    finish.of(given, found)
}

fn hand_in(numbers: &Numbers, settings: &mut Settings) {
    let (whole, weights) = places(settings);
    for ((place, &number), longest) in whole.into_iter().zip(numbers).zip(LONGEST) {
        assert!(
            (1.0..=f64::from(longest)).contains(&number),
            "{number} is not from 1 to {longest}"
        );
        *place = rounded(number).try_into().expect("below the longest");
    }
    for (place, number) in weights.into_iter().zip(&numbers[WHOLE..]) {
        *place = rounded(number * 1024.0);
    }
}

fn rounded(number: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
    {
        number.round() as i64
    }
}

/// Where the numbers stand in settings, in the order of [`NAMES`].
fn places(settings: &mut Settings) -> ([&mut u32; WHOLE], [&mut i64; NAMES.len() - WHOLE]) {
    let [a, b, c] = &mut settings.windows;
    let (weights, score) = (&mut settings.weights, &mut settings.score);
    let [missing_first, missing_second] = &mut weights.missing;
    let [exits_first, exits_second] = &mut score.exits;
    let [exits_a, exits_b, exits_c] = &mut score.windows;
    let all = [
        missing_first,
        missing_second,
        &mut weights.live,
        &mut weights.age,
        &mut weights.late,
        &mut weights.outside,
        &mut weights.outside_age,
        exits_first,
        exits_second,
        exits_a,
        exits_b,
        exits_c,
        &mut score.face,
        &mut score.age,
        &mut settings.horizon.noise,
        &mut settings.horizon.margin,
    ];
    ([&mut settings.window, a, b, c], all)
}

fn run<M: Mask, const CACHES: usize>(
    faces: Faces<'_>,
    settings: &Settings,
    limits: [CacheLimits; CACHES],
    seed: u64,
) -> FaceOrder {
    let mut state = State::<M, CACHES>::new(faces, limits);
    state.window = settings.window;
    state.windows = settings.windows;
    let caller = Caller {
        progress: &(),
        faces: faces.len(),
        drawn: AtomicUsize::new(0),
        is_stopped: AtomicBool::new(false),
    };

    let state = Rollouts::new(state, settings, seed).run(u64::MAX, &caller);
    let order = Permutation::from_algorithm(state.new_to_old);
    FaceOrder::new(order, state.rotations).expect("one rotation below 3 a face")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::order::search::Search;
    use crate::order::search::state::RING;
    use crate::order::{Optimizer, baselines};
    use crate::progress::Budget;

    /// The optimizer's order, but that the universal one is not held against others.
    fn searched(faces: Faces<'_>, target: Target, effort: Effort, seed: u64) -> FaceOrder {
        if target != Target::Universal {
            let optimizer = Optimizer {
                target,
                effort,
                seed,
                ..Optimizer::default()
            };
            return optimizer.face_order(faces);
        }
        let search = Search {
            target,
            effort,
            seed,
            keep_corners: false,
            budget: Budget::Unlimited,
            progress: &(),
        };
        let finish = Finish {
            target,
            effort,
            seed,
            keep_corners: false,
            starts: None,
            progress: &(),
        };
        finish.of(faces, search.face_order(faces, None))
    }

    #[test]
    fn with_a_presets_own_numbers_it_is_the_presets_search() {
        let square = |i: u32| {
            let corner = i / 20 * 21 + i % 20;
            [
                [corner, corner + 1, corner + 21],
                [corner + 1, corner + 22, corner + 21],
            ]
        };
        let faces: Vec<_> = (0..400).flat_map(square).collect();
        let faces = baselines::random(800, 1).apply(&faces);

        for target in [
            "universal",
            "fifo:12",
            "fifo:80",
            "controllable:9",
            "nvidia",
            "intel",
        ] {
            let target: Target = target.parse().unwrap();
            for (effort, seed) in [(Effort::Best, 7), (Effort::Max, 0)] {
                let numbers = numbers(target, effort);
                let tuned = face_order(&faces, target, effort, &numbers, seed);
                let faces = Faces::new(&faces, 441).unwrap();
                assert_eq!(tuned, searched(faces, target, effort, seed), "{target}");
            }
        }
    }

    #[test]
    fn every_number_is_handed_in_where_its_name_says() {
        assert!(LONGEST.iter().all(|&longest| (longest as usize) < RING));
        let mut settings = preset(Target::Universal, Effort::Best);
        let numbers: Numbers = std::array::from_fn(|i| (i + 1) as f64);
        hand_in(&numbers, &mut settings);
        let value = |name| numbers[NAMES.iter().position(|other| *other == name).unwrap()];
        let weight = |name| rounded(value(name)) * 1024;
        assert_eq!(f64::from(settings.windows[2]), value("windows[2]"));
        assert_eq!(settings.weights.outside_age, weight("weights.outside_age"));
        assert_eq!(settings.score.windows[1], weight("score.windows[1]"));
        assert_eq!(settings.horizon.margin, weight("horizon.margin"));
    }
}
