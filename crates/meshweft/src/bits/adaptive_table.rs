//! Frequencies of 16 symbols that follow what comes.

/// How many symbols a table has.
pub(crate) const SYMBOLS: usize = 16;
/// Frequencies add up to two to the power of this.
pub(super) const PRECISION: u32 = 15;
/// Bits of the fraction of a frequency: the largest number of a table is just below 31 bits, so that its
/// difference to any other has 16 bits after this shift. Then a product with a step is one instruction for four symbols.
const FRACTION: u32 = 16;
/// The frequency to which that of a symbol falls that does not come any more. Rounding may take 1 from it, as
/// [`AdaptiveTable::see`] says, and the mean of two tables less than another 1.
const LEAST: usize = 3;

/// Cumulative frequencies of 16 symbols, which move towards the symbols that come: a third of the way at first,
/// a 300th in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct AdaptiveTable {
    /// Where each symbol begins, with a fraction; the first is 0. At least one whole is between two.
    begins: [i32; SYMBOLS],
    /// How many symbols it has seen, as far as that changes a step.
    seen: u16,
}

/// How far a table moves, in parts of 65,536, by the number of symbols that it has seen.
static STEPS: [i16; 300] = {
    let mut steps = [0; 300];
    let mut seen = 0;
    while seen < steps.len() {
        #[expect(clippy::cast_possible_truncation, reason = "below a half of 65,536")]
        let step = (655_360 / (10 * seen + 22)) as i16;
        steps[seen] = step;
        seen += 1;
    }
    steps
};

/// Where symbols begin once only one comes.
static GOALS: [[i32; SYMBOLS]; SYMBOLS] = {
    let mut goals = [[0; SYMBOLS]; SYMBOLS];
    let mut symbol = 0;
    while symbol < SYMBOLS {
        let mut place = 0;
        while place < SYMBOLS {
            goals[symbol][place] = goal(place, symbol) << FRACTION;
            place += 1;
        }
        symbol += 1;
    }
    goals
};

/// Where symbols begin once only one comes: from the place of that symbol on, and before it.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "below 64"
)]
const fn goal(place: usize, symbol: usize) -> i32 {
    match place > symbol {
        true => (1 << PRECISION) - (LEAST * (SYMBOLS - place)) as i32,
        false => (LEAST * place) as i32,
    }
}

impl AdaptiveTable {
    /// All symbols alike.
    pub(crate) const EVEN: Self = {
        let mut begins = [0; SYMBOLS];
        let mut place = 1;
        while place < SYMBOLS {
            begins[place] = begins[place - 1] + (1 << (PRECISION + FRACTION - 4));
            place += 1;
        }
        Self { begins, seen: 0 }
    };

    /// Where a symbol begins, and its frequency, which is never 0.
    #[inline]
    pub(super) fn interval(&self, symbol: usize) -> Interval {
        let begin = self.begins[symbol].cast_unsigned() >> FRACTION;
        let next = self.begins.get(symbol + 1);
        let end = next.map_or(1 << PRECISION, |next| next.cast_unsigned() >> FRACTION);
        Interval {
            begin,
            frequency: end - begin,
        }
    }

    /// The symbol to which a number below the sum of frequencies belongs.
    #[inline]
    pub(super) fn symbol(&self, number: u32) -> usize {
        let last = ((number << FRACTION) | ((1 << FRACTION) - 1)).cast_signed();
        // As they rise, those that begin later are the high bits; one more stands for the end.
        let mut later = 1 << SYMBOLS;
        for (place, &begin) in self.begins.iter().enumerate() {
            later |= u32::from(begin > last) << place;
        }
        later.trailing_zeros() as usize - 1
    }

    /// A symbol came.
    ///
    /// Let two neighbours be closer than their goals by some frequency. A step takes them apart by that times itself, and
    /// rounding brings them together by less than 1 times itself. So they do not get closer than 1 less than the goals.
    #[inline]
    pub(crate) fn see(&mut self, symbol: usize) {
        let step = i32::from(STEPS[usize::from(self.seen)]);
        self.seen += u16::from(usize::from(self.seen) + 1 < STEPS.len());
        for (begin, goal) in self.begins.iter_mut().zip(&GOALS[symbol]) {
            *begin += ((goal - *begin) >> FRACTION) * step;
        }
    }

    /// Whether it has seen fewer symbols than this.
    #[inline]
    pub(crate) fn has_seen_less_than(&self, symbols: u16) -> bool {
        self.seen < symbols
    }

    /// A table that begins with these frequencies, and soon has its own.
    #[inline]
    pub(crate) fn child(&self) -> Self {
        Self {
            begins: self.begins,
            seen: self.seen.min(8),
        }
    }

    /// The mean of two tables.
    #[inline]
    pub(crate) fn with(&self, other: &Self) -> Self {
        let mut mean = *self;
        for (begin, other) in mean.begins.iter_mut().zip(&other.begins) {
            *begin = (*begin >> 1) + (*other >> 1);
        }
        mean
    }
}

/// Where a symbol is among the frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Interval {
    pub(super) begin: u32,
    pub(super) frequency: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    fn frequencies(table: &AdaptiveTable) -> [u32; SYMBOLS] {
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
                let of = frequencies(&table.with(&AdaptiveTable::EVEN.child()));
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
