//! Asymmetric numeral systems by ranges (J. Duda, *Asymmetric numeral systems*, arXiv:1311.2540, 2013), with a state
//! for each of some lanes, and words of 16 bits.
//!
//! What is read forwards is written backwards, so all symbols are collected first. Symbols of different lanes do not wait
//! for each other when they are read. All states begin with the same number when they are written, and must be back at it
//! when everything is read.

use super::adaptive_table::{AdaptiveTable, Interval, PRECISION};
use super::error::{DecodeError, DecodeErrorKind};

/// States are at least this large.
const LEAST: u32 = 1 << 16;

/// Bits that are taken as they are at once.
pub(crate) const MOST_BITS: u32 = PRECISION;

/// The most lanes.
const LANES: usize = 4;

/// Which state a symbol is coded with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Lane(u8);

impl Lane {
    pub(crate) const ALL: [Self; LANES] = [Self(0), Self(1), Self(2), Self(3)];

    #[inline(always)]
    fn index(self) -> usize {
        usize::from(self.0) & (LANES - 1)
    }
}

/// Reads or writes a symbol by a table.
pub(crate) trait Port {
    /// The symbol that was read, or the one that was given.
    fn code(&mut self, lane: Lane, table: &AdaptiveTable, symbol: usize) -> usize;

    /// Up to 15 bits that were read, or those that were given.
    fn bits(&mut self, lane: Lane, count: u32, bits: u32) -> u32;

    /// A bit that is set with a chance in parts of 32,768, neither 0 nor all.
    #[cfg_attr(
        not(feature = "default-tier"),
        expect(dead_code, reason = "for that tier")
    )]
    fn bit(&mut self, lane: Lane, chance: u32, is_set: bool) -> bool;
}

/// The interval of a bit.
#[inline(always)]
fn interval_of(chance: u32, is_set: bool) -> Interval {
    debug_assert!((1..1 << PRECISION).contains(&chance));
    let (begin, frequency) = match is_set {
        true => (0, chance),
        false => (chance, (1 << PRECISION) - chance),
    };
    Interval { begin, frequency }
}

/// Collects symbols, and writes them.
#[derive(Debug)]
pub(crate) struct RansEncoder {
    /// Where each begins, its frequency in the bits from 15 on, its lane in the two highest.
    intervals: Vec<u32>,
    lanes: usize,
    /// About how many bits the symbols of each lane took, in parts of 65,536.
    parts: [u64; LANES],
}

/// Where the lane of an interval is.
const LANE_SHIFT: u32 = 2 * PRECISION;

impl RansEncoder {
    /// An encoder of the first lanes.
    pub(crate) fn new(lanes: usize) -> Self {
        debug_assert!((1..=LANES).contains(&lanes));
        Self {
            intervals: Vec::new(),
            lanes,
            parts: [0; LANES],
        }
    }

    #[inline]
    fn push(&mut self, lane: Lane, Interval { begin, frequency }: Interval) {
        let lane = u32::from(lane.0) << LANE_SHIFT;
        self.intervals.push(lane | frequency << PRECISION | begin);
    }

    /// About how many bits the symbols of each lane took, of all that is finished.
    pub(crate) fn bits_of_lanes(&self) -> [f64; LANES] {
        self.parts.map(|bits| bits as f64 / 65_536.0)
    }

    /// The bytes, in the order in which they are read. Nothing is left.
    pub(crate) fn finish(&mut self) -> Vec<u8> {
        #[expect(clippy::cast_possible_truncation, reason = "the low half of a state")]
        let low = |state: u32| state as u16;
        let mut states = [LEAST; LANES];
        let mut words: Vec<u16> = Vec::with_capacity(self.intervals.len() / 4 + 2 * LANES);
        for &interval in self.intervals.iter().rev() {
            let lane = (interval >> LANE_SHIFT) as usize;
            let frequency = interval >> PRECISION & ((1 << PRECISION) - 1);
            let begin = interval & ((1 << PRECISION) - 1);
            self.parts[lane] += bits_of(frequency);

            let state = &mut states[lane];
            if u64::from(*state) >= u64::from(frequency) << (32 - PRECISION) {
                words.push(low(*state));
                *state >>= 16;
            }
            *state = ((*state / frequency) << PRECISION) + *state % frequency + begin;
        }
        for &state in states[..self.lanes].iter().rev() {
            words.extend([low(state), low(state >> 16)]);
        }
        self.intervals.clear();
        let words = words.iter().rev();
        words.flat_map(|word| word.to_le_bytes()).collect()
    }
}

impl Port for RansEncoder {
    #[inline]
    fn code(&mut self, lane: Lane, table: &AdaptiveTable, symbol: usize) -> usize {
        self.push(lane, table.interval(symbol));
        symbol
    }

    #[inline]
    fn bits(&mut self, lane: Lane, count: u32, bits: u32) -> u32 {
        debug_assert!((1..=MOST_BITS).contains(&count) && bits >> count == 0);
        let frequency = 1 << (PRECISION - count);
        let begin = bits * frequency;
        self.push(lane, Interval { begin, frequency });
        bits
    }

