//! Numbers of any size as symbols and bits.

use super::adaptive_table::{AdaptiveTable, SYMBOLS};
use super::rans::{Lane, Port};

/// The last symbol: this many bits or more.
const MOST: u32 = {
    assert!(SYMBOLS == 16);
    15
};

/// Numbers are coded in the first lane.
const LANE: Lane = Lane::ALL[0];

/// Codes numbers that are often small: how many bits they have by a table, then the bits below the highest.
#[derive(Debug, Clone)]
pub(crate) struct NumberCoder {
    /// How many bits.
    lengths: AdaptiveTable,
    /// How many beyond the last symbol.
    more: AdaptiveTable,
}

impl NumberCoder {
    pub(crate) const NEW: Self = Self {
        lengths: AdaptiveTable::EVEN,
        more: AdaptiveTable::EVEN,
    };

    /// The number that was read, or the one that was given.
    #[inline]
    pub(crate) fn code(&mut self, port: &mut impl Port, number: u32) -> u32 {
        // How many bits it has.
        let mut length = u32::BITS - number.leading_zeros();
        let symbol = port.code(LANE, &self.lengths, length.min(MOST) as usize);
        self.lengths.see(symbol);
        length = match bits_of(symbol) {
            MOST => MOST + code_more(port, LANE, &mut self.more, length.wrapping_sub(MOST)),
            length => length,
        };

        if length == 0 {
            return 0;
        }
        let rest = number & ((1 << (length - 1)) - 1);
        let rest = port.bits(LANE, length - 1, rest.into());
        1 << (length - 1) | low_half(rest)
    }
}

/// The low half of some bits.
#[inline(always)]
pub(crate) fn low_half(bits: u64) -> u32 {
    #[expect(clippy::cast_possible_truncation, reason = "the low half")]
    let half = bits as u32;
    half
}

/// How many more bits than 15 a number has: up to 17.
#[cold]
pub(crate) fn code_more(
    port: &mut impl Port,
    lane: Lane,
    table: &mut AdaptiveTable,
    more: u32,
) -> u32 {
    let symbol = port.code(lane, table, more.min(MOST) as usize);
    table.see(symbol);
    match bits_of(symbol) {
        MOST => {
            let bits = port.bits(lane, 2, u64::from(more.wrapping_sub(MOST) & 3));
            (MOST + low_half(bits)).min(17)
        }
        more => more,
    }
}

/// A symbol as a number of bits.
fn bits_of(symbol: usize) -> u32 {
    u32::try_from(symbol).unwrap_or(MOST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bits::{RansDecoder, RansEncoder};
    use crate::random::SplitMix64;

    #[test]
    fn numbers_of_every_length_come_back() {
        let mut random = SplitMix64(1);
        let mut numbers = vec![0, 1, u32::MAX, u32::MAX >> 1, 1 << 30, 1 << 14, 1 << 15];
        for _ in 0..2000 {
            let [a, b, c, d, ..] = random.next().to_le_bytes();
            numbers.push(u32::from_le_bytes([a, b, c, d]) >> random.below(32));
        }
        let (mut encoder, mut coder) = (RansEncoder::new(1), NumberCoder::NEW);
        for &number in &numbers {
            assert_eq!(coder.code(&mut encoder, number), number);
        }
        let (mut decoder, mut coder) = (RansDecoder::new(1), NumberCoder::NEW);
        decoder.begin(&encoder.finish());
        for number in numbers {
            assert_eq!(coder.code(&mut decoder, 0), number);
        }
        decoder.finish().unwrap();
    }
}
