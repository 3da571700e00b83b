//! Which way three points turn, exactly: sums and products without rounding.
//!
//! Jonathan Richard Shewchuk: *Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates*, Discrete &
//! Computational Geometry 18(3), 1997, doi:10.1007/PL00009321.

use std::cmp::Ordering;

/// What rounds to it and what is left: the exact sum of two numbers.
#[inline]
pub(crate) fn sum_of_two(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    [sum, (a - of_a) + (b - of_b)]
}

/// The exact product of two numbers that are far from the largest and the smallest ones.
#[inline]
pub(crate) fn product_of_two(a: f64, b: f64) -> [f64; 2] {
    let halves = |x: f64| {
        let shifted = 134_217_729.0 * x; // 2^27 + 1
        let high = shifted - (shifted - x);
        [high, x - high]
    };
    let product = a * b;
    let [[a, a_low], [b, b_low]] = [halves(a), halves(b)];
    let rest = product - a * b - a_low * b - a * b_low;
    [product, a_low * b_low - rest]
}

/// A sum but for one rounding of its last bit; 0 and the sign are exact.
pub(crate) fn sum<const N: usize>(terms: [f64; N]) -> f64 {
    // Parts whose bits do not overlap, the smallest first.
    let mut parts = [0.0; N];
    let mut len = 0;
    for term in terms {
        let mut rest = term;
        let mut kept = 0;
        for at in 0..len {
            let [sum, low] = sum_of_two(rest, parts[at]);
            if low != 0.0 {
                parts[kept] = low;
                kept += 1;
            }
            rest = sum;
        }
        if rest != 0.0 {
            parts[kept] = rest;
            kept += 1;
        }
        len = kept;
    }
    parts[..len].iter().sum()
}

/// Whether a, b, c go round counter-clockwise seen from above (`Greater`), clockwise, or are on a line.
#[inline]
pub(crate) fn turn(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> Ordering {
    let [[ax, _, az], [bx, _, bz], [cx, _, cz]] = [a, b, c].map(|it| it.map(f64::from));
    let [first, second] = [(bz - az) * (cx - ax), (bx - ax) * (cz - az)];
    let area = first - second;
    if area.abs() > AREA_ROUNDING * (first.abs() + second.abs()) {
        return area.total_cmp(&0.0);
    }
    exact_area(a, b, c)
        .partial_cmp(&0.0)
        .unwrap_or(Ordering::Equal)
}

/// Relative to the sum of its two products: what rounding may do to an area at most.
pub(crate) const AREA_ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Twice the area of a triangle seen from above, but for a rounding of its last bit.
#[cold]
pub(crate) fn exact_area(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f64 {
    let [[ax, _, az], [bx, _, bz], [cx, _, cz]] = [a, b, c].map(|it| it.map(f64::from));
    // Products of two `f32` are exact.
    sum([bz * cx, -bz * ax, -az * cx, -bx * cz, bx * az, ax * cz])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn nearly_straight_turns_are_told_apart() {
        let mut random = SplitMix64(3);
        let mut found = [0; 3];
        for round in 0..20_000 {
            // Whole numbers of up to 24 bits, whose areas 128 bits hold; half of them are nearly on a line.
            let mut whole = || random.below(1 << 24) as i128;
            let [ax, az, bx, bz] = [whole(), whole(), whole(), whole()];
            let mut c = [whole(), whole()];
            if round % 2 == 0 {
                c = [(ax + bx) / 2, (az + bz) / 2];
            }
            let area = (bz - az) * (c[0] - ax) - (bx - ax) * (c[1] - az);
            let point = |x: i128, z: i128| [x as f32, 0.0, z as f32];
            let turned = turn(point(ax, az), point(bx, bz), point(c[0], c[1]));
            assert_eq!(turned, area.cmp(&0));
            found[(turned as i8 + 1) as usize] += 1;
        }
        assert!(found.iter().all(|&it| it > 1000), "{found:?}");

        // A shift that doubles do not hold beside the rest.
        let [a, b] = [[-1e30, 0.0, -1e30], [1e30, 0.0, 1e30]];
        assert_eq!(turn(a, b, [0.0; 3]), Ordering::Equal);
        assert_eq!(turn(a, b, [1e-30, 0.0, 0.0]), Ordering::Greater);
        assert_eq!(turn(a, b, [0.0, 0.0, 1e-30]), Ordering::Less);
    }

    #[test]
    fn sums_and_products_lose_nothing() {
        assert_eq!(sum([1e100, 1.0, -1e100, 1e-100]), 1.0);
        assert_eq!(sum([1e100, 1.0, -1e100, -1.0]), 0.0);
        let [product, rest] = product_of_two(1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        assert_eq!([product, rest], [1.0, -f64::EPSILON * f64::EPSILON]);
    }
}
