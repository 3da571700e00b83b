//! Lengths in 15 bits, rounded up.

use crate::geometry::double::rounded_up;

/// What lengths from 0 to a largest one are stored with: five bits of exponent, ten of mantissa.
///
/// Codes order as lengths do. Lengths far below the largest one, by 2³², become the smallest code above 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LengthScale {
    /// What is added to a code for the upper bits of an `f32`.
    base: i32,
}

/// The code of an infinite length.
pub(super) const INFINITE: u16 = 0x7FFF;
/// Bits of an `f32` below those of a code.
const SHIFT: u32 = 13;

impl LengthScale {
    /// A scale for lengths up to this one, which is finite.
    pub(super) fn up_to(largest: f64) -> Self {
        Self {
            base: upper_bits(largest.max(f64::from(f32::MIN_POSITIVE))) - i32::from(INFINITE - 1),
        }
    }

    /// The scale with this number, if there is one.
    pub(super) fn from_number(number: i32) -> Option<Self> {
        // What the largest code stands for is a finite `f32` above 0.
        let largest = number.checked_add(i32::from(INFINITE - 1))?;
        let most = f32::INFINITY.to_bits().cast_signed() >> SHIFT;
        (largest >= 1 && largest < most).then_some(Self { base: number })
    }

    pub(super) fn number(self) -> i32 {
        self.base
    }

    /// The code of the smallest length that is stored and is not below this one.
    pub(super) fn code(self, length: f64) -> u16 {
        if length <= 0.0 {
            return 0;
        }
        let code = upper_bits(length) - self.base;
        // Codes of 1 and more stand for lengths above 0.
        let least = (1 - self.base).max(1);
        u16::try_from(code.max(least)).map_or(INFINITE, |code| code.min(INFINITE))
    }

    /// The length of a code.
    #[inline]
    pub(super) fn length(self, code: u16) -> f32 {
        match code {
            0 => 0.0,
            INFINITE.. => f32::INFINITY,
            _ => f32::from_bits(((i32::from(code) + self.base).max(0) << SHIFT).cast_unsigned()),
        }
    }
}

/// The upper bits of the smallest `f32` not below a length above 0 that has no others.
fn upper_bits(length: f64) -> i32 {
    let bits = rounded_up(length).to_bits();
    (bits.div_ceil(1 << SHIFT)).cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn lengths_are_rounded_up_by_little_and_keep_their_order() {
        let mut random = SplitMix64(7);
        for largest in [1e-30, 1e-5, 1.0, 2500.0, 1e30] {
            let scale = LengthScale::up_to(largest);
            assert_eq!(LengthScale::from_number(scale.number()), Some(scale));
            assert_eq!((scale.code(0.0), scale.length(0)), (0, 0.0));
            assert_eq!(scale.length(scale.code(f64::INFINITY)), f32::INFINITY);
            assert!(f64::from(scale.length(scale.code(largest))) <= largest * 1.001);
            let mut codes = Vec::new();
            for _ in 0..2000 {
                let exponent = -(random.below(40_000) as f64) / 1000.0;
                let length = largest * exponent.exp2();
                let code = scale.code(length);
                let back = f64::from(scale.length(code));
                assert!(code < INFINITE && back >= length, "{length} {back}");
                if exponent > -31.0 && largest > 1e-20 {
                    assert!(back <= length * 1.001, "{length} {back}");
                }
                // What is stored is stored as itself.
                assert!(back == 0.0 || scale.code(back) == code);
                codes.push((length, code));
            }
            codes.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(codes.is_sorted_by_key(|it| it.1));
        }
        assert!(LengthScale::up_to(1.0).code(3.0) >= INFINITE - 2);
    }
}
