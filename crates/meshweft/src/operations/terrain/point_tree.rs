//! Points in halves of halves, to find those in a triangle.

use crate::geometry::signs::{AREA_ROUNDING, exact_area, turn};

/// Points, cut again and again at the middle one along the longer axis of the rectangle around them. It is as deep for points of any
/// distribution, so a triangle is laid on a few points more than it has.
#[derive(Debug, Clone)]
pub(super) struct PointTree {
    points: Vec<[f32; 3]>,
    /// The ranges of x and of z of each part, whose halves are 2 i + 1 and 2 i + 2.
    around: Vec<[[f32; 2]; 2]>,
}

/// Parts with so many points are not cut.
const FEW: usize = 8;

impl PointTree {
    /// The order of the points changes.
    pub(super) fn new(mut points: Vec<[f32; 3]>) -> Self {
        let (mut parts, mut largest) = (1, points.len());
        while largest > FEW {
            largest = largest.div_ceil(2);
            parts = 2 * parts + 1;
        }
        let mut around = vec![[[0.0; 2]; 2]; parts];
        let mut open = vec![(0, 0..points.len())];
        while let Some((part, range)) = open.pop() {
            let inside = &mut points[range.clone()];
            let ranges = [0, 2].map(|axis: usize| {
                let along = inside.iter().map(|it| it[axis]);
                along.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], it| {
                    [low.min(it), high.max(it)]
                })
            });
            around[part] = ranges;
            if inside.len() > FEW {
                let [width, depth] = ranges.map(|[low, high]| f64::from(high) - f64::from(low));
                let axis = if width >= depth { 0 } else { 2 };
                let half = inside.len() / 2;
                inside.select_nth_unstable_by(half, |a, b| a[axis].total_cmp(&b[axis]));
                let middle = range.start + half;
                open.push((2 * part + 1, range.start..middle));
                open.push((2 * part + 2, middle..range.end));
            }
        }
        Self { points, around }
    }

    pub(super) fn points(&self) -> &[[f32; 3]] {
        &self.points
    }

    /// Gives the number of each point in a counter-clockwise triangle or at its sides, and twice the areas that it has with the side across
    /// from each corner: signs and zeros are exact.
    pub(super) fn in_triangle(
        &self,
        corners: [[f32; 3]; 3],
        found: &mut impl FnMut(usize, [f64; 3]),
    ) {
        if !self.points.is_empty() {
            self.visit(0, [0, self.points.len()], &corners, found);
        }
    }

    fn visit(
        &self,
        part: usize,
        [start, end]: [usize; 2],
        corners: &[[f32; 3]; 3],
        found: &mut impl FnMut(usize, [f64; 3]),
    ) {
        if is_outside(corners, self.around[part]) {
            return;
        }
        if end - start > FEW {
            let middle = start + (end - start) / 2;
            self.visit(2 * part + 1, [start, middle], corners, found);
            self.visit(2 * part + 2, [middle, end], corners, found);
            return;
        }
        let [a, b, c] = *corners;
        for number in start..end {
            let point = self.points[number];
            let areas = [area(b, c, point), area(c, a, point), area(a, b, point)];
            if areas.iter().all(|&it| it >= 0.0) {
                found(number, areas);
            }
        }
    }
}

/// Whether a rectangle is surely beside a triangle: on the right of a side, or not where the triangle is along an axis.
fn is_outside(corners: &[[f32; 3]; 3], around: [[f32; 2]; 2]) -> bool {
    let is_beside = |(axis, [low, high]): (usize, [f32; 2])| {
        let along = corners.map(|it| it[axis]);
        along.iter().all(|&it| it < low) || along.iter().all(|&it| it > high)
    };
    if [0, 2].into_iter().zip(around).any(is_beside) {
        return true;
    }
    let [a, b, c] = *corners;
    let [xs, zs] = around;
    // The corner of the rectangle that is farthest to the left decides.
    [[a, b], [b, c], [c, a]].iter().any(|[from, to]| {
        let x = xs[usize::from(to[2] > from[2])];
        let z = zs[usize::from(to[0] <= from[0])];
        turn(*from, *to, [x, 0.0, z]).is_lt()
    })
}

/// Parts of an area that may be lost.
pub(super) const LOST: f64 = 1.0 / (1_u64 << 41) as f64;

/// Twice the area of a triangle seen from above, above 0 if it is counter-clockwise. The sign and 0 are exact, the rest but for [`LOST`] of it.
fn area(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> f64 {
    let [[ax, _, az], [bx, _, bz], [cx, _, cz]] = [a, b, c].map(|it| it.map(f64::from));
    let [first, second] = [(bz - az) * (cx - ax), (bx - ax) * (cz - az)];
    let area = first - second;
    match area.abs() * LOST > AREA_ROUNDING * (first.abs() + second.abs()) {
        true => area,
        false => exact_area(a, b, c),
    }
}
