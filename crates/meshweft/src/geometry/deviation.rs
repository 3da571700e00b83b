//! How far two surfaces are from each other.

use std::ops::Range;

use super::double::widened;
use super::samples::Samples;
use super::surface::Surface;
use crate::parallel;

/// Points measured in one go.
const PART: usize = 1 << 13;

/// Distances from points of one surface to the nearest points of another, in the unit of the positions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Distances {
    /// The greatest: a lower bound of the Hausdorff distance, near it if there are many samples.
    pub max: f64,
    /// Their mean over the area.
    pub mean: f64,
    /// The square root of the mean of their squares over the area.
    pub rms: f64,
    /// How many points were measured.
    pub points: usize,
}

/// How far two surfaces are from each other, one way, the other way, and both together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Deviation {
    /// From the first surface to the second, and from the second to the first.
    pub one_way: [Distances; 2],
    /// The greater of the two greatest; means over the area of both.
    pub two_sided: Distances,
}

/// Measures how far two surfaces are from each other.
///
/// From every vertex in use, and from `samples` points a surface spread evenly over its area, to the
/// nearest point of the other surface. Vertices count for the greatest distance; means are over the
/// points, and over the vertices where there are none. A surface is at distance 0 from any if it has no
/// faces, and infinitely far from one without faces if it has some. What [`Surface`] leaves out is not
/// measured.
///
/// The result is the same on any platform and any number of threads.
///
/// The distances are those of P. Cignoni, C. Rocchini, R. Scopigno: *Metro: Measuring Error on
/// Simplified Surfaces*, 1998, doi:10.1111/1467-8659.00236, with points at equal steps of area.
///
/// ```
/// use meshweft::geometry::{Surface, deviation};
/// let square = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z], [1.0, 1.0, z]];
/// let faces = [[0, 1, 2], [2, 1, 3]];
/// let (low, high) = (square(0.0), square(0.25));
/// let surfaces = [&low, &high].map(|positions| Surface::new(positions, &faces));
/// let deviation = deviation(&surfaces[0], &surfaces[1], 1000);
/// assert_eq!(deviation.two_sided.max, 0.25);
/// assert!((deviation.two_sided.rms - 0.25).abs() < 1e-12);
/// ```
///
/// # Complexity
/// Time O((samples + vertices) · log faces) where the surfaces are near each other, divided by the
/// threads (feature `parallel`); space 8 bytes a face and 13 a vertex.
#[must_use]
pub fn deviation(first: &Surface<'_>, second: &Surface<'_>, samples: usize) -> Deviation {
    let ways = [(first, second), (second, first)].map(|(from, to)| way(from, to, samples));
    let one_way = ways.map(|(distances, _)| distances);

    // Means weighed by area. Surfaces without an area weigh the same, those without a point nothing.
    let area: f64 = ways.iter().map(|(_, area)| area).sum();
    let weight = |distances: &Distances, of: f64| match (distances.points, area > 0.0) {
        (0, _) => 0.0,
        (_, true) => of / area,
        (_, false) => 1.0,
    };
    let weights = ways
        .each_ref()
        .map(|(distances, of)| weight(distances, *of));
    let mean = |figure: [f64; 2]| {
        let parts = figure.into_iter().zip(weights);
        let sum: f64 = parts
            .filter(|&(_, weight)| weight > 0.0)
            .map(|(figure, weight)| figure * weight)
            .sum();
        sum / weights.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    };
    let two_sided = Distances {
        max: one_way[0].max.max(one_way[1].max),
        mean: mean(one_way.map(|it| it.mean)),
        rms: mean(one_way.map(|it| it.rms * it.rms)).sqrt(),
        points: one_way[0].points + one_way[1].points,
    };
    Deviation { one_way, two_sided }
}

/// Sums over some points.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    greatest_square: f64,
    distances: f64,
    squares: f64,
    points: usize,
}

impl Sums {
    /// From all points to the surface.
    fn of(points: impl Iterator<Item = [f64; 3]>, to: &Surface<'_>) -> Self {
        let mut sums = Self::default();
        // Points come as neighbours, so the face found last is near the next one.
        let mut near = 0;
        for point in points {
            let square = match to.len() {
                0 => f64::INFINITY,
                _ => {
                    let found = to.search(point, near);
                    near = found.place;
                    found.square
                }
            };
            sums.greatest_square = sums.greatest_square.max(square);
            sums.distances += square.sqrt();
            sums.squares += square;
            sums.points += 1;
        }
        sums
    }

    /// The same parts added in the same order, on any number of threads.
    fn in_parts(len: usize, of_part: impl Fn(Range<usize>) -> Self + Sync + Send) -> Self {
        let parts = (0..len).step_by(PART);
        let parts = parts.map(|start| start..(start + PART).min(len)).collect();
        let mut all = Self::default();
        for part in parallel::map(parts, of_part) {
            all.greatest_square = all.greatest_square.max(part.greatest_square);
            all.distances += part.distances;
            all.squares += part.squares;
            all.points += part.points;
        }
        all
    }
}

/// The distances from one surface to the other, and its area.
fn way(from: &Surface<'_>, to: &Surface<'_>, samples: usize) -> (Distances, f64) {
    let used = from.used_vertices();
    let of_vertices = Sums::in_parts(used.len(), |part| {
        Sums::of(used[part].iter().copied().map(widened), to)
    });
    let samples = Samples::new(from, samples);
    let of_area = Sums::in_parts(samples.len(), |part| Sums::of(samples.points(part), to));

    let of_means = match of_area.points {
        0 => of_vertices,
        _ => of_area,
    };
    let count = of_means.points.max(1) as f64;
    let greatest_square = of_vertices.greatest_square.max(of_area.greatest_square);
    let distances = Distances {
        max: greatest_square.sqrt(),
        mean: of_means.distances / count,
        rms: (of_means.squares / count).sqrt(),
        points: of_vertices.points + of_area.points,
    };
    (distances, samples.area())
}

#[cfg(test)]
mod tests;
