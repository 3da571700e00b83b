//! Vectors of three coordinates.

/// `a − b`, coordinate by coordinate.
#[must_use]
pub fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The cross product: normal to both, as long as the parallelogram between them is large.
#[must_use]
pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// The scalar product.
#[must_use]
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector of length 1 in the same direction; of the zero vector, and of one that is not finite, itself.
#[must_use]
pub fn normalized(a: [f32; 3]) -> [f32; 3] {
    let square = dot(a, a);
    if square.is_normal() {
        let length = square.sqrt();
        return a.map(|x| x / length);
    }
    // Squares of very small or very large coordinates do not fit: take them relative to the largest.
    let largest = a.iter().fold(0.0_f32, |largest, x| largest.max(x.abs()));
    let relative = a.map(|x| x / largest);
    let length = dot(relative, relative).sqrt();
    match length.is_normal() {
        true => relative.map(|x| x / length),
        false => a,
    }
}

/// What is the same for two positions if they are one place: the bits of the coordinates, −0 taken for 0.
pub(crate) fn place_bits(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_follow_the_right_hand() {
        assert_eq!(cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(dot([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]), 32.0);
        assert_eq!(normalized([0.0, 3.0, 4.0]), [0.0, 0.6, 0.8]);
        assert_eq!(normalized([0.0; 3]), [0.0; 3]);
        assert_eq!(normalized([0.0, 1e-40, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(normalized([-3e38, 0.0, 0.0]), [-1.0, 0.0, 0.0]);
        assert!(normalized([f32::NAN, 1.0, 0.0])[0].is_nan());
        let infinite = [f32::INFINITY, 1.0, 0.0];
        assert_eq!(normalized(infinite), infinite);
    }
}
