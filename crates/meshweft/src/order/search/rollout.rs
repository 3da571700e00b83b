//! The loop: run several continuations, commit the beginning of the best one.
//!
//! A *continuation* ([`Rollout`]) is a list of focus vertices. It is run by drawing them with
//! `UNDO` and taken back afterwards. What is *committed* is drawn without `UNDO`, or as it was recorded, and
//! stays. The tail of the best continuation is run again as the first one of the next round.
//!
//! Read `run` first, then `best_of` for a round, `try_out` for a continuation in it.

use std::hint::select_unpredictable;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::mask::Mask;
use super::settings::Settings;
use super::state::{Candidate, Redo, State};
use crate::order::greedy::HUB;
use crate::progress::Progress;

/// Progress of a search, shared by all its parts.
pub(super) struct Caller<'a> {
    pub(super) progress: &'a dyn Progress,
    /// How many faces all parts have.
    pub(super) faces: usize,
    /// How many of them are drawn.
    pub(super) drawn: AtomicUsize,
    /// Whether the caller wants it to stop: all parts then do.
    pub(super) is_stopped: AtomicBool,
}

/// How often an untimed search reports, in faces: often enough to stop without delay, too seldom to
/// cost time.
const REPORT_EVERY: usize = 1 << 10;

/// Most continuations in a round of a timed search.
const MOST_RUNS: usize = 4096;

/// How much a part may still look ahead.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// Continuations in each round; 1: greedy.
    runs: usize,
    /// How many rounds are left.
    steps: u64,
    /// Whether `runs` follows the time spent.
    is_timed: bool,
    /// How many faces of the part were drawn at the last report.
    reported: usize,
}

impl Pace {
    /// Reports that `drawn` faces of the part are drawn, if a report is due.
    fn report_if_due(&mut self, drawn: usize, caller: &Caller<'_>) {
        if drawn - self.reported >= REPORT_EVERY || self.is_timed {
            self.report(drawn, caller);
        }
    }

    /// Reports that `drawn` faces of the part are drawn, and does as the caller says.
    fn report(&mut self, drawn: usize, caller: &Caller<'_>) {
        let newly_drawn = drawn - self.reported;
        self.reported = drawn;
        let drawn = caller.drawn.fetch_add(newly_drawn, Ordering::Relaxed) + newly_drawn;
        let share_of_faces = drawn as f64 / caller.faces.max(1) as f64;

        if caller.progress.report(share_of_faces).is_break() {
            caller.is_stopped.store(true, Ordering::Relaxed);
        }

        if caller.is_stopped.load(Ordering::Relaxed) {
            self.steps = 0;
        } else if let Some(share_of_time) = caller.progress.time_spent() {
            // Faster down than up: what is late has to catch up.
            self.runs = match share_of_time > share_of_faces {
                true => (self.runs * 3 / 4).max(1),
                false => (self.runs + 1 + self.runs / 8).min(MOST_RUNS),
            };
        }
    }
}

/// Most places in [`Rollouts::noises`] where a choice may start.
const NOISE_STARTS: usize = 4096;
/// Most candidates of any window, so most noises of a choice.
const MAX_CANDIDATES: usize = 128;

/// A search over one part of the mesh.
pub(super) struct Rollouts<'a, M, const CACHES: usize> {
    state: State<'a, M, CACHES>,
    settings: &'a Settings,
    /// The state of the random numbers, see [`next_random`].
    random: u64,
    /// Noise for the costs, from 0 up to `settings.horizon.noise`. Each choice takes consecutive ones
    /// from a random place: one random number a choice instead of one a candidate.
    noises: Vec<i64>,
    /// Where the scan in file order goes on: no vertex before it has faces left.
    input_cursor: u32,
    /// What the best continuation of a round drew, where that is to be committed as a whole.
    redo: Redo<M, CACHES>,
}

/// A continuation.
#[derive(Default)]
struct Rollout {
    /// The focus vertices, in order.
    path: Vec<u32>,
    /// The score after each of them, without the ages of candidates.
    scores: Vec<i64>,
}

/// Why a continuation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// It is as long as the horizon, or no candidate is left.
    Complete,
    /// Its last focus is a hub: too many faces to draw in each continuation, so it is not drawn.
    BeforeHub,
    /// It was far worse than the best one.
    Behind,
}

