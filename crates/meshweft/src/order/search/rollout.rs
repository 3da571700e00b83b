//! The loop: run some continuations, keep the best one's beginning.

use std::hint::select_unpredictable;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::mask::Mask;
use super::preset::Preset;
use super::state::{State, WINDOWS};
use crate::order::greedy::HUB;

/// Weights of a candidate's cost, in 1024ths of a push.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    /// A vertex that is missing from each cache.
    pub(super) missing: [i64; 2],
    /// A face drawn; the more, the cheaper.
    pub(super) live: i64,
    /// A push since it entered the first cache; the more, the cheaper.
    pub(super) age: i64,
    /// Leaving the first cache before it is finished.
    pub(super) late: i64,
    /// Having left the first cache.
    pub(super) outside: i64,
    /// A push since it entered the first cache, if it has left it.
    pub(super) outside_age: i64,
}

/// What a continuation is judged by, in 1024ths of an eviction; less is better.
#[derive(Debug, Clone, Copy)]
pub(super) struct Score {
    /// A vertex that leaves each cache unfinished.
    pub(super) exits: [i64; 2],
    /// A vertex that leaves a longer window unfinished.
    pub(super) windows: [i64; WINDOWS],
    /// A face drawn.
    pub(super) face: i64,
    /// A push since each vertex entered that is a candidate in the end.
    pub(super) age: i64,
}

/// How far and how often to look ahead.
#[derive(Debug, Clone, Copy)]
pub(super) struct Horizon {
    /// Continuations.
    pub(super) runs: usize,
    /// Vertices finished in each.
    pub(super) steps: usize,
    /// Vertices of the best that are finished for good.
    pub(super) commit: usize,
    /// Most candidates looked at, the oldest first.
    pub(super) candidates: u32,
    /// Span of the noise on a candidate's cost, in 1024ths of a push.
    pub(super) noise: i64,
    /// A run that is this much behind the best after `patience` steps or more is given up.
    pub(super) margin: i64,
    pub(super) patience: usize,
}

/// The time that a search may take, shared by its parts.
pub(super) struct Budget {
    pub(super) start: Instant,
    pub(super) time: Duration,
    pub(super) faces: usize,
    pub(super) done: AtomicUsize,
}

impl Budget {
    /// Counts faces as done, and says how many continuations there is time for from now on.
    fn runs(&self, newly_done: usize, runs: usize) -> usize {
        let done = self.done.fetch_add(newly_done, Ordering::Relaxed) + newly_done;
        let share_of_faces = done as f64 / self.faces as f64;
        let share_of_time = self.start.elapsed().as_secs_f64() / self.time.as_secs_f64();
        if share_of_time > share_of_faces {
            (runs * 3 / 4).max(1)
        } else {
            (runs + 1 + runs / 8).min(4096)
        }
    }
}

/// Most random numbers that noise is taken from.
const NOISES: usize = 4096;
/// Most candidates of any window.
const MAX_CANDIDATES: usize = 128;

pub(super) struct Rollouts<'a, M, const CACHES: usize> {
    state: State<'a, M, CACHES>,
    preset: &'a Preset,
    random: u64,
    noises: Vec<i64>,
    /// No vertex before this one is untouched.
    untouched: u32,
}

/// A continuation: whose faces it draws, and its score after each of them.
#[derive(Default)]
struct Run {
    path: Vec<u32>,
    marks: Vec<i64>,
}

impl<'a, M: Mask, const CACHES: usize> Rollouts<'a, M, CACHES> {
    pub(super) fn new(state: State<'a, M, CACHES>, preset: &'a Preset, seed: u64) -> Self {
        let mut random = seed.wrapping_add(1);
        // Many meshes are tiny: no more lots for them than they can draw.
        let lots = (8 * state.face_count()).clamp(1, NOISES);
        let noises = (0..lots + MAX_CANDIDATES).map(|_| {
            random = next_random(random);
            ((random >> 32).cast_signed() * preset.horizon.noise) >> 32
        });
        Self {
            noises: noises.collect(),
            state,
            preset,
            random,
            untouched: 0,
        }
    }

    /// Draws all faces.
    pub(super) fn run(mut self, budget: Option<&Budget>) -> State<'a, M, CACHES> {
        let horizon = self.preset.horizon;
        let (mut winner, mut spare) = (Run::default(), Run::default());
        let mut runs = horizon.runs;
        let mut counted = 0;
        loop {
            if let Some(budget) = budget {
                let done = self.state.new_to_old.len();
                runs = budget.runs(done - counted, runs);
                counted = done;
            }
            if !self.state.has_candidates() {
                winner.path.clear();
                let Some(focus) = self.after_dead_end() else {
                    return self.state;
                };
                self.state.draw::<false>(focus);
            } else if runs == 1 {
                winner.path.clear();
                if let Some(focus) = self.cheapest::<false>() {
                    self.state.draw::<false>(focus);
                }
            } else {
                let is_drawn = self.best_of(runs, &mut winner, &mut spare);
                let commit = horizon.commit.clamp(1, winner.path.len());
                for focus in winner.path.drain(..commit) {
                    if !is_drawn {
                        self.state.draw::<false>(focus);
                    }
                }
            }
        }
    }

    /// Runs continuations from here; `winner`, which holds what is left of the last winner, becomes
    /// the best of them. Whether it is drawn already: the last one is not taken back if it wins and
    /// is to be drawn as a whole.
    fn best_of(&mut self, runs: usize, winner: &mut Run, spare: &mut Run) -> bool {
        let horizon = self.preset.horizon;
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
                    // Too long to be run again and again: whoever comes to it stops there.
                    is_whole = false;
                    break;
                }
                self.state.draw::<true>(focus);
                let mark = self.mark(saved.drawn);
                spare.marks.push(mark);
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

    /// The score since `drawn` faces were drawn.
    #[inline]
    fn mark(&self, drawn: usize) -> i64 {
        let score = &self.preset.score;
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

    /// What the candidates that are left add to the score: the older, the sooner they are evicted.
    fn aging(&self) -> i64 {
        let mut ages = 0;
        if self.preset.score.age != 0 {
            self.state
                .candidates(u32::MAX, |_, candidate| ages += i64::from(candidate.age));
        }
        ages * self.preset.score.age
    }

    /// Where to go on when no candidate is left: the vertex that was the last to leave unfinished,
    /// else the first untouched one; `None` if all faces are drawn.
    fn after_dead_end(&mut self) -> Option<u32> {
        while let Some(vertex) = self.state.left.pop() {
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
        let (weights, size) = (&self.preset.weights, self.preset.first.size);
        let mut best = 0;
        let mut least = i64::MAX;
        let most = self.preset.horizon.candidates;
        let count = self.state.candidates(most, |i, candidate| {
            let [missing, beside] = candidate.missing.map(i64::from);
            let mut cost = weights.missing[0] * missing - weights.live * i64::from(candidate.live);
            if CACHES > 1 {
                cost += weights.missing[1] * beside;
            }
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
