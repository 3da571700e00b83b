//! A bit whose chance follows what comes.

use super::rans::{Lane, Port};

/// How likely a bit is set, by those that came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AdaptiveBit {
    /// In parts of two to the power of [`PARTS`].
    chance: u32,
    /// How many bits came, as far as that changes a step.
    seen: u16,
}

/// More than a port can tell, so that a bit that always comes costs next to nothing.
const PARTS: u32 = 24;

/// A port tells chances apart in this many bits.
const TOLD: u32 = 15;

/// After more bits than this, older ones count less and less.
const MOST_SEEN: u16 = 510;

impl AdaptiveBit {
    pub(crate) const EVEN: Self = Self {
        chance: 1 << (PARTS - 1),
        seen: 0,
    };

    /// How many bits came, up to some hundreds.
    #[inline]
    pub(crate) fn seen(&self) -> u16 {
        self.seen
    }

    /// The bit that was read, or the one that was given. Nothing is learnt from it.
    #[inline]
    pub(crate) fn code(&self, port: &mut impl Port, lane: Lane, is_set: bool) -> bool {
        let chance = (self.chance >> (PARTS - TOLD)).clamp(1, (1 << TOLD) - 1);
        port.bit(lane, chance, is_set)
    }

    /// A bit came.
    #[inline]
    pub(crate) fn see(&mut self, is_set: bool) {
        // The part of the way to it that makes the chance the mean of all that came, and of a half.
        let step = (1 << 17) / (2 * u64::from(self.seen) + 3);
        let way = |far: u32| {
            u32::try_from((u64::from(far) * step) >> 16).expect("no more than the whole way")
        };
        match is_set {
            true => self.chance += way((1 << PARTS) - self.chance),
            false => self.chance -= way(self.chance),
        }
        self.seen = (self.seen + 1).min(MOST_SEEN);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{RansDecoder, RansEncoder};
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn bits_come_back_and_cost_their_entropy() {
        // Of 40, how many are set.
        for set in [0, 1, 20, 39, 40] {
            let mut random = SplitMix64(1);
            let bits: Vec<bool> = (0..20_000).map(|_| random.below(40) < set).collect();
            let count = |which: bool| bits.iter().filter(|&&bit| bit == which).count() as f64;
            let all = bits.len() as f64;
            let counts = [count(false), count(true)].into_iter();
            let entropy: f64 = counts
                .filter(|&count| count > 0.0)
                .map(|count| count * (all / count).log2())
                .sum();
            let (mut encoder, mut bit) = (RansEncoder::new(1), AdaptiveBit::EVEN);
            for &is_set in &bits {
                bit.code(&mut encoder, Lane::ALL[0], is_set);
                bit.see(is_set);
            }
            let bytes = encoder.finish();
            let most = entropy * 1.02 / 8.0 + 10.0;
            assert!((bytes.len() as f64) < most, "{set}: {}", bytes.len());

            let (mut decoder, mut bit) = (RansDecoder::new(1), AdaptiveBit::EVEN);
            decoder.begin(&bytes);
            for is_set in bits {
                assert_eq!(bit.code(&mut decoder, Lane::ALL[0], false), is_set);
                bit.see(is_set);
            }
            decoder.finish().unwrap();
        }
    }
}
