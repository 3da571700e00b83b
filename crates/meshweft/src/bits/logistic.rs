//! Chances as log-odds and back, in integers by tables.

/// Log-odds are in parts of this.
const UNIT: i32 = 256;

/// The farthest log-odds: twelve.
pub(super) const MOST: i32 = 12 * UNIT - 1;

/// Chances are in parts of this.
pub(super) const ONE: i32 = 1 << 16;

/// The chance of every half of log-odds from -12 to 12: 65,536 / (1 + e^-x), rounded.
static CHANCES: [i32; 49] = [
    0, 1, 1, 2, 3, 5, 8, 13, 22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812,
    11_955, 17_625, 24_743, 32_768, 40_793, 47_911, 53_581, 57_724, 60_565, 62_428, 63_615, 64_357,
    64_816, 65_097, 65_269, 65_374, 65_438, 65_476, 65_500, 65_514, 65_523, 65_528, 65_531, 65_533,
    65_534, 65_535, 65_535, 65_536,
];

/// The chance of log-odds.
#[inline]
pub(super) const fn chance(odds: i32) -> i32 {
    let odds = match odds {
        odds if odds < -MOST => -MOST,
        odds if odds > MOST => MOST,
        odds => odds,
    };
    // Between the two nearest that are known.
    let above = odds + 12 * UNIT;
    let place = (above / (UNIT / 2)) as usize;
    let part = above % (UNIT / 2);
    let (low, high) = (CHANCES[place], CHANCES[place + 1]);
    low + ((high - low) * part) / (UNIT / 2)
}

/// How many chances have log-odds of their own.
const STEPS: usize = 4096;

/// Log-odds of chances.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "below 65,536, and at most twelve units"
)]
static ODDS: [i16; STEPS] = {
    let mut odds = [0; STEPS];
    let mut of = -MOST;
    let mut place = 0;
    while place < STEPS {
        // The least whose chance reaches the middle of the step.
        let middle = (16 * place + 8) as i32;
        while chance(of) < middle && of < MOST {
            of += 1;
        }
        odds[place] = of as i16;
        place += 1;
    }
    odds
};

/// The log-odds of a chance, at most about nine.
#[inline]
pub(super) fn log_odds(chance: u32) -> i32 {
    i32::from(ODDS[(chance >> 4) as usize & (STEPS - 1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chances_and_odds_are_each_others_inverse() {
        for odds in -MOST..MOST {
            assert!(chance(odds) <= chance(odds + 1));
            let sum = chance(odds) + chance(-odds);
            assert!((ONE - 1..=ONE).contains(&sum), "{odds}: {sum}");
            let exact = 65_536.0 / (1.0 + (-f64::from(odds) / 256.0).exp());
            assert!((f64::from(chance(odds)) - exact).abs() < 200.0, "{odds}");
        }
        for of in (8..65_528).step_by(7) {
            let back = chance(log_odds(of)).abs_diff(of.cast_signed());
            assert!(back <= 300, "{of}: {back}");
        }
    }
}
