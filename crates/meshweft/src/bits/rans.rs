//! Asymmetric numeral systems by ranges (J. Duda, *Asymmetric numeral systems*, arXiv:1311.2540, 2013), with a state
//! for each of some lanes, and words of 16 bits.
//!
//! What is read forwards is written backwards, so all symbols are collected first. Symbols of different lanes do not wait
//! for each other when they are read. All states begin with the same number when they are written, and must be back at it
//! when everything is read. Bits that are as likely set as not are taken from words of their own, which come when they are
//! needed.

use super::adaptive_table::{Frequencies, Interval, PRECISION};
use super::error::{DecodeError, DecodeErrorKind};

/// States are at least this large.
const LEAST: u32 = 1 << 16;

/// The most bits that are taken as they are at once.
pub(crate) const MOST_BITS: u32 = 45;

/// How many words hold these bits.
const MOST_WORDS: usize = 3;

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
pub(crate) trait Port: Sized {
    /// Whether it writes.
    const WRITES: bool;

    /// The symbol that was read, or the one that was given.
    fn code(&mut self, lane: Lane, table: &impl Frequencies, symbol: usize) -> usize;

    /// Up to [`MOST_BITS`] that were read, or those that were given; they count as a part of what the lane has.
    fn bits(&mut self, lane: Lane, count: u32, bits: u64) -> u64;

    /// A bit that is set with a chance in parts of 32,768, neither 0 nor all.
    fn bit(&mut self, lane: Lane, chance: u32, is_set: bool) -> bool;

