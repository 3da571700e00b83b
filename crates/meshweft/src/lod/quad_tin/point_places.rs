//! At which place a diamond is cut.

use super::point_diamond::PointDiamond;
use super::point_lists::ListedPoint;
use super::triangle::NONE;
use crate::geometry::signs::{exact_area, turn};

/// How far the numbers that an `f32` can be are apart in the west or east, and in the north or south, of a terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NumberSpacing([f64; 2]);

/// A place needs this number of `f32` between it and the outer sides, or what is left beside it may be too narrow to be cut again.
const ROOM: f64 = 2.0;
/// So many lines are looked at along each axis for a place.
const LINES: i64 = 64;

impl NumberSpacing {
    pub(super) fn of(corners: &[[f32; 3]]) -> Self {
        Self([0, 2].map(|axis| {
            let largest = corners.iter().map(|it| it[axis].abs());
            let largest = largest.fold(0.0, f32::max);
            f64::from(largest) - f64::from(largest.next_down())
        }))
    }

    /// Whether a place of a diamond is inside with some room.
    fn is_roomy(self, diamond: &PointDiamond, place: [f32; 3]) -> bool {
        let Self([along_x, along_z]) = self;
        let mut sides = diamond.outer_sides();
        let is_far = sides.all(|side| {
            let [[ax, _, az], [bx, _, bz], [px, _, pz]] =
                [side[0], side[1], place].map(|it| it.map(f64::from));
            let [x, z] = [bx - ax, bz - az];
            let area = z * (px - ax) - x * (pz - az);
            area > ROOM * (z.abs() * along_x + x.abs() * along_z)
        });
        is_far && diamond.has_inside(place)
    }

    /// Where to cut: at the point in the kernel that is nearest to the middle of the common side, or at a new place in its middle. If
    /// that has no room: the same without it, and then anywhere in the kernel. `None` if there is no place.
    pub(super) fn choose<'a>(
        self,
        diamond: &PointDiamond,
        points: impl Iterator<Item = &'a ListedPoint>,
    ) -> Option<ListedPoint> {
        let steiner = |position: [f32; 3]| ListedPoint {
            position,
            source: NONE,
        };
        let [roomy, any] = self.nearest(diamond, points);
        let middle = [0, 1, 2].map(|axis| single(diamond.middle(axis)));
        let roomy = roomy.or_else(|| self.is_roomy(diamond, middle).then(|| steiner(middle)));
        let found = roomy.or(any);
        let found = found.or_else(|| diamond.has_inside(middle).then(|| steiner(middle)));
        found.or_else(|| diamond.widest_place().map(steiner))
    }

    /// Of some points in the kernel the nearest to the middle, with room and without; of equally near ones the first of the input.
    fn nearest<'a>(
        self,
        diamond: &PointDiamond,
        points: impl Iterator<Item = &'a ListedPoint>,
    ) -> [Option<ListedPoint>; 2] {
        let middle = [0, 2].map(|axis| diamond.middle(axis));
        let mut nearest = [None; 2];
        let mut least = [(f64::INFINITY, NONE); 2];
        for point in points {
            let [x, _, z] = point.position.map(f64::from);
            let away = [x - middle[0], z - middle[1]];
            let distance = (away[0] * away[0] + away[1] * away[1], point.source);
            if distance >= least[0] {
                continue;
            }
            let kind = match self.is_roomy(diamond, point.position) {
                true => 0,
                false if distance < least[1] && diamond.has_inside(point.position) => 1,
                false => continue,
            };
            least[kind] = distance;
            nearest[kind] = Some(*point);
        }
        nearest
    }
}

impl PointDiamond {
    /// A coordinate of the middle of the common side.
    fn middle(&self, axis: usize) -> f64 {
        0.5 * (f64::from(self.left[axis]) + f64::from(self.right[axis]))
    }

    /// The place in the kernel with the longest part of a line in it, of some lines across each axis; with the surface's height.
    ///
    /// If few numbers are between the corners, all lines are looked at.
    fn widest_place(&self) -> Option<[f32; 3]> {
        let mut widest = 0.0;
        let mut found = None;
        for axis in [0, 2] {
            for line in self.lines(axis) {
                let Some((width, middle)) = self.width(axis, line) else {
                    continue;
                };
                let mut place = [0.0; 3];
                place[axis] = line;
                place[2 - axis] = middle;
                if width > widest && self.has_inside(place) {
                    widest = width;
                    found = Some(place);
                }
            }
        }
        found.map(|[x, _, z]| [x, self.height([x, 0.0, z]), z])
    }

