//! The loop: run several continuations, commit the beginning of the best one.
//!
//! A *continuation* ([`Rollout`]) is a list of focus vertices. It is run by drawing them with
//! `UNDO` and taken back afterwards. What is *committed* is drawn without `UNDO` and stays. The
//! tail of the best continuation is run again as the first one of the next round.

use std::hint::select_unpredictable;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::mask::Mask;
use super::settings::Settings;
use super::state::State;
use crate::order::greedy::HUB;
use crate::progress::Progress;

/// Progress of a search, shared by all its parts.
pub(super) struct Caller<'a> {
    pub(super) progress: &'a dyn Progress,
    /// Faces of all parts.
    pub(super) faces: usize,
    /// How many of them are drawn.
    pub(super) drawn: AtomicUsize,
    /// Whether the caller wants it to stop: all parts then do.
    pub(super) is_stopped: AtomicBool,
}

/// How often an untimed search reports, in faces: often enough to stop without delay, too seldom to
/// cost time.
const HEARD_EVERY: usize = 1 << 10;

/// How much a part may still look ahead.
#[derive(Debug, Clone, Copy)]
struct Pace {
    /// Continuations in each round.
    runs: usize,
    /// How many rounds are left.
    steps: u64,
    /// Whether `runs` follows the time spent.
    is_timed: bool,
    /// How many faces were drawn at the last report.
    heard: usize,
}

impl Pace {
    /// Tells the caller that `drawn` faces of the part are drawn, now and then, and does as it says.
    fn keep(&mut self, drawn: usize, caller: &Caller<'_>) {
        if drawn - self.heard >= HEARD_EVERY || self.is_timed {
            self.tell(drawn, caller);
        }
    }

    fn tell(&mut self, drawn: usize, caller: &Caller<'_>) {
        let newly_drawn = drawn - self.heard;
        self.heard = drawn;
        let drawn = caller.drawn.fetch_add(newly_drawn, Ordering::Relaxed) + newly_drawn;
        let share_of_faces = drawn as f64 / caller.faces.max(1) as f64;

        if caller.progress.report(share_of_faces).is_break() {
            caller.is_stopped.store(true, Ordering::Relaxed);
        }

        if caller.is_stopped.load(Ordering::Relaxed) {
            self.steps = 0;
        } else if let Some(share_of_time) = caller.progress.time_spent() {
            self.runs = match share_of_time > share_of_faces {
                true => (self.runs * 3 / 4).max(1),
                false => (self.runs + 1 + self.runs / 8).min(4096),
            };
        }
    }
}

/// Most places in the list of noises that a choice may start from.
const NOISES: usize = 4096;
/// Most candidates of any window.
const MAX_CANDIDATES: usize = 128;

/// A search over one part of the mesh.
pub(super) struct Rollouts<'a, M, const CACHES: usize> {
    state: State<'a, M, CACHES>,
    settings: &'a Settings,
    random: u64,
    /// Noise for the costs. Each choice takes consecutive ones from a random place: one random
    /// number a choice instead of one a candidate.
    noises: Vec<i64>,
    /// No vertex before this one has faces left.
    untouched: u32,
}

/// A continuation.
#[derive(Default)]
struct Rollout {
    /// The focus vertices, in order.
    path: Vec<u32>,
    /// The score after each of them.
    marks: Vec<i64>,
}

