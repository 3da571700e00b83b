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
pub(super) fn chance(odds: i32) -> i32 {
    let odds = odds.clamp(-MOST, MOST);
    // Between the two nearest that are known.
    let above = odds + 12 * UNIT;
    let place = (above / (UNIT / 2)).unsigned_abs() as usize;
    let part = above % (UNIT / 2);
    let (low, high) = (CHANCES[place], CHANCES[place + 1]);
    low + ((high - low) * part) / (UNIT / 2)
}

/// How many chances have log-odds of their own.
const STEPS: usize = 2048;

/// Log-odds of chances. Made where it is needed: in a module of a web page it would be much of the code.
#[derive(Debug)]
pub(crate) struct LogOdds(Vec<i16>);

impl LogOdds {
    pub(crate) fn new() -> Self {
        let mut of = -MOST;
        let mut middle = 16;
        let step = |_| {
            // The least whose chance reaches the middle of the step.
            while chance(of) < middle && of < MOST {
                of += 1;
            }
            middle += 32;
            i16::try_from(of).unwrap_or(0)
        };
        Self((0..STEPS).map(step).collect())
    }

    /// The log-odds of a chance, at most about eight.
    #[inline]
    pub(super) fn of(&self, chance: u16) -> i32 {
        i32::from(self.0[usize::from(chance >> 5)])
    }
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
        let log_odds = LogOdds::new();
        for of in (16..65_520_u16).step_by(7) {
            let back = chance(log_odds.of(of)).abs_diff(of.into());
            assert!(back <= 300, "{of}: {back}");
        }
    }
}
