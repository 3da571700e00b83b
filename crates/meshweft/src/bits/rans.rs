//! Asymmetric numeral systems by ranges (J. Duda, *Asymmetric numeral systems*, arXiv:1311.2540, 2013): two
//! states in turn, words of 16 bits.
//!
//! What is read forwards is written backwards, so all symbols are collected first. Both states begin with
//! the same number when they are written, and must be back at it when everything is read.

use super::adaptive_table::{AdaptiveTable, Interval, PRECISION};
use super::error::{DecodeError, DecodeErrorKind};

/// States are at least this large.
const LEAST: u32 = 1 << 16;
/// States in turn.
const STATES: usize = 2;

/// Collects symbols, and writes them.
#[derive(Debug, Default)]
pub(crate) struct RansEncoder {
    intervals: Vec<(u16, u16)>,
}

impl RansEncoder {
    /// Takes a symbol, with its frequency in a table.
    #[inline]
    pub(crate) fn push(&mut self, table: &AdaptiveTable, symbol: usize) {
        let Interval { begin, frequency } = table.interval(symbol);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "below two to the power of 15"
        )]
        self.intervals.push((begin as u16, frequency as u16));
    }

    /// The bytes, in the order in which they are read.
    pub(crate) fn finish(self) -> Vec<u8> {
        #[expect(clippy::cast_possible_truncation, reason = "the low half of a state")]
        let low = |state: u32| state as u16;
        let mut states = [LEAST; STATES];
        let mut words: Vec<u16> = Vec::with_capacity(self.intervals.len() / 4 + 2 * STATES);
        for (turn, &(begin, frequency)) in self.intervals.iter().enumerate().rev() {
            let (begin, frequency) = (u32::from(begin), u32::from(frequency));
            let state = &mut states[turn % STATES];
            if u64::from(*state) >= u64::from(frequency) << (32 - PRECISION) {
                words.push(low(*state));
                *state >>= 16;
            }
            *state = ((*state / frequency) << PRECISION) + *state % frequency + begin;
        }
        for state in states.into_iter().rev() {
            words.extend([low(state), low(state >> 16)]);
        }
        let words = words.iter().rev();
        words.flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// Reads symbols.
#[derive(Debug, Clone)]
pub(crate) struct RansDecoder<'a> {
    /// The state whose turn it is first.
    states: [u32; STATES],
    words: std::slice::ChunksExact<'a, u8>,
    byte_count: usize,
    /// How many words were asked for that are not there.
    missing: u32,
}

impl<'a> RansDecoder<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let mut decoder = Self {
            states: [0; STATES],
            words: bytes.chunks_exact(2),
            byte_count: bytes.len(),
            missing: 0,
        };
        for state in 0..STATES {
            let high = decoder.word();
            decoder.states[state] = high << 16 | decoder.word();
        }
        decoder
    }

    #[inline]
    fn word(&mut self) -> u32 {
        match self.words.next() {
            Some(word) => u32::from(u16::from_le_bytes([word[0], word[1]])),
            None => {
                self.missing += 1;
                0
            }
        }
    }

    /// The next symbol, by its frequency in a table.
    #[inline]
    pub(crate) fn pop(&mut self, table: &AdaptiveTable) -> usize {
        let [state, other] = self.states;
        let number = state & ((1 << PRECISION) - 1);
        let symbol = table.symbol(number);
        let Interval { begin, frequency } = table.interval(symbol);
        let mut state = frequency * (state >> PRECISION) + number - begin;
        if state < LEAST {
            state = state << 16 | self.word();
        }
        self.states = [other, state];
        symbol
    }

    /// What is wrong at the place where it is now.
    #[cold]
    pub(crate) fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        let kind = if self.missing > 0 {
            DecodeErrorKind::EndsEarly
        } else {
            kind
        };
        DecodeError {
            byte: self.byte_count - self.words.len() * 2,
            kind,
        }
    }

    /// # Errors
    /// More was read than is there.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), DecodeError> {
        match self.missing {
            0 => Ok(()),
            _ => Err(self.error(DecodeErrorKind::EndsEarly)),
        }
    }

    /// # Errors
    /// Something is left, or what was read is not what was written.
    pub(crate) fn finish(self) -> Result<(), DecodeError> {
        self.check()?;
        let is_at_end = self.words.len() == 0 && self.byte_count.is_multiple_of(2);
        match is_at_end && self.states == [LEAST; STATES] {
            true => Ok(()),
            false => Err(self.error(DecodeErrorKind::Damaged)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::adaptive_table::SYMBOLS;
    use super::*;
    use crate::random::SplitMix64;

    fn coded(symbols: &[usize]) -> Vec<u8> {
        let (mut encoder, mut table) = (RansEncoder::default(), AdaptiveTable::EVEN);
        for &symbol in symbols {
            encoder.push(&table, symbol);
            table.see(symbol);
        }
        encoder.finish()
    }

    fn decoded(bytes: &[u8], count: usize) -> Result<Vec<usize>, DecodeError> {
        let (mut decoder, mut table) = (RansDecoder::new(bytes), AdaptiveTable::EVEN);
        let symbols = (0..count).map(|_| {
            let symbol = decoder.pop(&table);
            table.see(symbol);
            symbol
        });
        let symbols = symbols.collect();
        decoder.finish()?;
        Ok(symbols)
    }

    #[test]
    fn symbols_come_back_and_cost_their_entropy() {
        let mut random = SplitMix64(1);
        for count in [0, 1, 2, 3, 10, 1000, 20_000] {
            // A half, a quarter, an eighth …
            let symbols: Vec<usize> = (0..count)
                .map(|_| (random.next().trailing_zeros() as usize).min(SYMBOLS - 1))
                .collect();
            let bytes = coded(&symbols);
            assert_eq!(decoded(&bytes, count).unwrap(), symbols);
            let most = 2.0 * count as f64 * 1.02 / 8.0 + 40.0;
            assert!(
                (bytes.len() as f64) < most,
                "{count}: {} bytes",
                bytes.len()
            );
        }
    }

    #[test]
    fn what_is_cut_changed_or_longer_is_noticed() {
        let mut random = SplitMix64(2);
        let symbols: Vec<usize> = (0..500).map(|_| random.below(SYMBOLS)).collect();
        let bytes = coded(&symbols);
        for length in 0..bytes.len() {
            assert!(
                decoded(&bytes[..length], symbols.len()).is_err(),
                "cut to {length}"
            );
        }
        for place in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[place] ^= 1 << random.below(8);
            let found = decoded(&changed, symbols.len());
            assert!(found.is_err(), "changed at {place}");
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(decoded(&longer, symbols.len()).is_err());
        assert!(decoded(&bytes, symbols.len() - 1).is_err());
    }
}