    /// Does something with what a processor can keep in its registers: nothing else may refer to it.
    #[inline(always)]
    fn apart<R>(&mut self, act: impl FnOnce(&mut Self) -> R) -> R {
        act(self)
    }
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
    /// Where it is 0, bits come.
    intervals: Vec<u32>,
    /// Bits, and how many.
    plain: Vec<(u64, u32)>,
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
            plain: Vec::new(),
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
        let (mut plain_words, fetched) = words_of(&self.plain);
        let mut plain = self.plain.drain(..).zip(fetched).rev();
        for &interval in self.intervals.iter().rev() {
            let lane = (interval >> LANE_SHIFT) as usize;
            let frequency = interval >> PRECISION & ((1 << PRECISION) - 1);
            let begin = interval & ((1 << PRECISION) - 1);
            if frequency == 0 {
                let ((_, count), fetched) = plain.next().expect("bits that were pushed");
                self.parts[lane] += u64::from(count) << 16;
                let first = plain_words.len() - fetched;
                words.extend(plain_words.drain(first..).rev());
                continue;
            }
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
        drop(plain);
        self.intervals.clear();
        let words = words.iter().rev();
        words.flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// Words of some bits, the lowest first, and how many of them are fetched each time: no more than are needed.
fn words_of(plain: &[(u64, u32)]) -> (Vec<u16>, Vec<usize>) {
    let (mut words, mut fetched) = (Vec::new(), Vec::with_capacity(plain.len()));
    // Bits of the last word that are not taken yet; those of the next one, and how many.
    let (mut have, mut next, mut waiting) = (0, 0, 0);
    for &(bits, count) in plain {
        next |= bits << waiting;
        waiting += count;
        while waiting >= 16 {
            words.push((next & 0xFFFF) as u16);
            next >>= 16;
            waiting -= 16;
        }
        let missing = words_for(count, have);
        have = have + 16 * missing - count;
        fetched.push(missing as usize);
    }
    if waiting > 0 {
        words.push((next & 0xFFFF) as u16);
    }
    (words, fetched)
}

/// How many words are missing for a number of bits where there are some.
#[inline(always)]
fn words_for(count: u32, have: u32) -> u32 {
    count.saturating_sub(have).div_ceil(16)
}

impl Port for RansEncoder {
    const WRITES: bool = true;

    #[inline]
    fn code(&mut self, lane: Lane, table: &impl Frequencies, symbol: usize) -> usize {
        self.push(lane, table.interval(symbol));
        symbol
    }

    #[inline]
    fn bits(&mut self, lane: Lane, count: u32, bits: u64) -> u64 {
        debug_assert!(count <= MOST_BITS && bits >> count == 0);
        let (begin, frequency) = (0, 0);
        self.push(lane, Interval { begin, frequency });
        self.plain.push((bits, count));
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
    /// Bits that were not taken of the last words, and how many: fewer than a word has.
    plain: u64,
    plain_count: u32,
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
            plain: 0,
            plain_count: 0,
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
        (self.asked, self.plain, self.plain_count) = (0, 0, 0);
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

    /// The next three words, and 0 for those that are not there.
    #[cold]
    fn next_words(&self) -> u64 {
        let next = self.words.get(self.asked..).unwrap_or(&[]);
        let next = next.iter().take(MOST_WORDS).rev();
        next.fold(0, |all, &word| all << 16 | u64::from(word))
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
        let is_at_end = self.asked == self.words.len() && !self.is_odd && self.plain == 0;
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
    const WRITES: bool = false;

    #[inline(always)]
    fn apart<R>(&mut self, act: impl FnOnce(&mut Self) -> R) -> R {
        let mut own = std::mem::replace(self, Self::new(self.lanes));
        let done = act(&mut own);
        *self = own;
        done
    }

    #[inline(always)]
    fn code(&mut self, lane: Lane, table: &impl Frequencies, _: usize) -> usize {
        let number = self.states[lane.index()] & ((1 << PRECISION) - 1);
        let symbol = table.symbol(number);
        self.take(lane, table.interval(symbol));
        symbol
    }

    #[inline(always)]
    fn bits(&mut self, _: Lane, count: u32, _: u64) -> u64 {
        debug_assert!(count <= MOST_BITS);
        // What is missing of them, without a branch, which could not be foreseen.
        let missing = words_for(count, self.plain_count);
        let next = self.words.get(self.asked..).and_then(<[u16]>::first_chunk);
        let next = match next {
            Some(&[a, b, c]) => u64::from(a) | u64::from(b) << 16 | u64::from(c) << 32,
            None => self.next_words(),
        };
        self.asked += missing as usize;
        let plain = self.plain | (next & ((1 << (16 * missing)) - 1)) << self.plain_count;
        self.plain = plain >> count;
        self.plain_count = self.plain_count + 16 * missing - count;
        plain & ((1 << count) - 1)
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
    use super::super::adaptive_table::{AdaptiveTable, SYMBOLS};
    use super::*;
    use crate::index::index32;
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
    fn plain_bits_come_back_between_symbols_and_cost_what_they_are() {
        let mut random = SplitMix64(3);
        for count in [0, 1, 2, 50, 3000] {
            let taken: Vec<(u32, u64)> = (0..count)
                .map(|_| {
                    let length = index32(random.below(MOST_BITS as usize + 1));
                    (length, random.next() & ((1 << length) - 1))
                })
                .collect();
            let lane = |turn: usize| Lane::ALL[turn % LANES];
            let (mut encoder, table) = (RansEncoder::new(LANES), AdaptiveTable::EVEN);
            for (turn, &(length, bits)) in taken.iter().enumerate() {
                encoder.bits(lane(turn), length, bits);
                encoder.code(lane(turn), &table, turn % SYMBOLS);
            }
            let bytes = encoder.finish();

            let mut decoder = RansDecoder::new(LANES);
            decoder.begin(&bytes);
            for (turn, &(length, bits)) in taken.iter().enumerate() {
                assert_eq!(decoder.bits(lane(turn), length, 0), bits);
                assert_eq!(decoder.code(lane(turn), &table, 0), turn % SYMBOLS);
            }
            decoder.finish().unwrap();
            let bits: usize = taken.iter().map(|&(length, _)| length as usize + 4).sum();
            assert!(bytes.len() <= bits.div_ceil(8) + 4 * LANES + 2);
            let of_lanes: f64 = encoder.bits_of_lanes().iter().sum();
            assert!((of_lanes - bits as f64).abs() < 0.01 * bits as f64 + 1.0);
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
