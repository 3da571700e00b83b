//! Vectors of three coordinates in double precision, for what is measured.
//!
//! The difference of two `f32` is exact here unless one is more than 2²⁹ times the other.

pub(crate) fn widened(a: [f32; 3]) -> [f64; 3] {
    a.map(f64::from)
}

#[inline]
pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
pub(crate) fn scaled(a: [f64; 3], factor: f64) -> [f64; 3] {
    a.map(|x| x * factor)
}

#[inline]
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

#[inline]
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The smallest `f32` that is not below a number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded up where it was rounded down"
)]
pub(crate) fn rounded_up(number: f64) -> f32 {
    let nearest = number as f32;
    match f64::from(nearest) < number {
        true => nearest.next_up(),
        false => nearest,
    }
}

/// The box around some points; those that are not finite do not count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Bounds {
    pub(crate) fn add(&mut self, point: [f64; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            self.low = [0, 1, 2].map(|axis| self.low[axis].min(point[axis]));
            self.high = [0, 1, 2].map(|axis| self.high[axis].max(point[axis]));
        }
    }

    /// The middle; the origin without points.
    #[cfg(feature = "files")]
    pub(crate) fn center(&self) -> [f64; 3] {
        match self.low[0] <= self.high[0] {
            true => scaled(add(self.low, self.high), 0.5),
            false => [0.0; 3],
        }
    }

    /// How long the diagonal is; 0 without points.
    pub(crate) fn diagonal(&self) -> f64 {
        match self.low[0] <= self.high[0] {
            true => {
                let diagonal = sub(self.high, self.low);
                dot(diagonal, diagonal).sqrt()
            }
            false => 0.0,
        }
    }
}
