//! Asymmetric numeral systems by ranges (J. Duda, *Asymmetric numeral systems*, arXiv:1311.2540, 2013): two
//! states in turn, words of 16 bits.
//!
//! What is read forwards is written backwards, so all symbols are collected first. Both states begin with
//! the same number when they are written, and must be back at it when everything is read.

use super::adaptive_table::{AdaptiveTable, Interval, PRECISION};
use super::error::{DecodeError, DecodeErrorKind};

/// States are at least this large.
const LEAST: u32 = 1 << 16;
/// Bits that are taken as they are at once.
pub(crate) const MOST_BITS: u32 = PRECISION;
/// States in turn.
const STATES: usize = 2;

/// Collects symbols, and writes them.
#[derive(Debug, Default)]
pub(crate) struct RansEncoder {
    /// Where each begins, and its frequency; the highest bit of the first says that it is of the second kind.
    intervals: Vec<(u16, u16)>,
    /// What is counted apart.
    kind: u16,
    /// About how many bits symbols of either kind took, in parts of 65,536.
    parts: [u64; 2],
}

/// The highest bit.
const SECOND_KIND: u16 = 1 << 15;

impl RansEncoder {
    /// Takes a symbol, with its frequency in a table.
    #[inline]
    pub(crate) fn push(&mut self, table: &AdaptiveTable, symbol: usize) {
        let Interval { begin, frequency } = table.interval(symbol);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "below two to the power of 15"
        )]
        self.intervals
            .push((begin as u16 | self.kind, frequency as u16));
    }

    /// Takes up to 15 bits as they are.
    #[inline]
    pub(crate) fn push_bits(&mut self, count: u32, bits: u32) {
        debug_assert!((1..=MOST_BITS).contains(&count) && bits >> count == 0);
        let frequency = 1 << (PRECISION - count);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "below two to the power of 15"
        )]
        self.intervals
            .push(((bits * frequency) as u16 | self.kind, frequency as u16));
    }

    /// Symbols from here on are of the first or second kind.
    #[inline]
    pub(crate) fn count_as(&mut self, is_second: bool) {
        self.kind = if is_second { SECOND_KIND } else { 0 };
    }

    /// About how many bits symbols of either kind took, of all that is finished.
    pub(crate) fn bits_of_kinds(&self) -> [f64; 2] {
        self.parts.map(|bits| bits as f64 / 65_536.0)
    }

    /// The bytes, in the order in which they are read. Nothing is left.
    pub(crate) fn finish(&mut self) -> Vec<u8> {
        #[expect(clippy::cast_possible_truncation, reason = "the low half of a state")]
        let low = |state: u32| state as u16;
        let mut states = [LEAST; STATES];
        let mut words: Vec<u16> = Vec::with_capacity(self.intervals.len() / 4 + 2 * STATES);
        for (turn, &(begin, frequency)) in self.intervals.iter().enumerate().rev() {
            self.parts[usize::from(begin / SECOND_KIND)] += bits_of(frequency);
            let begin = u32::from(begin & !SECOND_KIND);
            let frequency = u32::from(frequency);
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
        self.intervals.clear();
        let words = words.iter().rev();
        words.flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// How many bits a symbol takes, in parts of 65,536, within a hundredth of a bit.
fn bits_of(frequency: u16) -> u64 {
    let whole = frequency.ilog2();
    // The logarithm of 1 to 2 by a parabola.
    let part = ((u64::from(frequency) << 16) >> whole) - (1 << 16);
    let curved = (part * (88_244 - ((22_708 * part) >> 16))) >> 16;
    (u64::from(PRECISION - whole) << 16) - curved
}

/// Reads symbols.
#[derive(Debug, Clone, Default)]
pub(crate) struct RansDecoder {
    /// The state whose turn it is first.
    states: [u32; STATES],
    words: Vec<u16>,
    /// How many words were asked for.
    asked: usize,
    /// Whether there is a byte after the words.
    is_odd: bool,
}

impl RansDecoder {
    #[cfg(test)]
    fn new(bytes: &[u8]) -> Self {
        let mut decoder = Self::default();
        decoder.begin(bytes);
        decoder
    }

    /// Goes on with other bytes, whatever is left of those before.
    pub(crate) fn begin(&mut self, bytes: &[u8]) {
        let words = bytes.chunks_exact(2);
        self.is_odd = !words.remainder().is_empty();
        self.words.clear();
        self.words
            .extend(words.map(|word| u16::from_le_bytes([word[0], word[1]])));
        self.asked = 0;
        for state in 0..STATES {
            let high = self.word();
            self.states[state] = high << 16 | self.word();
        }
    }

    #[inline]
    fn word(&mut self) -> u32 {
        let word = self.words.get(self.asked).copied().unwrap_or(0);
        self.asked += 1;
        u32::from(word)
    }

    /// The next symbol, by its frequency in a table.
    #[inline]
    pub(crate) fn pop(&mut self, table: &AdaptiveTable) -> usize {
        let number = self.states[0] & ((1 << PRECISION) - 1);
        let symbol = table.symbol(number);
        self.take(table.interval(symbol));
        symbol
    }

    /// Up to 15 bits as they were given.
    #[inline]
    pub(crate) fn pop_bits(&mut self, count: u32) -> u32 {
        debug_assert!((1..=MOST_BITS).contains(&count));
        let frequency = 1 << (PRECISION - count);
        let bits = (self.states[0] & ((1 << PRECISION) - 1)) / frequency;
        self.take(Interval {
            begin: bits * frequency,
            frequency,
        });
        bits
    }

    /// What was next lies in an interval.
    #[inline]
    fn take(&mut self, Interval { begin, frequency }: Interval) {
        let [state, other] = self.states;
        let number = state & ((1 << PRECISION) - 1);
        let state = frequency * (state >> PRECISION) + number - begin;

        // Without a branch, which could not be foreseen.
        let word = self.words.get(self.asked).copied().unwrap_or(0);
        let is_small = state < LEAST;
        let refilled = state << 16 | u32::from(word);
        self.asked += usize::from(is_small);
        self.states = [other, if is_small { refilled } else { state }];
    }

    /// What is wrong at the place where it is now.
    #[cold]
    pub(crate) fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        let ends_early = self.asked > self.words.len();
        DecodeError {
            byte: 2 * self.asked.min(self.words.len()),
            kind: match ends_early {
                true => DecodeErrorKind::EndsEarly,
                false => kind,
            },
        }
    }

    /// # Errors
    /// More was read than is there.
    #[inline]
    pub(crate) fn check(&self) -> Result<(), DecodeError> {
        match self.asked <= self.words.len() {
            true => Ok(()),
            false => Err(self.error(DecodeErrorKind::EndsEarly)),
        }
    }

    /// # Errors
    /// Something is left, or what was read is not what was written.
    pub(crate) fn finish(&self) -> Result<(), DecodeError> {
        self.check()?;
        let is_at_end = self.asked == self.words.len() && !self.is_odd;
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
