//! Points waiting to be removed, by what that costs.

use super::remaining::NONE;

/// Buckets of points, one an octave of cost. A bucket is emptied in rounds, each in the order of the
/// points' numbers: near ones one after the other, whatever their costs.
#[derive(Debug)]
pub(super) struct RemovalQueue {
    buckets: Vec<Vec<u32>>,
    current: usize,
    /// The points of this round, and how many of them were taken.
    round: Vec<u32>,
    taken: usize,
    is_waiting: Vec<bool>,
}

/// The exponents of `f32`, without a sign.
const BUCKETS: usize = 256;

impl RemovalQueue {
    pub(super) fn new(points: usize) -> Self {
        Self {
            buckets: vec![Vec::new(); BUCKETS],
            current: 0,
            round: Vec::new(),
            taken: 0,
            is_waiting: vec![false; points],
        }
    }

    /// Whether a point is waiting.
    pub(super) fn has(&self, point: u32) -> bool {
        self.is_waiting[point as usize]
    }

    /// Whether a cost is beyond the bucket that is being emptied.
    pub(super) fn is_later(&self, cost: f32) -> bool {
        bucket(cost) > self.current
    }

    /// A point waits for its turn: in the bucket of its cost, or in the current one if that is past.
    pub(super) fn push(&mut self, point: u32, cost: f32) {
        debug_assert!(!self.has(point), "a point waits once");
        self.is_waiting[point as usize] = true;
        self.buckets[bucket(cost).max(self.current)].push(point);
    }

    /// The next point, which waits no more.
    pub(super) fn pop(&mut self) -> Option<u32> {
        while self.taken == self.round.len() {
            let waiting = self.buckets[self.current..]
                .iter()
                .position(|bucket| !bucket.is_empty())?;
            self.current += waiting;
            self.round.clear();
            self.taken = 0;
            std::mem::swap(&mut self.round, &mut self.buckets[self.current]);
            self.round.sort_unstable();
        }
        let point = self.round[self.taken];
        self.taken += 1;
        debug_assert_ne!(point, NONE);
        self.is_waiting[point as usize] = false;
        Some(point)
    }
}

/// The octave of a cost that is not negative.
fn bucket(cost: f32) -> usize {
    debug_assert!(cost >= 0.0, "{cost}");
    (cost.to_bits() >> 23) as usize & (BUCKETS - 1)
}
