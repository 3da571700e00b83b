//! How far vertices are from what is drawn, in tolerances.

use std::cmp::Ordering;

use serde_json::{Value, json};

/// The errors of vertices on the screen, in tolerances: 1 is as far off as was allowed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct PixelErrors {
    /// How many vertices were measured.
    pub seen: usize,
    /// How many of them are at most one tolerance off.
    pub within: usize,
    /// What 99.9 % of them are at most off; 0 if there is none.
    pub p999: f64,
    /// How far the worst is off; 0 if there is none, infinite if nothing is drawn.
    pub worst: f64,
}

impl PixelErrors {
    /// How many of 100 are at most one tolerance off; 100 if there is none.
    #[must_use]
    pub fn share(&self) -> f64 {
        match self.seen {
            0 => 100.0,
            seen => 100.0 * self.within as f64 / seen as f64,
        }
    }

    pub(in crate::operations) fn json(&self) -> Value {
        json!({
            "seen": self.seen,
            "within": self.within,
            "share": self.share(),
            "p999": self.p999,
            "worst": self.worst,
        })
    }
}

/// The errors of several frames: only those are kept that may be above 99.9 % of all.
#[derive(Debug)]
pub(in crate::operations) struct CollectedErrors {
    largest: Vec<f64>,
    /// How many may be needed.
    most: usize,
    seen: usize,
    within: usize,
}

impl CollectedErrors {
    /// For a number of errors at most.
    pub(in crate::operations) fn new(limit: usize) -> Self {
        Self {
            largest: Vec::new(),
            most: rank(limit) + 1,
            seen: 0,
            within: 0,
        }
    }

    pub(in crate::operations) fn extend(&mut self, errors: &[f64]) {
        self.seen += errors.len();
        self.within += errors.iter().filter(|&&error| error <= 1.0).count();
        self.largest.extend(errors);
        if self.largest.len() > self.most {
            self.largest.select_nth_unstable_by(self.most, descending);
            self.largest.truncate(self.most);
        }
    }

    pub(in crate::operations) fn summary(mut self) -> PixelErrors {
        self.largest.sort_unstable_by(descending);
        let at = |place: usize| self.largest.get(place).copied().unwrap_or_default();
        PixelErrors {
            seen: self.seen,
            within: self.within,
            p999: at(rank(self.seen)),
            worst: at(0),
        }
    }
}

/// How many of a number are above 99.9 % of them.
fn rank(count: usize) -> usize {
    count / 1000
}

fn descending(a: &f64, b: &f64) -> Ordering {
    b.total_cmp(a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn of_thousands_the_thousandth_part_is_above() {
        let mut random = SplitMix64(1);
        for count in [0, 1, 999, 1000, 1001, 5432, 20_000] {
            let errors: Vec<f64> = (0..count)
                .map(|_| random.below(4000) as f64 / 3000.0)
                .collect();
            let mut sorted = errors.clone();
            sorted.sort_by(f64::total_cmp);

            // In parts, for a limit that is not reached.
            let mut found = CollectedErrors::new(count + 700);
            errors.chunks(777).for_each(|part| found.extend(part));
            let found = found.summary();
            assert_eq!(
                (found.seen, found.worst),
                (count, sorted.last().copied().unwrap_or(0.0))
            );
            let within = errors.iter().filter(|&&it| it <= 1.0).count();
            assert_eq!(found.within, within);
            // The least that is not below 99.9 % of all.
            let is_enough = |&&it: &&f64| {
                let below = sorted.iter().filter(|&&other| other <= it).count();
                1000 * below >= 999 * count
            };
            assert_eq!(
                found.p999,
                sorted.iter().find(is_enough).copied().unwrap_or(0.0)
            );
        }
        assert_eq!(CollectedErrors::new(0).summary().share(), 100.0);
    }
}