impl<'a, M: Mask, const CACHES: usize> Rollouts<'a, M, CACHES> {
    /// A search that goes on from `state`.
    pub(super) fn new(state: State<'a, M, CACHES>, settings: &'a Settings, seed: u64) -> Self {
        const { assert!(M::SPAN as usize <= MAX_CANDIDATES) };

        // Many meshes are tiny: no more noise for them than they can use.
        let starts = (8 * state.face_count()).clamp(1, NOISE_STARTS);
        let mut random = seed.wrapping_add(1);
        let noises = (0..starts + MAX_CANDIDATES).map(|_| {
            random = next_random(random);
            ((random >> 32).cast_signed() * settings.horizon.noise) >> 32
        });

        Self {
            noises: noises.collect(),
            state,
            settings,
            random,
            input_cursor: 0,
            redo: Redo::default(),
        }
    }

    /// Draws all faces, with at most `steps` rounds that look ahead.
    pub(super) fn run(mut self, steps: u64, caller: &Caller<'_>) -> State<'a, M, CACHES> {
        let horizon = self.settings.horizon;
        let (mut winner, mut spare) = (Rollout::default(), Rollout::default());
        let mut pace = Pace {
            runs: horizon.runs,
            steps,
            is_timed: caller.progress.time_spent().is_some(),
            reported: 0,
        };

        loop {
            pace.report_if_due(self.state.new_to_old.len(), caller);

            if !self.state.has_candidates() {
                // Dead end: the winner has no tail that goes on from here.
                winner.path.clear();
                let Some(focus) = self.after_dead_end() else {
                    pace.report(self.state.new_to_old.len(), caller);
                    return self.state;
                };
                self.state.draw::<false>(focus);
            } else if pace.runs == 1 || pace.steps == 0 {
                // Greedy, without looking ahead.
                winner.path.clear();
                if let Some(focus) = self.cheapest::<false>() {
                    self.state.draw::<false>(focus);
                }
            } else {
                // A round. With a candidate the best path has at least one focus.
                pace.steps -= 1;
                let is_drawn = self.best_of(pace.runs, &mut winner, &mut spare);
                let commit = horizon.commit.clamp(1, winner.path.len());
                for focus in winner.path.drain(..commit) {
                    if !is_drawn {
                        self.state.draw::<false>(focus);
                    }
                }
            }
        }
    }

    /// Runs continuations from the current state and leaves the best of them in `winner`; returns
    /// whether that one is still drawn.
    ///
    /// `winner` comes in with the tail of the last round's winner, which the first continuation
    /// repeats; the others start afresh. Each is recorded in `spare`. If it is better, the two are
    /// swapped: `winner` then has the new best, and `spare` the buffers for the next one.
    ///
    /// Each is taken back, so the caller draws the part of `winner` that it commits again, without
    /// `UNDO`. Where `winner` is to be committed as a whole, that is saved (`true`): the last continuation is kept as
    /// it is drawn, what another one drew was recorded.
    fn best_of(&mut self, runs: usize, winner: &mut Rollout, spare: &mut Rollout) -> bool {
        let horizon = self.settings.horizon;
        self.state.reset_exits();
        let saved = self.state.save();
        let mut best = i64::MAX;
        let mut is_recorded = false;

        for number in 0..runs {
            self.state.begin();
            let end = self.try_out(number == 0, saved.drawn, winner, spare);

            if end != End::Behind {
                let score = self.score_since(saved.drawn) + self.ages();
                if score < best {
                    best = score;
                    std::mem::swap(winner, spare);

                    let is_last = number + 1 == runs || score <= horizon.good_enough;
                    let is_committed_whole =
                        end == End::Complete && horizon.commit >= horizon.steps;
                    if is_committed_whole && is_last {
                        self.state.keep();
                        return true;
                    }
                    if is_last {
                        self.state.undo(&saved);
                        return false;
                    }
                    is_recorded = is_committed_whole;
                    if is_recorded {
                        self.state.undo_to_redo(&saved, &mut self.redo);
                        continue;
                    }
                }
            }

            self.state.undo(&saved);
        }
        if is_recorded {
            self.state.redo(&mut self.redo);
        }
        is_recorded
    }

    /// Draws a continuation with `UNDO`, and records it in `rollout`; `drawn` faces were drawn before.
    ///
    /// The first one of a round repeats the path of `winner` and goes on without noise. The others
    /// choose with noise, and are given up if they are far worse than `winner`.
    fn try_out(
        &mut self,
        is_first: bool,
        drawn: usize,
        winner: &Rollout,
        rollout: &mut Rollout,
    ) -> End {
        let horizon = self.settings.horizon;
        let repeated: &[u32] = if is_first { &winner.path } else { &[] };
        rollout.path.clear();
        rollout.scores.clear();

        for step in 0..horizon.steps {
            // Choose the focus.
            let focus = match repeated.get(step) {
                Some(&focus) => Some(focus),
                None if is_first => self.cheapest::<false>(),
                None => self.cheapest::<true>(),
            };
            let Some(focus) = focus else { break };

            // Draw it.
            rollout.path.push(focus);
            if self.state.live(focus) > HUB {
                return End::BeforeHub;
            }
            self.state.draw::<true>(focus);
            let score = self.score_since(drawn);
            rollout.scores.push(score);

            // Compare with what the best one had after as many steps, or after its last one.
            if !is_first && step > horizon.patience {
                let best = winner.scores.get(step).or(winner.scores.last());
                if best.is_some_and(|best| score > best + horizon.margin) {
                    return End::Behind;
                }
            }
        }
        End::Complete
    }

    /// The score of what was drawn after the first `drawn` faces, without the ages of candidates.
    #[inline]
    fn score_since(&self, drawn: usize) -> i64 {
        let weights = &self.settings.score;
        let faces = self.state.new_to_old.len() - drawn;
        let mut score = -weights.face * faces as i64;
        for (cache, weight) in self.state.caches.iter().zip(weights.exits) {
            score += weight * i64::from(cache.exits);
        }
        if CACHES > 1 {
            for (&exits, weight) in self.state.window_exits.iter().zip(weights.windows) {
                score += weight * i64::from(exits);
            }
        }
        score
    }

    /// What the ages of the remaining candidates add to a score: the older, the sooner they are
    /// evicted.
    fn ages(&self) -> i64 {
        let weight = self.settings.score.age;
        let mut ages = 0;
        if weight != 0 {
            self.state
                .candidates(u32::MAX, |_, candidate| ages += i64::from(candidate.age));
        }
        weight * ages
    }

    /// The next focus when no candidate is left: the last vertex that left unfinished, else the
    /// first in file order that has faces left; `None` if all faces are drawn.
    fn after_dead_end(&mut self) -> Option<u32> {
        while let Some(vertex) = self.state.dead_ends.pop() {
            if self.state.live(vertex) != 0 {
                return Some(vertex);
            }
        }
        self.input_cursor = self.state.first_live(self.input_cursor)?;
        Some(self.input_cursor)
    }

    /// The candidate of least cost, ties to the oldest; `None` if there is no candidate.
    #[inline]
    fn cheapest<const NOISE: bool>(&mut self) -> Option<u32> {
        if NOISE {
            self.random = next_random(self.random);
        }
        let start = (self.random >> 40) as usize % (self.noises.len() - MAX_CANDIDATES);
        let noises = &self.noises[start..start + MAX_CANDIDATES];

        let mut best = 0;
        let mut least = i64::MAX;
        let most = self.settings.horizon.candidates;
        let count = self.state.candidates(most, |i, candidate| {
            let noise = if NOISE { noises[i % MAX_CANDIDATES] } else { 0 };
            let cost = self.cost(&candidate) + noise;
            let is_better = cost < least;
            best = select_unpredictable(is_better, candidate.vertex, best);
            least = select_unpredictable(is_better, cost, least);
        });
        (count != 0).then_some(best)
    }

    /// What it costs to finish a candidate next, in 1024ths of a push.
    #[inline]
    fn cost(&self, candidate: &Candidate) -> i64 {
        let weights = &self.settings.weights;
        let [missing, missing_second] = candidate.missing.map(i64::from);
        let mut cost = weights.missing[0] * missing - weights.live * i64::from(candidate.live);
        if CACHES > 1 {
            cost += weights.missing[1] * missing_second;
        }

        // Inside, it may leave before its neighbours are there; outside, it is a miss already.
        let age = i64::from(candidate.age);
        let is_late = candidate.age + candidate.missing[0] > self.settings.first.size;
        let inside = select_unpredictable(is_late, weights.late, 0) - weights.age * age;
        let outside = weights.outside - weights.outside_age * age;
        cost + select_unpredictable(candidate.is_inside, inside, outside)
    }
}

/// The next number of a linear congruential generator modulo 2^64 (Knuth's multiplier); its high
/// bits are the good ones.
#[inline]
fn next_random(random: u64) -> u64 {
    random
        .wrapping_mul(0x5851_f42d_4c95_7f2d)
        .wrapping_add(0x1405_7b7e_f767_814f)
}
