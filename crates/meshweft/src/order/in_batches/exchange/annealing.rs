//! Faces moved between neighbouring parts, at random, and less and less uphill.
//!
//! S. Kirkpatrick, C. Gelatt, M. Vecchi: *Optimization by Simulated Annealing*, 1983,
//! doi:10.1126/science.220.4598.671. A move costs the vertices that it adds to all parts together, and
//! what it takes both parts from their size. A part of another size is allowed on the way: an exchange
//! of two faces is two moves, of which the first may cost more than both together.

use super::parts::Parts;
use crate::progress::Progress;
use crate::random::SplitMix64;

/// A vertex in the unit of costs.
const VERTEX: i32 = 16;
/// The same, for the arithmetic of temperatures.
const UNITS: u64 = VERTEX.unsigned_abs() as u64;
/// No move costs as much.
const MOST: usize = 8 * VERTEX as usize;
/// The temperature at which a vertex costs 1.
const ONE: u64 = 1 << 16;
/// The probability 1.
const ONE_IN_32_BITS: u64 = 1 << 32;

/// How long to look, and how far uphill.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::order) struct Annealing {
    /// How often each face may move.
    pub(in crate::order) sweeps: u32,
    /// The temperature at first and in the end, in 65536ths of a vertex. A move that costs as much is
    /// made with probability 1/e.
    pub(in crate::order) temperatures: [u32; 2],
    /// The cost of a part that has a face too many or too few, in 16ths of a vertex; of `n` faces `n²` times
    /// as much.
    pub(in crate::order) size: i32,
}

impl Annealing {
    /// Moves faces of the parts, none of which then has more than three faces too many or too few; the
    /// caller is asked before each sweep whether to go on.
    ///
    /// Time O(sweeps · faces).
    pub(super) fn run(&self, parts: &mut Parts<'_>, seed: u64, progress: &dyn Progress) {
        let mut random = SplitMix64(seed);
        let faces = parts.movable().to_vec();
        for sweep in 0..self.sweeps {
            let is_late = progress.time_spent().is_some_and(|share| share >= 1.0);
            if is_late || progress.report(1.0).is_break() {
                return;
            }
            let chances = chances(self.temperature(sweep));
            for &face in &faces {
                let random = random.next();
                #[expect(clippy::cast_possible_truncation, reason = "its two halves")]
                let (low, high) = (random as u32, (random >> 32) as u32);
                let Some(to) = parts.neighbour(face, low) else {
                    continue;
                };

                // The parts keep near their size.
                let from = usize::from(parts.part(face));
                let excess = [from, usize::from(to)].map(|part| parts.excess()[part]);
                if excess[0] <= -MOST_EXCESS || excess[1] >= MOST_EXCESS {
                    continue;
                }
                let Some(change) = parts.change(face, to) else {
                    continue;
                };
                let cost = VERTEX * change.added() + 2 * self.size * (excess[1] - excess[0] + 1);
                let is_taken = match usize::try_from(cost) {
                    Ok(cost @ 1..) => high < chances.get(cost).copied().unwrap_or(0),
                    _ => true,
                };
                if is_taken {
                    parts.shift(face, to);
                }
            }
        }
    }

    /// The temperature of a sweep, from the first to the last in equal steps.
    fn temperature(&self, sweep: u32) -> u32 {
        let [first, last] = self.temperatures.map(u64::from);
        let [sweep, sweeps] = [sweep, (self.sweeps - 1).max(1)].map(u64::from);
        let sum = first * (sweeps - sweep) + last * sweep;
        u32::try_from(sum / sweeps).unwrap_or(u32::MAX)
    }
}

/// Most faces that a part has too many or too few while faces move.
const MOST_EXCESS: i32 = 3;

/// The probability of a move by its cost, in 2⁻³².
fn chances(temperature: u32) -> [u32; MOST] {
    // For the lowest cost, e to the minus that: 1 - 1/n to the n-th for a large n, a power of two.
    const SQUARINGS: u32 = 12;
    let exponent = (ONE << 32) / (u64::from(temperature.max(1)) * UNITS);
    let mut least = ONE_IN_32_BITS.saturating_sub((exponent >> SQUARINGS).max(1));
    for _ in 0..SQUARINGS {
        least = (least * least) >> 32;
    }

    // For others powers of that.
    let mut chances = [u32::MAX; MOST];
    let mut chance = ONE_IN_32_BITS;
    for entry in &mut chances[1..] {
        chance = (chance * least) >> 32;
        *entry = u32::try_from(chance).unwrap_or(u32::MAX);
    }
    chances
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chances_are_those_of_boltzmann() {
        for temperature in [3000, 6500, 14_000, 65_536] {
            let chances = chances(temperature);
            for cost in [1, 4, 8, 16, 32] {
                let exponent = f64::from(cost) / 16.0 * 65_536.0 / f64::from(temperature);
                let found = f64::from(chances[cost as usize]) / 2_f64.powi(32);
                let difference = (found - (-exponent).exp()).abs();
                assert!(difference < 0.003, "{temperature}, {cost}: {found}");
            }
        }
    }
}
