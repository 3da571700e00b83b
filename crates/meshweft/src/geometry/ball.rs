//! The smallest ball around points.

use super::double::{add, dot, scaled, sub};

/// All points at most this far from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Where the middle is.
    pub center: [f64; 3],
    /// How far the farthest point is from it, rounded up.
    pub radius: f64,
}

/// So often a point farther than all before is sought at most: mostly about ten times are enough.
const MOST_ROUNDS: usize = 100;

/// What rounding may do to a distance, in parts of it.
const ROUNDING: f64 = 1e-14;

impl Ball {
    /// The smallest ball around some points, within rounding; `None` without points that are finite, the only ones that
    /// count.
    ///
    /// Welzl's ball of few points, to which the farthest point outside is added until there is none (B. Gärtner,
    /// *Fast and robust smallest enclosing balls*, 1999). Wherever that ends, the radius is measured: every point is inside.
    ///
    /// # Complexity
    /// Time O(points) for about ten looks at each, space O(1).
    #[must_use]
    pub fn around(points: impl Iterator<Item = [f64; 3]> + Clone) -> Option<Self> {
        let points = points.filter(|point| point.iter().all(|x| x.is_finite()));
        let mut few = vec![points.clone().next()?];
        let mut center = few[0];
        for _ in 0..MOST_ROUNDS {
            let sphere = smallest(&mut few, &mut Vec::new());
            center = sphere.center;
            let (far, square) = farthest(points.clone(), center);
            if square <= sphere.square * (1.0 + ROUNDING) || few.contains(&far) {
                break;
            }
            few.insert(0, far);
        }
        let (_, square) = farthest(points, center);
        Some(Self {
            center,
            radius: square.sqrt() * (1.0 + ROUNDING),
        })
    }
}

/// The point farthest from a center, and the square of how far it is.
fn farthest(points: impl Iterator<Item = [f64; 3]>, center: [f64; 3]) -> ([f64; 3], f64) {
    let mut found = (center, 0.0);
    for point in points {
        let square = square_of(sub(point, center));
        if square > found.1 {
            found = (point, square);
        }
    }
    found
}

fn square_of(way: [f64; 3]) -> f64 {
    dot(way, way)
}

/// A sphere by the square of its radius, which is below 0 if nothing is on it.
#[derive(Debug, Clone, Copy)]
struct Sphere {
    center: [f64; 3],
    square: f64,
}

/// The smallest sphere around some points that goes through others, at most four; those that matter come to the
/// front.
fn smallest(points: &mut [[f64; 3]], on: &mut Vec<[f64; 3]>) -> Sphere {
    let mut sphere = through(on).unwrap_or(Sphere {
        center: [0.0; 3],
        square: -1.0,
    });
    if on.len() == 4 {
        return sphere;
    }
    for place in 0..points.len() {
        let point = points[place];
        if square_of(sub(point, sphere.center)) <= sphere.square * (1.0 + ROUNDING) {
            continue;
        }
        // It is on the sphere, or it depends on those that are.
        on.push(point);
        if through(on).is_some() {
            let larger = smallest(&mut points[..place], on);
            if larger.square > sphere.square {
                sphere = larger;
                points[..=place].rotate_right(1);
            }
        }
        on.pop();
    }
    sphere
}

/// The smallest sphere through up to four points; `None` for none, or if one depends on the others.
fn through(on: &[[f64; 3]]) -> Option<Sphere> {
    let (&first, rest) = on.split_first()?;
    // The center is first + Σ aᵢ edgeᵢ with 2 edgeᵢ · (center − first) = edgeᵢ².
    let mut edges = [[0.0; 3]; 3];
    for (edge, &point) in edges.iter_mut().zip(rest) {
        *edge = sub(point, first);
    }
    let count = rest.len();
    let mut rows = [[0.0; 4]; 3];
    for i in 0..count {
        for j in 0..count {
            rows[i][j] = 2.0 * dot(edges[i], edges[j]);
        }
        rows[i][3] = square_of(edges[i]);
    }

    let parts = solved(&mut rows[..count])?;
    let mut way = [0.0; 3];
    for i in 0..count {
        way = add(way, scaled(edges[i], parts[i]));
    }
    Some(Sphere {
        center: add(first, way),
        square: square_of(way),
    })
}

/// The solution of up to three equations, the right side last in each row; `None` if there is not one.
fn solved(rows: &mut [[f64; 4]]) -> Option<[f64; 3]> {
    let count = rows.len();
    let largest = |rows: &[[f64; 4]]| {
        rows.iter()
            .flatten()
            .fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    let least = largest(rows) * 1e-13;
    for step in 0..count {
        let pivot =
            (step..count).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()))?;
        rows.swap(step, pivot);
        if rows[step][step].abs() <= least {
            return None;
        }
        for below in step + 1..count {
            let factor = rows[below][step] / rows[step][step];
            let row = rows[step];
            for (entry, taken) in rows[below].iter_mut().zip(row).skip(step) {
                *entry -= factor * taken;
            }
        }
    }
    let mut parts = [0.0; 3];
    for step in (0..count).rev() {
        let known: f64 = (step + 1..count).map(|j| rows[step][j] * parts[j]).sum();
        parts[step] = (rows[step][3] - known) / rows[step][step];
    }
    Some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// By trying all spheres through up to four points.
    fn by_trying(points: &[[f64; 3]]) -> f64 {
        let count = points.len();
        let mut least = f64::INFINITY;
        for bits in 1_u32..1 << count {
            if bits.count_ones() > 4 {
                continue;
            }
            let on: Vec<_> = (0..count)
                .filter(|i| bits >> i & 1 == 1)
                .map(|i| points[i])
                .collect();
            let Some(sphere) = through(&on) else { continue };
            let is_inside = |point: &[f64; 3]| {
                square_of(sub(*point, sphere.center)) <= sphere.square * (1.0 + 1e-9) + 1e-18
            };
            if points.iter().all(is_inside) {
                least = least.min(sphere.square);
            }
        }
        least.sqrt()
    }

    #[test]
    fn balls_are_as_small_as_those_found_by_trying() {
        let mut random = SplitMix64(1);
        for case in 0..2000 {
            let count = 1 + random.below(9);
            let range = [2, 3, 1000][case % 3];
            let points: Vec<[f64; 3]> = (0..count)
                .map(|_| [(); 3].map(|()| random.below(range) as f64))
                .collect();
            let ball = Ball::around(points.iter().copied()).unwrap();
            let expected = by_trying(&points);
            assert!(
                (ball.radius - expected).abs() <= 1e-7 * (1.0 + expected),
                "{points:?}: {ball:?}, {expected}"
            );
            let far = points
                .iter()
                .map(|&point| square_of(sub(point, ball.center)).sqrt());
            assert!(far.fold(0.0, f64::max) <= ball.radius);
        }
    }

    #[test]
    fn only_finite_points_count() {
        let points = [[f64::NAN, 0.0, 0.0], [1.0, 2.0, 3.0], [f64::INFINITY; 3]];
        let ball = Ball::around(points.into_iter()).unwrap();
        assert_eq!((ball.center, ball.radius), ([1.0, 2.0, 3.0], 0.0));
        assert_eq!(Ball::around(points[..1].iter().copied()), None);
    }
}
