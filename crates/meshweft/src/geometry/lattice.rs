//! Positions as multiples of a step.

/// Points at all multiples of a step along each axis, from the origin on. Meshes on one lattice that met
/// before meet after their positions were rounded to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    step: f64,
}

/// Multiples are below two to the power of this, so that they are exact as `f64`.
const MOST_BITS: u32 = 52;

impl Lattice {
    /// A lattice with a step in units of the positions; `None` unless it is finite and above 0.
    ///
    /// With a power of two, multiples are exact as `f32`, up to 24 bits.
    #[must_use]
    pub fn new(step: f64) -> Option<Self> {
        (step.is_finite() && step > 0.0).then_some(Self { step })
    }

    /// The lattice that divides the largest extent of positions, along any axis, into two to the power of `bits`
    /// minus one steps. Coordinates that are not finite are left out. `None` if `bits` is not 1 to 30.
    ///
    /// ```
    /// use meshweft::geometry::Lattice;
    /// let lattice = Lattice::of_bits([[0.0, 0.0, 0.0], [1.0, 6.0, 0.0]], 2).unwrap();
    /// assert_eq!(lattice.step(), 2.0);
    /// assert_eq!(lattice.multiple(4.9), Some(2));
    /// ```
    #[must_use]
    pub fn of_bits(positions: impl IntoIterator<Item = [f32; 3]>, bits: u32) -> Option<Self> {
        let (mut least, mut most) = ([f64::MAX; 3], [f64::MIN; 3]);
        for position in positions {
            for (axis, coordinate) in position.into_iter().enumerate() {
                if coordinate.is_finite() {
                    least[axis] = least[axis].min(f64::from(coordinate));
                    most[axis] = most[axis].max(f64::from(coordinate));
                }
            }
        }
        let extents = (0..3).map(|axis| most[axis] - least[axis]);
        let mut extent = extents.fold(0.0, f64::max);
        if extent == 0.0 {
            // One point: as if it were as far from the origin as it is large.
            let sizes = most.into_iter().filter(|size| *size > f64::MIN);
            extent = sizes.map(f64::abs).fold(0.0, f64::max);
        }
        if extent == 0.0 {
            extent = 1.0;
        }
        let steps = f64::from(
            2_u32
                .checked_pow(bits)?
                .checked_sub(1)
                .filter(|_| bits <= 30)?,
        );
        Self::new(extent / steps)
    }

    /// The distance of neighbours along an axis.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The multiple of the step that is nearest to a coordinate; `None` if it is not finite or has more than 52
    /// bits.
    #[must_use]
    pub fn multiple(&self, coordinate: f32) -> Option<i64> {
        let multiple = (f64::from(coordinate) / self.step).round();
        let is_exact = multiple.abs() < (1_u64 << MOST_BITS) as f64;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a whole number, and small enough"
        )]
        is_exact.then_some(multiple as i64)
    }

    /// The coordinate of a multiple of the step, at most half a step and the rounding of an `f32` from what it
    /// was.
    #[must_use]
    pub fn coordinate(&self, multiple: i64) -> f32 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a position is rounded to what can be stored"
        )]
        let coordinate = (multiple as f64 * self.step) as f32;
        coordinate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_come_back_within_half_a_step() {
        let positions = [
            [-3.0, 0.1, 7.25],
            [4.5, f32::NAN, 1e-3],
            [0.0, 2.0, f32::INFINITY],
        ];
        for bits in 1..=30 {
            let lattice = Lattice::of_bits(positions, bits).unwrap();
            for coordinate in positions.as_flattened() {
                match lattice.multiple(*coordinate) {
                    Some(multiple) => {
                        let off = f64::from(lattice.coordinate(multiple)) - f64::from(*coordinate);
                        assert!(off.abs() <= lattice.step() * 0.5 + 1e-6, "{bits}: {off}");
                    }
                    None => assert!(!coordinate.is_finite()),
                }
            }
        }
        assert_eq!(Lattice::of_bits(positions, 0), None);
        assert_eq!(Lattice::of_bits(positions, 31), None);
    }

    #[test]
    fn a_point_alone_is_not_moved_far() {
        let lattice = Lattice::of_bits([[0.3, -70.0, 0.0]], 14).unwrap();
        let multiple = lattice.multiple(-70.0).unwrap();
        assert!((lattice.coordinate(multiple) + 70.0).abs() < 0.01);
        assert!(Lattice::of_bits([], 14).is_some());
        assert!(Lattice::of_bits([[0.0; 3]], 14).is_some());
    }

    #[test]
    fn multiples_of_powers_of_two_are_exact() {
        let lattice = Lattice::new(0.125).unwrap();
        for coordinate in [-1000.375_f32, 0.0, 0.125, 65_536.5] {
            let multiple = lattice.multiple(coordinate).unwrap();
            assert_eq!(lattice.coordinate(multiple), coordinate);
        }
        assert_eq!(lattice.multiple(f32::MAX), None);
        assert_eq!(Lattice::new(0.0), None);
        assert_eq!(Lattice::new(f64::NAN), None);
    }
}
