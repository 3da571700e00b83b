//! How far points are above or below a triangle.

use super::point_lists::ListedPoint;
use crate::geometry::signs::{self, AREA_ROUNDING, product_of_two, sum_of_two};

/// The plane of a triangle that is not seen from its side.
///
/// Distances are never below the true ones. They are above by what rounding may have done, which is little: where that could
/// matter, it is calculated exactly. A point of the plane has distance 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacePlane {
    corner: [f64; 3],
    /// The other corners, from the first one.
    sides: [[f64; 3]; 2],
    /// Whether no difference of two corners was rounded.
    is_exact: bool,
    /// Its length does not matter: `area` is its second component, but for rounding.
    normal: [f64; 3],
    /// Twice the area from above, or less by what rounding may have done.
    area: f64,
    /// The rounding of a product with the normal: at a point of the same height, and for each metre that one is higher or lower.
    rounding: [f64; 2],
}

/// Errors below this times the rounding are calculated again.
const CLOSE: f64 = 1_048_576.0;

impl FacePlane {
    /// Corners go round counter-clockwise, seen from above.
    pub(super) fn new(corners: [[f32; 3]; 3]) -> Self {
        let [corner, b, c] = corners.map(|it| it.map(f64::from));
        let sides = [b, c].map(|it| [0, 1, 2].map(|axis| it[axis] - corner[axis]));
        let is_exact = [b, c]
            .iter()
            .all(|it| (0..3).all(|axis| sum_of_two(it[axis], -corner[axis])[1] == 0.0));
        let [[bx, by, bz], [cx, cy, cz]] = sides;
        let normal = [bz * cy - by * cz, bz * cx - bx * cz, by * cx - bx * cy];

        // The same products without signs; a triangle's points are no farther than its corners, but in height.
        let largest = [
            (bz * cy).abs() + (by * cz).abs(),
            (bz * cx).abs() + (bx * cz).abs(),
            (by * cx).abs() + (bx * cy).abs(),
        ];
        let [width, depth] = [bx.abs().max(cx.abs()), bz.abs().max(cz.abs())];
        let rounding = [
            8.0 * f64::EPSILON * (width * largest[0] + depth * largest[2]),
            8.0 * f64::EPSILON * largest[1],
        ];

        // Less than the true area by one part in 1000 at most.
        let lost = AREA_ROUNDING * largest[1];
        let area = match normal[1] > 1000.0 * lost {
            true => normal[1] - lost,
            false => {
                let [corner, b, c] = corners;
                signs::exact_area(corner, b, c) * (1.0 - 4.0 * f64::EPSILON)
            }
        };
        Self {
            corner,
            sides,
            is_exact,
            normal,
            area,
            rounding,
        }
    }

    /// The largest distance of points above or below the triangle.
    pub(super) fn largest_distance(&self, points: &[ListedPoint]) -> f64 {
        let products = points.iter().map(|it| self.product(it.position));
        products.fold(0.0, f64::max) / self.area * (1.0 + 4.0 * f64::EPSILON)
    }

    /// At least the distance of a point, times the area.
    #[inline]
    fn product(&self, point: [f32; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(point[axis]) - self.corner[axis]);
        let product = x * self.normal[0] + z * self.normal[2] - y * self.normal[1];
        let rounding = self.rounding[0] + self.rounding[1] * y.abs();
        match product.abs() < CLOSE * rounding {
            true => self
                .exact_product(point)
                .unwrap_or(product.abs() + rounding),
            false => product.abs() + rounding,
        }
    }

    /// The same, exactly but for its last bit, if no difference and no product of two lengths is rounded.
    #[cold]
    fn exact_product(&self, point: [f32; 3]) -> Option<f64> {
        let difference = |axis: usize| {
            let [length, low] = sum_of_two(f64::from(point[axis]), -self.corner[axis]);
            (self.is_exact && low == 0.0).then_some(length)
        };
        let [x, y, z] = [difference(0)?, difference(1)?, difference(2)?];
        let [[bx, by, bz], [cx, cy, cz]] = self.sides;
        let mut terms = [0.0; 12];
        let factors = [
            (bz, cy, x),
            (-by, cz, x),
            (by, cx, z),
            (-bx, cy, z),
            (-bz, cx, y),
            (bx, cz, y),
        ];
        for ((a, b, c), terms) in factors.into_iter().zip(terms.as_chunks_mut::<2>().0) {
            let [product, low] = product_of_two(a, b);
            if low != 0.0 {
                return None;
            }
            *terms = product_of_two(product, c);
        }
        Some(signs::sum(terms).abs() * (1.0 + 2.0 * f64::EPSILON))
    }
}