    #[inline]
    fn bit(&mut self, lane: Lane, chance: u32, is_set: bool) -> bool {
        self.push(lane, interval_of(chance, is_set));
        is_set
    }
}

/// How many bits a symbol takes, in parts of 65,536, within a hundredth of a bit.
fn bits_of(frequency: u32) -> u64 {
    let whole = frequency.ilog2();
    // The logarithm of 1 to 2 by a parabola.
    let part = ((u64::from(frequency) << 16) >> whole) - (1 << 16);
    let curved = (part * (88_244 - ((22_708 * part) >> 16))) >> 16;
    (u64::from(PRECISION - whole) << 16) - curved
}

/// Reads symbols.
#[derive(Debug, Clone)]
pub(crate) struct RansDecoder {
    states: [u32; LANES],
    lanes: usize,
    words: Vec<u16>,
    /// How many words were asked for.
    asked: usize,
    /// Whether there is a byte after the words.
    is_odd: bool,
}

impl RansDecoder {
    /// A decoder of the first lanes.
    pub(crate) fn new(lanes: usize) -> Self {
        Self {
            states: [LEAST; LANES],
            lanes,
            words: Vec::new(),
            asked: 0,
            is_odd: false,
        }
    }

    /// Goes on with other bytes, whatever is left of those before.
    pub(crate) fn begin(&mut self, bytes: &[u8]) {
        let words = bytes.chunks_exact(2);
        self.is_odd = !words.remainder().is_empty();
        self.words.clear();
        self.words.reserve_exact(bytes.len() / 2);
        self.words
            .extend(words.map(|word| u16::from_le_bytes([word[0], word[1]])));
        self.asked = 0;
        for lane in 0..self.lanes {
            let high = self.word();
            self.states[lane] = high << 16 | self.word();
        }
    }

    fn word(&mut self) -> u32 {
        let word = self.words.get(self.asked).copied().unwrap_or(0);
        self.asked += 1;
        u32::from(word)
    }

    /// What was next in a lane lies in an interval.
    #[inline(always)]
    fn take(&mut self, lane: Lane, Interval { begin, frequency }: Interval) {
        let state = self.states[lane.index()];
        let number = state & ((1 << PRECISION) - 1);
        let state = frequency * (state >> PRECISION) + number - begin;
        // Without a branch, which could not be foreseen.
        let word = self.words.get(self.asked).copied().unwrap_or(0);
        let is_small = state < LEAST;
        let refilled = state << 16 | u32::from(word);
        self.asked += usize::from(is_small);
        self.states[lane.index()] = if is_small { refilled } else { state };
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
        match is_at_end
            && self.states[..self.lanes]
                .iter()
                .all(|&state| state == LEAST)
        {
            true => Ok(()),
            false => Err(self.error(DecodeErrorKind::Damaged)),
        }
    }
}

impl Port for RansDecoder {
    #[inline(always)]
    fn code(&mut self, lane: Lane, table: &AdaptiveTable, _: usize) -> usize {
        let number = self.states[lane.index()] & ((1 << PRECISION) - 1);
        let symbol = table.symbol(number);
        self.take(lane, table.interval(symbol));
        symbol
    }

    #[inline(always)]
    fn bits(&mut self, lane: Lane, count: u32, _: u32) -> u32 {
        debug_assert!((1..=MOST_BITS).contains(&count));
        let frequency = 1 << (PRECISION - count);
        let bits = (self.states[lane.index()] & ((1 << PRECISION) - 1)) >> (PRECISION - count);
        let begin = bits * frequency;
        self.take(lane, Interval { begin, frequency });
        bits
    }

    #[inline(always)]
    fn bit(&mut self, lane: Lane, chance: u32, _: bool) -> bool {
        let is_set = self.states[lane.index()] & ((1 << PRECISION) - 1) < chance;
        self.take(lane, interval_of(chance, is_set));
        is_set
    }
}

#[cfg(test)]
mod tests {
    use super::super::adaptive_table::SYMBOLS;
    use super::*;
    use crate::random::SplitMix64;

    fn coded(symbols: &[usize]) -> Vec<u8> {
        let (mut encoder, mut table) = (RansEncoder::new(LANES), AdaptiveTable::EVEN);
        for (turn, &symbol) in symbols.iter().enumerate() {
            encoder.code(Lane::ALL[turn % LANES], &table, symbol);
            table.see(symbol);
        }
        encoder.finish()
    }

    fn decoded(bytes: &[u8], count: usize) -> Result<Vec<usize>, DecodeError> {
        let (mut decoder, mut table) = (RansDecoder::new(LANES), AdaptiveTable::EVEN);
        decoder.begin(bytes);
        let symbols = (0..count).map(|turn| {
            let symbol = decoder.code(Lane::ALL[turn % LANES], &table, 0);
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
