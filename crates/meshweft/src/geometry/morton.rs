//! Places along a curve through space that keeps near ones together.

/// A cube around some places, cut into 2⁶³ cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MortonCells {
    low: [f32; 3],
    cells_a_unit: f64,
}

/// How many cells a side of the cube has, as a power of two.
const BITS: u32 = 21;

impl MortonCells {
    /// A cube around the places that are finite.
    pub(crate) fn around(places: &[[f32; 3]]) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for place in places
            .iter()
            .filter(|place| place.iter().all(|x| x.is_finite()))
        {
            for axis in 0..3 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        let extents = [0, 1, 2].map(|axis| f64::from(high[axis]) - f64::from(low[axis]));
        let extent = extents.into_iter().fold(0.0, f64::max);
        let is_wide = extent > 0.0 && extent.is_finite();
        Self {
            low,
            cells_a_unit: if is_wide {
                f64::from(1 << BITS) / extent
            } else {
                0.0
            },
        }
    }

    /// The number of a place's cell along the curve of G. Morton (1966); the last one for a place that is not finite.
    pub(crate) fn number(&self, place: [f32; 3]) -> u64 {
        if !place.iter().all(|x| x.is_finite()) {
            return u64::MAX;
        }
        let most = f64::from((1_u32 << BITS) - 1);
        let mut number = 0;
        for ((axis, x), low) in (0..).zip(place).zip(self.low) {
            let cell = (f64::from(x) - f64::from(low)) * self.cells_a_unit;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "0 to 2²¹ − 1"
            )]
            let cell = cell.clamp(0.0, most) as u64;
            number |= spread(cell) << axis;
        }
        number
    }
}

/// The bits of a number of 21, two zeros between them.
fn spread(number: u64) -> u64 {
    let mut spread = number;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        spread = (spread | spread << shift) & mask;
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for number in [0, 1, 0b101, 0x1f_ffff, 0x15_5555, 0x12_3456] {
            let expected = (0..21).fold(0, |sum, bit| sum | (number >> bit & 1) << (3 * bit));
            assert_eq!(spread(number), expected);
        }
    }

    #[test]
    fn cells_are_numbered_along_the_curve() {
        let places = [[0.0; 3], [8.0, 4.0, 2.0]];
        let cells = MortonCells::around(&places);
        let at = |x, y, z| cells.number([x, y, z]) >> 60;
        assert_eq!(
            [at(0.0, 0.0, 0.0), at(8.0, 0.0, 0.0), at(0.0, 4.0, 0.0)],
            [0, 1, 2]
        );
        assert_eq!(cells.number([f32::NAN, 0.0, 0.0]), u64::MAX);
        assert_eq!(MortonCells::around(&[]).number([1.0; 3]), 0);
    }
}
