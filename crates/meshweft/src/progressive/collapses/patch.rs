//! A few triangles, asked often how far points are from them.

use crate::geometry::double::{cross, dot, sub};

/// A triangle with what its distances need, but for the point.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corner: [f64; 3],
    /// The sides from the corner, and the normal with the length of 1; 0 if the triangle has no area.
    sides: [[f64; 3]; 2],
    normal: [f64; 3],
    /// Scalar products of the sides: of each with itself, and of both.
    squares: [f64; 2],
    product: f64,
    /// The square of the third side.
    third: f64,
    /// Twice the area, squared.
    double_area: f64,
}

/// Squares of sines up to this: a triangle without an area.
const FLAT: f64 = 1e-24;

/// How far along a side of this square a point is, from 0 to 1; `product` is that of both.
#[inline]
fn along(product: f64, square: f64) -> f64 {
    match square > 0.0 {
        true => (product / square).clamp(0.0, 1.0),
        false => 0.0,
    }
}

impl Triangle {
    fn new([corner, b, c]: [[f64; 3]; 3]) -> Self {
        let sides = [sub(b, corner), sub(c, corner)];
        let normal = cross(sides[0], sides[1]);
        let squares = sides.map(|side| dot(side, side));
        let double_area = match dot(normal, normal) {
            square if square > FLAT * squares[0] * squares[1] => square,
            _ => 0.0,
        };
        let scale = if double_area > 0.0 {
            double_area.sqrt().recip()
        } else {
            0.0
        };
        let product = dot(sides[0], sides[1]);
        Self {
            corner,
            sides,
            normal: normal.map(|x| x * scale),
            squares,
            product,
            third: squares[0] + squares[1] - 2.0 * product,
            double_area,
        }
    }

    /// The squared distance of a point.
    #[inline]
    fn square(&self, point: [f64; 3]) -> f64 {
        let way = sub(point, self.corner);
        let [first, second] = [dot(self.sides[0], way), dot(self.sides[1], way)];
        let [a, b] = self.squares;

        // Above the triangle: the distance from its plane.
        let s = b * first - self.product * second;
        let t = a * second - self.product * first;
        if self.double_area > 0.0 && s >= 0.0 && t >= 0.0 && s + t <= self.double_area {
            let height = dot(self.normal, way);
            return height * height;
        }

        // Else the nearest side.
        let square = dot(way, way);
        let far = square - 2.0 * first + a;
        let on_third = second - first - self.product + a;
        let to_side = |from: f64, product: f64, side: f64| {
            let along = along(product, side);
            from - along * (2.0 * product - along * side)
        };
        let least = to_side(square, first, a).min(to_side(square, second, b));
        least.min(to_side(far, on_third, self.third)).max(0.0)
    }
}

/// Triangles with a number each.
#[derive(Debug, Default)]
pub(super) struct Patch {
    triangles: Vec<(u32, Triangle)>,
}

impl Patch {
    pub(super) fn clear(&mut self) {
        self.triangles.clear();
    }

    pub(super) fn push(&mut self, number: u32, corners: [[f64; 3]; 3]) {
        self.triangles.push((number, Triangle::new(corners)));
    }

    /// The squared distance of a point from the nearest triangle, and its number; `None` without triangles
    /// or with coordinates that are not finite.
    ///
    /// Exact to about 10⁻⁸ of the distances between the corners and the point.
    #[inline]
    pub(super) fn nearest(&self, point: [f64; 3]) -> Option<(f64, u32)> {
        let mut nearest = (f64::INFINITY, None);
        for (number, triangle) in &self.triangles {
            let square = triangle.square(point);
            if square < nearest.0 {
                nearest = (square, Some(*number));
            }
        }
        Some((nearest.0, nearest.1?))
    }

    /// The squared distance alone; 0 where there is none.
    #[inline]
    pub(super) fn square(&self, point: [f64; 3]) -> f64 {
        self.nearest(point).map_or(0.0, |(square, _)| square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle::way_to_triangle;
    use crate::random::SplitMix64;

    #[test]
    fn distances_are_those_of_the_exact_way() {
        let mut random = SplitMix64(7);
        let mut coordinate = || random.below(2001) as f64 / 1000.0 - 1.0;
        for round in 0..20_000 {
            let [point, a, mut b, mut c] = [(); 4].map(|()| [(); 3].map(|()| coordinate()));
            // Now and then a needle, and a triangle without an area.
            match round % 7 {
                0 => b = [0, 1, 2].map(|i| a[i] + 1e-6 * (c[i] - b[i])),
                1 => c = [0, 1, 2].map(|i| a[i] + 0.5 * (b[i] - a[i])),
                2 if round % 2 == 0 => (b, c) = (a, a),
                _ => {}
            }
            let mut patch = Patch::default();
            patch.push(3, [a, b, c]);
            let way = way_to_triangle(point, [a, b, c]);
            let (square, number) = patch.nearest(point).unwrap();
            assert_eq!(number, 3);
            assert!(
                (square.sqrt() - dot(way, way).sqrt()).abs() < 1e-6,
                "{round}"
            );
        }
        assert!(Patch::default().nearest([0.0; 3]).is_none());
    }
}
