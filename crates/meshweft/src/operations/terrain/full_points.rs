//! All heights at the places of points, and what a surface is beside them, without anything that a hierarchy knows.

use super::point_tree::{LOST, PointTree};
use super::surface_faults::{Coverage, CoveredAs, SurfaceFaults, SurfaceSides};
use crate::geometry::signs::{exact_area, turn};

/// Points, and the rectangle that a surface has to cover.
#[derive(Debug)]
pub(super) struct FullPoints {
    tree: PointTree,
    /// From west to east, from north to south.
    range: [[f32; 2]; 2],
}

/// Areas may differ by this part, of what rounding does to a sum of millions.
const AREA_DIFFERENCE: f64 = 1e-9;

impl FullPoints {
    /// The first finite point of each place.
    pub(super) fn new(points: &[[f32; 3]], range: [[f32; 2]; 2]) -> Self {
        // -0 is 0.
        let place = |number: u32| {
            let [x, _, z] = points[number as usize];
            [x + 0.0, z + 0.0]
        };
        let is_finite = |it: &u32| points[*it as usize].iter().all(|x| x.is_finite());
        let numbers = 0..crate::index::index32(points.len());
        let mut numbers: Vec<u32> = numbers.filter(is_finite).collect();
        numbers.sort_unstable_by(|&a, &b| {
            let [[x, z], [other_x, other_z]] = [place(a), place(b)];
            let by_place = x.total_cmp(&other_x).then(z.total_cmp(&other_z));
            by_place.then(a.cmp(&b))
        });
        numbers.dedup_by(|later, first| place(*later) == place(*first));
        let first = numbers.iter().map(|&it| points[it as usize]);
        Self {
            tree: PointTree::new(first.collect()),
            range,
        }
    }

    /// How many points there are.
    pub(super) fn count(&self) -> usize {
        self.tree.points().len()
    }

    /// Looks at all points below and above the faces of a surface, whose vertices are at `position`. Each is given to `measured` once, with how far it is from the surface,
    /// vertically; at a common side, to the first of the faces. What rounding may have done to a distance is taken off: less than
    /// 10^-11 of the heights in the face above that of the point and below it.
    pub(super) fn look_at(
        &self,
        position: &dyn Fn(u32) -> [f32; 3],
        faces: &[(u32, [u32; 3])],
        mut measured: impl FnMut([f32; 3], f64),
    ) -> SurfaceFaults {
        let mut coverage = Coverage::new(self.count());
        let mut faults = SurfaceFaults::default();
        let mut doubled_area = 0.0;
        for &(_, face) in faces {
            let corners = face.map(position);
            let [a, b, c] = corners;
            if !turn(a, b, c).is_gt() {
                faults.turned += 1;
                continue;
            }
            doubled_area += exact_area(a, b, c);
            self.tree.in_triangle(corners, &mut |number, areas| {
                let is_inside = areas.iter().all(|&it| it > 0.0);
                match coverage.add(number, is_inside) {
                    CoveredAs::First => {
                        let point = self.tree.points()[number];
                        measured(point, distance(corners, areas, point));
                    }
                    CoveredAs::Again => {}
                    CoveredAs::Overlapping => faults.overlaps += 1,
                }
            });
        }

        let numbers = 0..self.count();
        faults.uncovered = numbers.filter(|&it| !coverage.has(it)).count();
        faults.cracks =
            SurfaceSides::of(faces).cracks(|side| !self.is_on_the_border(side.map(position)));
        let [width, depth] = self
            .range
            .map(|[low, high]| f64::from(high) - f64::from(low));
        let full_area = 2.0 * width * depth;
        faults.has_other_area = (doubled_area - full_area).abs() > AREA_DIFFERENCE * full_area;
        faults
    }

    /// Whether a side is a part of a side of the rectangle.
    fn is_on_the_border(&self, [a, b]: [[f32; 3]; 2]) -> bool {
        [0, 2].into_iter().zip(self.range).any(|(axis, ends)| {
            let is_at = |end: f32| a[axis] == end && b[axis] == end;
            ends.into_iter().any(is_at)
        })
    }
}

/// How far a point is from a face that has it, or less by what rounding may have done. The areas are those with the sides across from the
/// corners.
fn distance(corners: [[f32; 3]; 3], areas: [f64; 3], point: [f32; 3]) -> f64 {
    let above = |corner: [f32; 3]| f64::from(corner[1]) - f64::from(point[1]);
    let [mut product, mut size] = [0.0; 2];
    for (corner, area) in corners.into_iter().zip(areas) {
        product += area * above(corner);
        size += area * above(corner).abs();
    }
    let whole: f64 = areas.iter().sum();
    (product.abs() - 4.0 * LOST * size).max(0.0) / whole
}
