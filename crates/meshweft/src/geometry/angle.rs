//! Angles by additions, multiplications, divisions and roots, which are the same everywhere.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The angle of a direction in a plane, from the first axis towards the second: 0 to 2 π, or 0 for no direction. Within
/// 1e-14.
pub(crate) fn angle(x: f64, y: f64) -> f64 {
    let (width, height) = (x.abs(), y.abs());
    let steep = height > width;
    let (long, short) = if steep {
        (height, width)
    } else {
        (width, height)
    };
    if long == 0.0 {
        return 0.0;
    }

    // In the first eighth of the circle, the first quarter, the whole.
    let eighth = arc_tangent(short / long);
    let quarter = if steep { FRAC_PI_2 - eighth } else { eighth };
    let half = if x < 0.0 { PI - quarter } else { quarter };
    match y < 0.0 {
        true => TAU - half,
        false => half,
    }
}

/// The angle whose cosine is given: 0 to π.
pub(crate) fn arc_cosine(cosine: f64) -> f64 {
    let cosine = cosine.clamp(-1.0, 1.0);
    angle(cosine, ((1.0 - cosine) * (1.0 + cosine)).sqrt())
}

/// Of 0 to 1.
fn arc_tangent(tangent: f64) -> f64 {
    // Two halvings: at most the tangent of π / 16.
    let halved = |tangent: f64| tangent / (1.0 + (1.0 + tangent * tangent).sqrt());
    let small = halved(halved(tangent));
    // The series 1 − t²/3 + t⁴/5 …
    let square = small * small;
    let series = (0..12).rev().fold(0.0, |sum, power| {
        1.0 / f64::from(2 * power + 1) - square * sum
    });
    4.0 * small * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_standard_library() {
        for step in -2000_i32..4000 {
            let given = f64::from(step) * 0.002;
            let (y, x) = given.sin_cos();
            let expected = y.atan2(x);
            let expected = if expected < 0.0 {
                expected + TAU
            } else {
                expected
            };
            let found = angle(3.0 * x, 3.0 * y);
            assert!(
                (found - expected).abs() < 1e-14,
                "{given}: {found}, {expected}"
            );
            assert!((arc_cosine(x) - x.acos()).abs() < 1e-7);
        }
        assert_eq!(angle(0.0, 0.0), 0.0);
        assert_eq!(angle(1.0, 0.0), 0.0);
        assert!((angle(1.0, -1e-300) - TAU).abs() < 1e-14);
    }
}
