//! The point farthest in a direction that is in all of some half-spaces.

use super::double::dot;
use crate::random::SplitMix64;

/// All points `x` with `normal · x <= offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HalfSpace {
    pub(crate) normal: [f64; 3],
    pub(crate) offset: f64,
}

/// A row is what three factors may add up to at most, and that.
type Row = [f64; 4];

/// What rounding may do, in parts of the box.
const ROUNDING: f64 = 1e-12;

/// The point farthest in a direction that is in all half-spaces and in the box of all coordinates from −`reach` to `reach`,
/// within rounding; `None` if there is no such point.
///
/// R. Seidel, *Small-dimensional linear programming and convex hulls made easy*, 1991: half-spaces are added one after the
/// other, in any order; where one leaves out the best point so far, the best one is on its plane, which is the same task with
/// a coordinate less. The half-spaces change places.
///
/// # Complexity
/// Time O(half-spaces), expected; space the same.
pub(crate) fn farthest_within(
    half_spaces: &mut [HalfSpace],
    direction: [f64; 3],
    reach: f64,
) -> Option<[f64; 3]> {
    let mut random = SplitMix64(0);
    for i in (1..half_spaces.len()).rev() {
        half_spaces.swap(i, random.below(i + 1));
    }
    let mut best = direction.map(|x| reach.copysign(x));
    for i in 0..half_spaces.len() {
        let HalfSpace { normal, offset } = half_spaces[i];
        if dot(normal, best) <= offset + ROUNDING * reach {
            continue;
        }
        let rows = half_spaces[..i].iter();
        let rows = rows.map(|half| [half.normal[0], half.normal[1], half.normal[2], half.offset]);
        let plane = [normal[0], normal[1], normal[2], offset];
        best = on_plane(plane, rows, direction, 3, reach)?;
    }
    Some(best)
}

/// The best point of so many coordinates on a plane that keeps to rows.
fn on_plane(
    plane: Row,
    rows: impl Iterator<Item = Row>,
    direction: [f64; 3],
    coordinates: usize,
    reach: f64,
) -> Option<[f64; 3]> {
    // One coordinate follows from the others.
    let out = (0..coordinates).max_by(|&a, &b| plane[a].abs().total_cmp(&plane[b].abs()))?;
    if plane[out] == 0.0 {
        return None;
    }
    let without = |row: Row| {
        let factor = row[out] / plane[out];
        let mut left = [0.0; 4];
        let kept = (0..coordinates).filter(|&k| k != out);
        for (place, k) in kept.enumerate() {
            left[place] = row[k] - factor * plane[k];
        }
        left[3] = row[3] - factor * plane[3];
        left
    };

    // The box of that coordinate, then the rows.
    let mut sides = [[0.0; 4]; 2];
    for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
        side[out] = sign;
        side[3] = reach;
    }
    let rows: Vec<Row> = sides.into_iter().chain(rows).map(without).collect();
    let [x, y, z] = direction;
    let way = without([x, y, z, 0.0]);
    let left = best([way[0], way[1], way[2]], &rows, coordinates - 1, reach)?;

    let mut point = [0.0; 3];
    let kept = (0..coordinates).filter(|&k| k != out);
    let mut rest = plane[3];
    for (place, k) in kept.enumerate() {
        point[k] = left[place];
        rest -= plane[k] * left[place];
    }
    point[out] = rest / plane[out];
    Some(point)
}

fn best(direction: [f64; 3], rows: &[Row], coordinates: usize, reach: f64) -> Option<[f64; 3]> {
    if coordinates == 1 {
        return best_of_line(direction[0], rows, reach).map(|x| [x, 0.0, 0.0]);
    }
    let mut found = direction.map(|x| reach.copysign(x));
    for (i, row) in rows.iter().enumerate() {
        let at: f64 = (0..coordinates).map(|k| row[k] * found[k]).sum();
        if at <= row[3] + ROUNDING * reach {
            continue;
        }
        found = on_plane(
            *row,
            rows[..i].iter().copied(),
            direction,
            coordinates,
            reach,
        )?;
    }
    Some(found)
}

fn best_of_line(direction: f64, rows: &[Row], reach: f64) -> Option<f64> {
    let (mut low, mut high) = (-reach, reach);
    for row in rows {
        let bound = row[3] / row[0];
        match row[0] {
            factor if factor > ROUNDING => high = high.min(bound),
            factor if factor < -ROUNDING => low = low.max(bound),
            _ if row[3] < -1e3 * ROUNDING * reach => return None,
            _ => {}
        }
    }
    match low <= high + 1e3 * ROUNDING * reach {
        true if direction >= 0.0 => Some(high),
        true => Some(low),
        false => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::double::cross;

    /// By trying all corners of the half-spaces.
    fn by_trying(all: &[HalfSpace], direction: [f64; 3]) -> Option<f64> {
        let mut most = None;
        for i in 0..all.len() {
            for j in 0..i {
                for k in 0..j {
                    let [a, b, c] = [i, j, k].map(|at| all[at].normal);
                    let determinant = dot(a, cross(b, c));
                    if determinant.abs() < 1e-9 {
                        continue;
                    }
                    let parts = [(i, cross(b, c)), (j, cross(c, a)), (k, cross(a, b))];
                    let sum = |axis: usize| {
                        let terms = parts.iter().map(|(at, way)| all[*at].offset * way[axis]);
                        terms.sum::<f64>() / determinant
                    };
                    let point = [0, 1, 2].map(sum);
                    if all
                        .iter()
                        .all(|half| dot(half.normal, point) <= half.offset + 1e-9)
                    {
                        most = Some(dot(direction, point).max(most.unwrap_or(f64::MIN)));
                    }
                }
            }
        }
        most
    }

    #[test]
    fn the_best_point_is_that_of_all_corners() {
        let mut random = SplitMix64(5);
        let mut found = [0, 0];
        for _ in 0..2000 {
            let mut number = || random.below(21) as f64 / 4.0 - 2.5;
            let mut half_spaces = Vec::new();
            for _ in 0..9 {
                half_spaces.push(HalfSpace {
                    normal: [number(), number(), number()],
                    offset: number() + 1.0,
                });
            }
            half_spaces.retain(|half| half.normal != [0.0; 3]);
            let direction = [number(), number(), number()];
            let mut with_box = half_spaces.clone();
            for axis in 0..3 {
                for sign in [1.0, -1.0] {
                    let mut normal = [0.0; 3];
                    normal[axis] = sign;
                    with_box.push(HalfSpace {
                        normal,
                        offset: 10.0,
                    });
                }
            }
            let expected = by_trying(&with_box, direction);
            let point = farthest_within(&mut half_spaces, direction, 10.0);
            found[usize::from(point.is_some())] += 1;
            assert_eq!(point.is_some(), expected.is_some());
            if let (Some(point), Some(expected)) = (point, expected) {
                assert!((dot(direction, point) - expected).abs() < 1e-6);
                assert!(
                    with_box
                        .iter()
                        .all(|half| dot(half.normal, point) <= half.offset + 1e-6)
                );
            }
        }
        assert!(found.iter().all(|&count| count > 200), "{found:?}");
    }
}
