//! Bits whose chances are mixed from several.

use super::logistic::{LogOdds, ONE, chance};
use super::rans::{Lane, Port};

/// How likely each of two bits is set, by those that came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BitChances {
    /// In parts of 65,536.
    chances: [u16; 2],
    /// How many came, as far as that changes a step.
    seen: [u8; 2],
}

/// How far a chance moves, in parts of 65,536, by the number of bits that came.
static STEPS: [u16; 255] = {
    let mut steps = [0; 255];
    let mut seen = 0;
    while seen < steps.len() {
        #[expect(clippy::cast_possible_truncation, reason = "below 65,536")]
        let step = (131_072 / (2 * seen + 3)) as u16;
        steps[seen] = step;
        seen += 1;
    }
    steps
};

impl BitChances {
    pub(crate) const EVEN: Self = Self {
        chances: [1 << 15; 2],
        seen: [0; 2],
    };

    #[inline]
    fn see(&mut self, which: usize, is_set: bool) {
        let goal = if is_set { ONE - 1 } else { 0 };
        let seen = &mut self.seen[which];
        let step = i32::from(STEPS[usize::from(*seen)]);
        *seen += u8::from(usize::from(*seen) + 1 < STEPS.len());
        let chance = i32::from(self.chances[which]);
        let moved = chance + (((goal - chance) * (step >> 1)) >> 15);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between the chance and the goal"
        )]
        let moved = moved as u16;
        self.chances[which] = moved;
    }
}

/// How much each of several chances says, in parts of 65,536.
pub(crate) type Weights<const N: usize> = [i32; N];

/// Each says a little more than its share, as chances by few bits are careful.
pub(crate) const fn even_weights<const N: usize>() -> Weights<N> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "below 78,001"
    )]
    let each = (78_000 / N) as i32;
    [each; N]
}

/// How slowly weights change.
const RATE: u32 = 16;

/// Reads or writes a bit, by the sum of weighted log-odds of some chances; these and the weights learn from it.
#[inline]
pub(crate) fn code_mixed<const N: usize>(
    port: &mut impl Port,
    lane: Lane,
    log_odds: &LogOdds,
    chances: &mut [&mut BitChances; N],
    which: usize,
    weights: &mut Weights<N>,
    is_set: bool,
) -> bool {
    // The chance.
    let mut odds = [0; N];
    let mut sum = 0;
    for input in 0..N {
        odds[input] = log_odds.of(chances[input].chances[which]);
        sum = i32::wrapping_add(sum, odds[input].wrapping_mul(weights[input]));
    }
    let mixed = chance(sum >> 16);
    let is_set = port.bit(lane, mixed.clamp(2, ONE - 2).unsigned_abs() >> 1, is_set);

    // What was learnt.
    let goal = if is_set { ONE } else { 0 };
    let error = goal - mixed;
    for input in 0..N {
        let step = (odds[input] * error + (1 << 15)) >> RATE;
        weights[input] = weights[input].wrapping_add(step);
        chances[input].see(which, is_set);
    }
    is_set
}

#[cfg(test)]
mod tests {
    use super::super::{RansDecoder, RansEncoder};
    use super::*;
    use crate::random::SplitMix64;

    const BITS: usize = 20_000;
    /// Rarely set where the first chance says so, mostly where the second does.
    fn bits() -> Vec<([usize; 2], bool)> {
        let mut random = SplitMix64(1);
        let bit = |_| {
            let places = [random.below(2), random.below(2)];
            let chance = [2, 50, 50, 98][places[0] + 2 * places[1]];
            (places, random.below(100) < chance)
        };
        (0..BITS).map(bit).collect()
    }

    fn coded(port: &mut impl Port, bits: &[([usize; 2], bool)]) -> Vec<bool> {
        let mut chances = [[BitChances::EVEN; 2]; 2];
        let (log_odds, mut weights) = (LogOdds::new(), even_weights());
        let code = |&(places, is_set): &([usize; 2], bool)| {
            let [a, b] = &mut chances;
            let mut chosen = [&mut a[places[0]], &mut b[places[1]]];
            code_mixed(
                port,
                Lane::ALL[0],
                &log_odds,
                &mut chosen,
                1,
                &mut weights,
                is_set,
            )
        };
        bits.iter().map(code).collect()
    }

    #[test]
    fn bits_come_back_and_two_chances_say_more_than_one() {
        let bits = bits();
        let mut encoder = RansEncoder::new(1);
        coded(&mut encoder, &bits);
        let bytes = encoder.finish();

        let mut decoder = RansDecoder::new(1);
        decoder.begin(&bytes);
        let unknown: Vec<_> = bits.iter().map(|&(places, _)| (places, false)).collect();
        let decoded = coded(&mut decoder, &unknown);
        decoder.finish().unwrap();
        assert!(
            decoded
                .iter()
                .zip(&bits)
                .all(|(read, (_, bit))| read == bit)
        );

        // The entropy is .57 bits; with one chance alone, .83.
        let per_bit = 8.0 * bytes.len() as f64 / BITS as f64;
        assert!(per_bit < 0.62, "{per_bit}");
    }
}
