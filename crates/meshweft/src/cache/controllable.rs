//! A cache whose evictions the program decides: schedules, and the best schedule for an order.
//!
//! Misses are counted in two ways. *Scheduled*: the pushes of an explicit schedule, which an
//! algorithm writes without knowing the future. *Belady*: the fewest pushes that any schedule needs
//! for a given face order (L. A. Belady, *A study of replacement algorithms for a virtual-storage
//! computer*, 1966, doi:10.1147/sj.52.0078): evict the vertex that is needed last, never one of the
//! face being drawn, whose three vertices must be in the cache together. Belady is never more than
//! scheduled.

use std::collections::BTreeSet;
use std::fmt;

use super::model::MIN_CACHE_SIZE;
use crate::faces::Faces;
use crate::index::index32;
use crate::topology::distinct;

/// The next use of a vertex that is not needed again.
const NEVER: u32 = u32::MAX;

/// Draws the faces by the best schedule: calls `visit(face number, misses)` for each face, and
/// `record` for each step.
///
/// Time O(faces · log size), space 12 bytes a face, 8 a vertex and the buffer.
pub(super) fn belady(
    faces: Faces<'_>,
    size: u32,
    mut visit: impl FnMut(usize, u8),
    mut record: impl FnMut(CacheEvent),
) {
    let (faces, vertex_count) = (faces.as_slice(), faces.vertex_count());

    // For each corner, the next face that names the same vertex.
    let mut next_use = vec![[NEVER; 3]; faces.len()];
    let mut coming = vec![NEVER; vertex_count];
    for (number, face) in faces.iter().enumerate().rev() {
        next_use[number] = face.map(|v| coming[v as usize]);
        for &v in face {
            coming[v as usize] = index32(number);
        }
    }

    // The buffer, sorted by next use.
    let mut buffer: BTreeSet<(u32, u32)> = BTreeSet::new();
    for (number, &face) in faces.iter().enumerate() {
        let (mut missed, mut misses) = (0_u8, [0; 3]);
        for vertex in distinct(face) {
            // Taking the face's own vertices out protects them from eviction.
            let is_there = buffer.remove(&(index32(number), vertex));
            if !is_there {
                misses[usize::from(missed)] = vertex;
                missed += 1;
            }
        }

        // Make room: what is needed last leaves first.
        let kept = distinct(face).count();
        while buffer.len() + kept > size as usize {
            let Some((_, vertex)) = buffer.pop_last() else {
                break;
            };
            record(CacheEvent::Pop(vertex));
        }

        for &vertex in &misses[..usize::from(missed)] {
            record(CacheEvent::Push(vertex));
        }
        record(CacheEvent::Draw);

        // Back in the buffer, with the next use of each.
        for (vertex, next) in face.into_iter().zip(next_use[number]) {
            buffer.insert((next, vertex));
        }
        visit(number, missed);
    }
}

/// One step of a controllable cache.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CacheEvent {
    /// The vertex leaves the cache.
    Pop(u32),
    /// The vertex is transformed and enters the cache: a miss.
    Push(u32),
    /// The next face of the order is drawn; all its vertices are in the cache.
    Draw,
}

/// The steps of a controllable cache while a face order is drawn.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Schedule {
    /// The steps in order.
    pub events: Vec<CacheEvent>,
}