impl<'a, M: Mask, const CACHES: usize> Rollouts<'a, M, CACHES> {
    pub(super) fn new(state: State<'a, M, CACHES>, settings: &'a Settings, seed: u64) -> Self {
        let mut random = seed.wrapping_add(1);
        // Many meshes are tiny: no more noise for them than they can use.
        let lots = (8 * state.face_count()).clamp(1, NOISES);
        let noises = (0..lots + MAX_CANDIDATES).map(|_| {
            random = next_random(random);
            ((random >> 32).cast_signed() * settings.horizon.noise) >> 32
        });
        Self {
            noises: noises.collect(),
            state,
            settings,
            random,
            untouched: 0,
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
            heard: 0,
        };

        loop {
            pace.keep(self.state.new_to_old.len(), caller);

            if !self.state.has_candidates() {
                // Dead end.
                winner.path.clear();
                let Some(focus) = self.after_dead_end() else {
                    pace.tell(self.state.new_to_old.len(), caller);
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
    /// `winner` comes in with the tail of the last round's winner. The first continuation repeats
    /// that tail and goes on without noise; the others start afresh, with noise. Each is recorded
    /// in `spare`. If it is better, the two are swapped: `winner` then has the new best, and
    /// `spare` the buffers for the next one. Each is drawn with `UNDO` and taken back, so the
    /// caller draws the part of `winner` that it commits again, without `UNDO`. One case saves
    /// that: the last continuation, if it wins and is to be committed as a whole, is kept as it is
    /// drawn (`true`).
    fn best_of(&mut self, runs: usize, winner: &mut Rollout, spare: &mut Rollout) -> bool {
        let horizon = self.settings.horizon;
        self.state.reset_exits();
        let saved = self.state.save();
        let mut best = i64::MAX;

        for number in 0..runs {
            let kept: &[u32] = if number == 0 { &winner.path } else { &[] };
            spare.path.clear();
            spare.marks.clear();
            self.state.begin();
            let (mut is_behind, mut is_whole) = (false, true);

            for step in 0..horizon.steps {
                let focus = match kept.get(step) {
                    Some(&focus) => Some(focus),
                    None if number == 0 => self.cheapest::<false>(),
                    None => self.cheapest::<true>(),
                };
                let Some(focus) = focus else { break };
                spare.path.push(focus);
                if self.state.live(focus) > HUB {
                    // Too many faces to draw in each continuation: it ends before them.
                    is_whole = false;
                    break;
                }

                self.state.draw::<true>(focus);
                let mark = self.mark(saved.drawn);
                spare.marks.push(mark);

                // Give up on one that is far worse than the best was after as many steps.
                if number > 0 && step > horizon.patience {
                    let other = winner.marks.get(step).or(winner.marks.last());
                    is_behind = other.is_some_and(|other| mark > other + horizon.margin);
                    if is_behind {
                        break;
                    }
                }
            }

            if !is_behind {
                let score = self.mark(saved.drawn) + self.aging();
                if score < best {
                    best = score;
                    std::mem::swap(winner, spare);
                    // Nothing would be drawn differently by the caller: leave it.
                    if number + 1 == runs && is_whole && horizon.commit >= horizon.steps {
                        self.state.keep();
                        return true;
                    }
                }
            }
            self.state.undo(&saved);
        }
        false
    }

    /// The score of what was drawn after the first `drawn` faces.
    #[inline]
    fn mark(&self, drawn: usize) -> i64 {
        let score = &self.settings.score;
        let faces = self.state.new_to_old.len() - drawn;
        let mut mark = -score.face * faces as i64;
        for (cache, weight) in self.state.caches.iter().zip(score.exits) {
            mark += weight * i64::from(cache.exits);
        }
        if CACHES > 1 {
            for (&exits, weight) in self.state.window_exits.iter().zip(score.windows) {
                mark += weight * i64::from(exits);
            }
        }
        mark
    }

    /// What the remaining candidates add to the score: the older, the sooner they are evicted.
    fn aging(&self) -> i64 {
        let mut ages = 0;
        if self.settings.score.age != 0 {
            self.state
                .candidates(u32::MAX, |_, candidate| ages += i64::from(candidate.age));
        }
        ages * self.settings.score.age
    }

    /// The next focus when no candidate is left: the last vertex that left unfinished, else the
    /// first in file order that has faces left; `None` if all faces are drawn.
    fn after_dead_end(&mut self) -> Option<u32> {
        while let Some(vertex) = self.state.dead_ends.pop() {
            if self.state.live(vertex) != 0 {
                return Some(vertex);
            }
        }
        self.untouched = self.state.first_live(self.untouched)?;
        Some(self.untouched)
    }

    /// The candidate of least cost, ties to the oldest.
    #[inline]
    fn cheapest<const NOISE: bool>(&mut self) -> Option<u32> {
        if NOISE {
            self.random = next_random(self.random);
        }
        let offset = (self.random >> 40) as usize % (self.noises.len() - MAX_CANDIDATES);
        let noises = &self.noises[offset..offset + MAX_CANDIDATES];

        let (weights, size) = (&self.settings.weights, self.settings.first.size);
        let mut best = 0;
        let mut least = i64::MAX;
        let most = self.settings.horizon.candidates;
        let count = self.state.candidates(most, |i, candidate| {
            let [missing, missing_second] = candidate.missing.map(i64::from);
            let mut cost = weights.missing[0] * missing - weights.live * i64::from(candidate.live);
            if CACHES > 1 {
                cost += weights.missing[1] * missing_second;
            }

            // Inside, it may leave before its neighbours are there; outside, it is a miss already.
            let age = i64::from(candidate.age);
            let is_late = candidate.age + candidate.missing[0] > size;
            let inside = select_unpredictable(is_late, weights.late, 0) - weights.age * age;
            let outside = weights.outside - weights.outside_age * age;
            cost += select_unpredictable(candidate.is_inside, inside, outside);
            if NOISE {
                cost += noises[i % MAX_CANDIDATES];
            }

            let is_better = cost < least;
            best = select_unpredictable(is_better, candidate.vertex, best);
            least = select_unpredictable(is_better, cost, least);
        });
        (count != 0).then_some(best)
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