    /// Coordinates of lines across an axis through the diamond.
    fn lines(&self, axis: usize) -> impl Iterator<Item = f32> {
        let corners = self.outer_sides().map(move |it| it[0][axis]);
        let corners = corners.chain([self.right[axis], self.left[axis]]);
        let [low, high] = corners.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], it| {
            [low.min(it), high.max(it)]
        });
        let [first, last] = [low, high].map(ordinal);
        let are_few = last - first < LINES;
        let count = (last - first + 1).min(LINES);
        let [low, high] = [low, high].map(f64::from);
        (0..count).map(move |i| match are_few {
            true => from_ordinal(first + i),
            false => single(low + (i as f64 + 0.5) / count as f64 * (high - low)),
        })
    }

    /// How long the part of a line across an axis is that is in the kernel, and its middle.
    fn width(&self, axis: usize, line: f32) -> Option<(f64, f32)> {
        let other = 2 - axis;
        let sign = if axis == 0 { 1.0 } else { -1.0 };
        let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
        for side in self.outer_sides() {
            // The area of the side and a place of the line, which is above 0 on the left: first - second × (place - a).
            let [a, b] = side.map(|it| it.map(f64::from));
            let first = sign * (b[other] - a[other]) * (f64::from(line) - a[axis]);
            let second = sign * (b[axis] - a[axis]);
            let end = a[other] + first / second;
            if second > 0.0 {
                high = high.min(end);
            } else if second < 0.0 {
                low = low.max(end);
            } else if first <= 0.0 {
                return None;
            }
        }
        let is_some = low < high && low.is_finite() && high.is_finite();
        is_some.then(|| (high - low, single(0.5 * (low + high))))
    }

    /// The height of the two triangles' surface at a place.
    fn height(&self, place: [f32; 3]) -> f32 {
        let Self { left, right, .. } = *self;
        let apex = match self.far_apex {
            Some(far) if turn(left, right, place).is_lt() => far,
            _ => self.apex,
        };
        let shares = [
            exact_area(place, left, right),
            exact_area(apex, place, right),
            exact_area(apex, left, place),
        ];
        let whole: f64 = shares.iter().map(|it| it.abs()).sum();
        let heights = [apex, left, right].map(|it| f64::from(it[1]));
        let parts = shares.iter().zip(heights);
        single(
            parts
                .map(|(share, height)| share.abs() / whole * height)
                .sum(),
        )
    }
}

/// Numbers one after the other as `f32` are.
fn ordinal(number: f32) -> i64 {
    let size = i64::from((number.abs()).to_bits());
    if number < 0.0 { -size } else { size }
}

fn from_ordinal(number: i64) -> f32 {
    let size = f32::from_bits(u32::try_from(number.unsigned_abs()).unwrap_or(0));
    if number < 0 { -size } else { size }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
fn single(number: f64) -> f32 {
    number as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_found_where_the_middle_is_rounded_out_of_the_diamond() {
        // Between whole numbers, as f32 are here: the middle of the common side is rounded to one of its ends.
        let at = |x: f32, z: f32| [8_388_608.0 + x, 0.0, 8_388_608.0 + z];
        let diamond = PointDiamond {
            left: at(0.0, 0.0),
            right: at(1.0, 0.0),
            apex: at(-3.0, -7.0),
            far_apex: Some(at(5.0, 9.0)),
        };
        assert!(turn(diamond.apex, diamond.left, diamond.right).is_gt());
        let place = diamond.widest_place().unwrap();
        assert!(diamond.has_inside(place), "{place:?}");

        // A wide one of which no whole number is inside.
        let thin = PointDiamond {
            apex: at(0.0, -1.0),
            far_apex: Some(at(1.0, 1.0)),
            ..diamond
        };
        assert_eq!(thin.widest_place(), None);
        for number in [-2.5e30, -1e-45, 0.0, 1e-40, 7.0] {
            assert_eq!(from_ordinal(ordinal(number)), number);
            assert!(ordinal(number.next_up()) == ordinal(number) + 1);
        }
    }
}
