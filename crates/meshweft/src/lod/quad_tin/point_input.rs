//! The points that a hierarchy is over, checked.

use std::cmp::Ordering;
use std::fmt;

use super::point_lists::ListedPoint;
use super::triangle::NONE;
use crate::geometry::signs::turn;
use crate::index::index32;

/// What became of the points of an input.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct PointCounts {
    /// Points of the input.
    pub points: u32,
    /// Of these: with a coordinate that is not finite, left out.
    pub not_finite: u32,
    /// At the place of an earlier point seen from above, left out.
    pub duplicates: u32,
    /// Of the duplicates: with another height than the earlier point.
    pub disagreeing: u32,
    /// By how much heights at one place differ at most.
    pub largest_disagreement: f64,
    /// Left out because no place beside them, as `f32`, is left to cut at, or because the work was stopped.
    pub left_out: u32,
    /// How far those are from the surface at full detail, vertically.
    pub largest_left_out: f32,
    /// Vertices that are no points of the input.
    pub steiner: u32,
    /// How often a triangle is cut at most.
    pub depth: u8,
}

/// Why there is no hierarchy over points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PointsError {
    /// Fewer than three finite points at different places.
    #[non_exhaustive]
    TooFew {
        /// How many there are.
        places: usize,
    },
    /// Seen from above, all points are on one line.
    OnALine,
    /// More points or vertices than the hierarchy can number.
    TooMany,
}

impl fmt::Display for PointsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { places } => write!(
                f,
                "finite points at {places} different places, seen from above: give three or more"
            ),
            Self::OnALine => f.write_str(
                "seen from above, all points are on one line: give points of an area, with heights along y",
            ),
            Self::TooMany => f.write_str("more than 2^29 vertices: cut the points into parts"),
        }
    }
}

impl std::error::Error for PointsError {}

/// Most vertices of a hierarchy.
pub(super) const MOST_VERTICES: usize = 1 << 29;

/// Points at different places, and the rectangle around them.
#[derive(Debug, Clone)]
pub(super) struct CheckedPoints {
    /// Those that are no corners, sorted by place.
    pub(super) points: Vec<ListedPoint>,
    /// North-west, north-east, south-west, south-east; the source is [`NONE`] where there is no input point.
    pub(super) corners: [ListedPoint; 4],
    pub(super) counts: PointCounts,
}

impl CheckedPoints {
    pub(super) fn new(positions: &[[f32; 3]]) -> Result<Self, PointsError> {
        if positions.len() > MOST_VERTICES {
            return Err(PointsError::TooMany);
        }
        let (mut points, counts) = different(positions);
        let places = points.len();
        if places < 3 {
            return Err(PointsError::TooFew { places });
        }
        let [first, second] = [points[0], points[1]].map(|it| it.position);
        let is_beside = |it: &ListedPoint| turn(first, second, it.position) != Ordering::Equal;
        if !points.iter().any(is_beside) {
            return Err(PointsError::OnALine);
        }
        let corners = corners(&points);
        points.retain(|it| corners.iter().all(|corner| corner.source != it.source));
        Ok(Self {
            points,
            corners,
            counts,
        })
    }
}

/// The first finite point of each place, sorted by place; what was left out is counted.
fn different(positions: &[[f32; 3]]) -> (Vec<ListedPoint>, PointCounts) {
    let is_finite = |i: &usize| positions[*i].iter().all(|x| x.is_finite());
    let finite = (0..positions.len()).filter(is_finite);
    let mut sorted: Vec<(u64, u32)> = finite
        .map(|i| (place_key(positions[i]), index32(i)))
        .collect();
    sorted.sort_unstable();

    let mut counts = PointCounts {
        points: index32(positions.len()),
        not_finite: index32(positions.len() - sorted.len()),
        ..PointCounts::default()
    };
    let mut points = Vec::with_capacity(sorted.len());
    for same in sorted.chunk_by(|a, b| a.0 == b.0) {
        let [position, others @ ..] = same else {
            continue;
        };
        let source = position.1;
        let position = positions[source as usize];
        points.push(ListedPoint { position, source });
        counts.duplicates += index32(others.len());
        for &(_, other) in others {
            let difference = f64::from(positions[other as usize][1]) - f64::from(position[1]);
            counts.disagreeing += u32::from(difference != 0.0);
            counts.largest_disagreement = counts.largest_disagreement.max(difference.abs());
        }
    }
    (points, counts)
}

/// Equal for points at one place, and in the order of x, then z.
fn place_key([x, _, z]: [f32; 3]) -> u64 {
    let ordered = |number: f32| {
        // -0 becomes 0.
        let bits = (number + 0.0).to_bits();
        u64::from(match bits >> 31 {
            0 => bits | 1 << 31,
            _ => !bits,
        })
    };
    ordered(x) << 32 | ordered(z)
}

/// The corners of the rectangle around points: a point where there is one, else at the height of the nearest.
fn corners(points: &[ListedPoint]) -> [ListedPoint; 4] {
    let range = |axis: usize| {
        let along = points.iter().map(|it| it.position[axis]);
        along.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], it| {
            [low.min(it), high.max(it)]
        })
    };
    let [[west, east], [north, south]] = [range(0), range(2)];
    [(west, north), (east, north), (west, south), (east, south)].map(|(x, z)| {
        let distance = |it: &ListedPoint| {
            let [px, _, pz] = it.position.map(f64::from);
            let [dx, dz] = [px - f64::from(x), pz - f64::from(z)];
            dx * dx + dz * dz
        };
        let nearer = |a: &&ListedPoint, b: &&ListedPoint| {
            let by_distance = distance(a).total_cmp(&distance(b));
            by_distance.then(a.source.cmp(&b.source))
        };
        let nearest = points.iter().min_by(nearer).copied();
        let at = |position, source| ListedPoint { position, source };
        match nearest {
            Some(it) if it.position[0] == x && it.position[2] == z => it,
            Some(it) => at([x, it.position[1], z], NONE),
            None => at([x, 0.0, z], NONE),
        }
    })
}
