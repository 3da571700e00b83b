//! Points spread evenly over a surface.

use std::ops::Range;

use super::double::{cross, dot, scaled, sub, widened};
use super::surface::Surface;

/// Steps of the two coordinates inside faces: 1 / x and 1 / x² of the real root x of x³ = x + 1, whose
/// multiples fill the unit square evenly (M. Roberts: *The Unreasonable Effectiveness of Quasirandom
/// Sequences*, 2018).
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];

/// Points in equal steps of area along the faces, in the order of the surface's leaves.
///
/// A face gets its share of the points, rounded up or down; the same surface the same points.
#[derive(Debug)]
pub(super) struct Samples<'a> {
    corners: &'a [[[f32; 3]; 3]],
    /// For each face, its area and that of all before it.
    ends: Vec<f64>,
    count: usize,
}

impl<'a> Samples<'a> {
    /// As many points as asked; none if the surface has no area.
    pub(super) fn new(surface: &'a Surface<'_>, count: usize) -> Self {
        let corners = surface.corners();
        let mut sum = 0.0;
        let ends: Vec<f64> = corners
            .iter()
            .map(|corners| {
                sum += area(corners.map(widened));
                sum
            })
            .collect();
        Self {
            corners,
            ends,
            count: if sum > 0.0 { count } else { 0 },
        }
    }

    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// The area of the surface.
    pub(super) fn area(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// The points of these numbers.
    pub(super) fn points(&self, numbers: Range<usize>) -> impl Iterator<Item = [f64; 3]> {
        let at = |number: usize| (number as f64 + 0.5) / self.count as f64 * self.area();
        let mut face = self.ends.partition_point(|&end| end <= at(numbers.start));
        numbers.map(move |number| {
            while face + 1 < self.ends.len() && self.ends[face] <= at(number) {
                face += 1;
            }
            let [mut u, mut v] = STEPS.map(|step| (0.5 + number as f64 * step).fract());
            // The upper half of the square is folded onto the lower one.
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = self.corners[face.min(self.ends.len() - 1)].map(widened);
            let [along, across] = [scaled(sub(b, a), u), scaled(sub(c, a), v)];
            [0, 1, 2].map(|axis| a[axis] + along[axis] + across[axis])
        })
    }
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let normal = cross(sub(b, a), sub(c, a));
    dot(normal, normal).sqrt() * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles, one three times as large as the other, and one without an area.
    #[test]
    fn each_face_gets_its_share() {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-3.0, 0.0, 0.0],
        ];
        let faces = [[0, 0, 1], [0, 1, 2], [0, 2, 3]];
        let surface = Surface::new(&positions, &faces);
        let samples = Samples::new(&surface, 4000);
        assert_eq!((samples.len(), samples.area()), (4000, 2.0));
        let points: Vec<[f64; 3]> = samples.points(0..4000).collect();
        let right = points.iter().filter(|p| p[0] > 0.0).count();
        assert_eq!(right, 1000);
        let inside = |p: &[f64; 3]| match p[0] > 0.0 {
            true => p[1] >= 0.0 && p[0] + p[1] <= 1.0,
            false => p[1] >= 0.0 && p[1] - p[0] / 3.0 <= 1.0,
        };
        assert!(points.iter().all(|p| inside(p) && p[2] == 0.0));

        // The mean of the points is the centre of gravity, far better than random points give it.
        let mean = [0, 1].map(|axis| points.iter().map(|p| p[axis]).sum::<f64>() / 4000.0);
        let center = [(1.0 / 3.0 - 3.0) / 4.0, 1.0 / 3.0];
        assert!((mean[0] - center[0]).abs() < 2e-3, "{mean:?} {center:?}");
        assert!((mean[1] - center[1]).abs() < 2e-3, "{mean:?} {center:?}");

        // Parts of the numbers are parts of the points.
        let parts = samples.points(0..1234).chain(samples.points(1234..4000));
        assert_eq!(parts.collect::<Vec<_>>(), points);
    }

    #[test]
    fn without_an_area_there_is_no_point() {
        let surface = Surface::new(&[[0.0; 3]], &[[0, 0, 0]]);
        assert_eq!(Samples::new(&surface, 10).len(), 0);
        let surface = Surface::new(&[], &[]);
        assert_eq!(Samples::new(&surface, 10).len(), 0);
    }
}
