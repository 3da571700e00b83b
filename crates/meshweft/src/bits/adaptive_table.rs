//! Frequencies of 16 symbols that follow what comes.

/// How many symbols a table has.
pub(crate) const SYMBOLS: usize = 16;

/// Frequencies add up to two to the power of this.
pub(super) const PRECISION: u32 = 15;

/// No frequency is below.
const LEAST: u16 = 3;

/// What a symbol adds to its count. One that never came counts 1 at first.
const WEIGHT: u16 = 28;

/// With more symbols than this, older ones count half.
const MOST_SEEN: u16 = 500;

/// With a shorter wait, a table has seen fewer than about 40 symbols.
const YOUNG_WAIT: u16 = 9;

/// The most symbols from one change of the frequencies to the next.
const LONGEST_WAIT: u16 = 128;

/// Frequencies of 16 symbols by how often they came. They change after every symbol at first, then after more and more
/// of them, so that a symbol takes few instructions: the next one does not wait for a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(8))]
pub(crate) struct AdaptiveTable {
    /// Where each symbol begins, and where the last one ends; the first is 0.
    begins: [u16; SYMBOLS + 1],
    counts: [u16; SYMBOLS],
    /// How many symbols come until the frequencies change, and how many came from the change before to the last one.
    left: u16,
    wait: u16,
}

impl AdaptiveTable {
    /// All symbols alike.
    pub(crate) const EVEN: Self = {
        let mut begins = [0; SYMBOLS + 1];
        let mut place = 1;
        while place <= SYMBOLS {
            begins[place] = begins[place - 1] + (1 << (PRECISION - 4));
            place += 1;
        }
        Self {
            begins,
            counts: [1; SYMBOLS],
            left: 1,
            wait: 1,
        }
    };

    /// A symbol came.
    #[inline(always)]
    pub(crate) fn see(&mut self, symbol: usize) {
        self.counts[symbol] += WEIGHT;
        self.left -= 1;
        if self.left == 0 {
            self.change();
        }
    }

    #[inline(never)]
    fn change(&mut self) {
        self.wait = (self.wait + self.wait / 8 + 1).min(LONGEST_WAIT);
        self.left = self.wait;
        let mut total: u32 = self.counts.iter().map(|&count| u32::from(count)).sum();
        if total > u32::from(MOST_SEEN) * u32::from(WEIGHT) {
            for count in &mut self.counts {
                *count /= 2;
            }
            total = self.counts.iter().map(|&count| u32::from(count)).sum();
        }

        // Beyond the least frequencies, as many parts of 65,536 for each that was counted.
        let above = (1 << PRECISION) - 16 * u32::from(LEAST);
        let of_one = (above << 16) / total;
        let (mut before, mut least) = (0, 0);
        for (begin, &count) in self.begins.iter_mut().zip(&self.counts) {
            let place = ((before * of_one) >> 16) as u16;
            *begin = place + least;
            before += u32::from(count);
            least += LEAST;
        }
    }

    /// Whether it has seen few symbols.
    #[inline]
    pub(crate) fn is_young(&self) -> bool {
        self.wait < YOUNG_WAIT
    }

    /// A table that begins with these frequencies, and soon has its own.
    pub(crate) fn child(&self) -> Self {
        // Together they count about as much as two symbols.
        #[expect(clippy::cast_possible_truncation, reason = "5 bits")]
        let count = |symbol| (self.interval(symbol).frequency >> 10) as u16;
        Self {
            begins: self.begins,
            counts: std::array::from_fn(|symbol| 1 + count(symbol)),
            left: 1,
            wait: 1,
        }
    }
}

impl Frequencies for AdaptiveTable {
    #[inline(always)]
    fn begin(&self, symbol: usize) -> u32 {
        self.begins[symbol].into()
    }
}

/// The mean of two tables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mean<'a>(pub(crate) &'a AdaptiveTable, pub(crate) &'a AdaptiveTable);

impl Frequencies for Mean<'_> {
    #[inline(always)]
    fn begin(&self, symbol: usize) -> u32 {
        let Self(one, other) = self;
        (one.begin(symbol) + other.begin(symbol)) / 2
    }
}

/// Frequencies of 16 symbols, none of them 0.
pub(crate) trait Frequencies {
    /// Where a symbol begins, or for the number of symbols where the last one ends.
    fn begin(&self, symbol: usize) -> u32;

    #[inline(always)]
    fn interval(&self, symbol: usize) -> Interval {
        let begin = self.begin(symbol);
        Interval {
            begin,
            frequency: self.begin(symbol + 1) - begin,
        }
    }

    /// The symbol to which a number below the sum of frequencies belongs.
    #[inline(always)]
    fn symbol(&self, number: u32) -> usize {
        // Among quarters, then within one, without a branch, which could not be foreseen.
        let begins_earlier = |symbol: usize| usize::from(self.begin(symbol) <= number);
        let quarter = begins_earlier(4) + begins_earlier(8) + begins_earlier(12);
        let first = 4 * quarter;
        first + begins_earlier(first + 1) + begins_earlier(first + 2) + begins_earlier(first + 3)
    }
}

/// Where a symbol is among the frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Interval {
    pub(super) begin: u32,
    pub(super) frequency: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    fn frequencies(table: &impl Frequencies) -> [u32; SYMBOLS] {
        let mut end = 0;
        std::array::from_fn(|symbol| {
            let interval = table.interval(symbol);
            assert_eq!(interval.begin, end, "no gap before symbol {symbol}");
            end += interval.frequency;
            assert!(symbol + 1 < SYMBOLS || end == 1 << PRECISION);
            interval.frequency
        })
    }

    #[test]
    fn no_frequency_gets_to_0_and_numbers_find_their_symbols() {
        let mut random = SplitMix64(1);
        for skew in 0..40 {
            let mut table = AdaptiveTable::EVEN;
            for _ in 0..2000 {
                let symbol = match random.below(40) < skew {
                    true => skew % SYMBOLS,
                    false => random.below(SYMBOLS),
                };
                table.see(symbol);
                let of = frequencies(&Mean(&table, &AdaptiveTable::EVEN.child()));
                assert!(of.iter().all(|&frequency| frequency > 0));
            }
            assert!(frequencies(&table).iter().all(|&frequency| frequency > 0));
            for number in 0..1 << PRECISION {
                let symbol = table.symbol(number);
                let Interval { begin, frequency } = table.interval(symbol);
                assert!((begin..begin + frequency).contains(&number));
            }
        }
    }

    #[test]
    fn a_symbol_that_always_comes_costs_next_to_nothing() {
        let mut table = AdaptiveTable::EVEN;
        (0..5000).for_each(|_| table.see(5));
        let frequency = f64::from(table.interval(5).frequency);
        assert!(-(frequency / 32_768.0).log2() < 0.0025, "{frequency}");
    }
}