impl Schedule {
    /// The schedule that draws these faces in their order with the fewest pushes (Belady).
    ///
    /// ```
    /// use meshweft::{CacheModel, cache::{self, Schedule}};
    /// let fan: Vec<[u32; 3]> = (1..9).map(|i| [0, i, i + 1]).collect();
    /// let schedule = Schedule::fewest_pushes(&fan, 3);
    /// assert_eq!(schedule.play(&fan, 3), Ok(10));
    /// assert_eq!(cache::misses(&fan, CacheModel::controllable(3)), 10);
    /// ```
    ///
    /// # Panics
    /// If `size` is below 3: no face fits.
    ///
    /// # Complexity
    /// Time O(faces · log size), space 12 bytes a face and 8 a step.
    #[must_use]
    pub fn fewest_pushes<'a>(faces: impl Into<Faces<'a>>, size: u32) -> Self {
        assert!(size >= MIN_CACHE_SIZE, "a face needs three entries");
        let mut events = Vec::new();
        belady(faces.into(), size, |_, _| {}, |event| events.push(event));
        Self { events }
    }

    /// How many vertices are pushed.
    #[must_use]
    pub fn pushes(&self) -> u64 {
        let is_push = |event: &&CacheEvent| matches!(event, CacheEvent::Push(_));
        self.events.iter().filter(is_push).count() as u64
    }

    /// The number of pushes, after checking the schedule by playing it; `faces` are in the order in
    /// which it draws them.
    ///
    /// # Errors
    /// [`ScheduleError`] at the first step that a cache of `size` entries cannot do.
    ///
    /// # Complexity
    /// Time O(steps · log size), space O(size).
    pub fn play<'a>(&self, faces: impl Into<Faces<'a>>, size: u32) -> Result<u64, ScheduleError> {
        let faces = faces.into().as_slice();
        let mut buffer = BTreeSet::new();
        let mut drawn = 0;

        for (step, &event) in self.events.iter().enumerate() {
            let problem = match event {
                CacheEvent::Pop(vertex) if !buffer.remove(&vertex) => "pops an absent vertex",
                CacheEvent::Push(vertex) if !buffer.insert(vertex) => "pushes a vertex twice",
                CacheEvent::Push(_) if buffer.len() > size as usize => "overfills the cache",
                CacheEvent::Draw => match faces.get(drawn) {
                    None => "draws more faces than there are",
                    Some(face) if face.iter().any(|v| !buffer.contains(v)) => {
                        "draws a face before its vertices are there"
                    }
                    Some(_) => {
                        drawn += 1;
                        continue;
                    }
                },
                _ => continue,
            };
            return Err(ScheduleError { step, problem });
        }

        if drawn < faces.len() {
            return Err(ScheduleError {
                step: self.events.len(),
                problem: "ends before all faces are drawn",
            });
        }
        Ok(self.pushes())
    }
}

/// A step of a [`Schedule`] that cannot be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScheduleError {
    /// Number of the step, from 0.
    pub step: usize,
    /// What it does wrong, to be read after "the schedule".
    pub problem: &'static str,
}

impl fmt::Display for ScheduleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "step {} of the schedule {}", self.step, self.problem)
    }
}

impl std::error::Error for ScheduleError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// The fewest pushes over all schedules, by trying every set of survivors.
    fn fewest_pushes(faces: &[[u32; 3]], size: usize) -> u32 {
        use std::collections::BTreeMap;

        // For each set of vertices that may be in the cache, as bits, the fewest pushes so far.
        let mut states: BTreeMap<u32, u32> = BTreeMap::from([(0, 0)]);
        for face in faces {
            let needed = face.iter().fold(0_u32, |set, &v| set | 1 << v);
            let mut after: BTreeMap<u32, u32> = BTreeMap::new();
            for (&held, &pushes) in &states {
                let cost = pushes + (needed & !held).count_ones();
                let full = held | needed;

                // Every subset of the present vertices that keeps the face and fits.
                let mut kept = full;
                loop {
                    if kept & needed == needed && kept.count_ones() as usize <= size {
                        let best = after.entry(kept).or_insert(cost);
                        *best = cost.min(*best);
                    }
                    if kept == 0 {
                        break;
                    }
                    kept = (kept - 1) & full;
                }
            }
            states = after;
        }
        states.into_values().min().unwrap_or(0)
    }

    #[test]
    fn belady_is_the_minimum_over_all_schedules() {
        let mut numbers = SplitMix64(7);
        let mut random = |limit: usize| index32(numbers.below(limit));
        for round in 0..60 {
            let faces: Vec<[u32; 3]> = (0..10).map(|_| [random(8), random(8), random(8)]).collect();
            for size in 3..6 {
                let mut total = 0;
                belady(
                    (&faces).into(),
                    size,
                    |_, missed| total += u32::from(missed),
                    |_| {},
                );
                assert_eq!(total, fewest_pushes(&faces, size as usize), "round {round}");
            }
        }
    }

    #[test]
    fn a_schedule_is_held_to_the_cache() {
        use CacheEvent::{Draw, Pop, Push};
        let faces = [[0, 1, 2], [2, 1, 3]];
        let play = |events: &[CacheEvent]| {
            let events = events.to_vec();
            Schedule { events }.play(&faces, 3)
        };
        let good = [Push(0), Push(1), Push(2), Draw, Pop(0), Push(3), Draw];
        assert_eq!(play(&good), Ok(4));
        let full = [Push(0), Push(1), Push(2), Draw, Push(3), Draw];
        assert_eq!(play(&full).unwrap_err().problem, "overfills the cache");
        let missing = [Push(0), Push(1), Draw];
        assert_eq!(play(&missing).unwrap_err().step, 2);
        assert!(play(&good[..4]).is_err());
        assert!(play(&[Pop(0)]).is_err());
        assert!(play(&[Push(0), Push(0)]).is_err());
    }
}
