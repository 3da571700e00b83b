//! Clusters of faces, and the planes that say from where they are seen.

use std::ops::Range;

use super::eye::{Eye, EyeBox};
use super::facing::{Facing, MARGIN};
use super::planes::{self, APEX_REACH, Planes, rounded};
use super::ranges::Ranges;
use super::table_error::CullingTableError;
use crate::geometry::Ball;
use crate::geometry::double::{sub, widened};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::parallel;

/// Clusters of consecutive faces, and four planes for each: an eye behind all four sees no front face of it.
///
/// What a renderer keeps of a mesh beside its faces, 68 bytes a cluster: it needs neither positions nor normals.
#[derive(Debug, Clone, PartialEq)]
pub struct CullingTable {
    /// The origin of the planes, near the middle of the mesh.
    center: [f32; 3],
    /// How far positions are from it at most.
    reach: f32,
    /// Where the faces of each cluster begin, and how many there are.
    starts: Vec<u32>,
    groups: Vec<Group>,
}

/// The reach of a table is below it, so that nothing that is computed of it is infinite.
const MOST_REACH: f32 = f32::MAX / 32.0;

/// How many clusters are looked at together.
const LANES: usize = 8;

/// Of each plane each number, of some clusters side by side.
type Group = [[[f32; LANES]; 4]; 4];

impl CullingTable {
    /// A table for faces in clusters: cluster `i` has the faces `starts[i]..starts[i + 1]` of the mesh.
    ///
    /// # Panics
    /// If the mesh has no positions, or `starts` does not rise from 0 to the number of faces.
    ///
    /// # Complexity
    /// Time O(vertices + faces), expected; space O(faces of the largest cluster) beyond the result.
    #[must_use]
    pub fn new(mesh: &Mesh, starts: &[u32]) -> Self {
        Self::within(mesh, starts, 0.0, &[])
    }

    /// Whether planes of a mesh with that bounding ball can be told apart from rounding.
    pub(super) fn holds(ball: &Ball) -> bool {
        ball.radius > f64::from(f32::MIN_POSITIVE) && ball.radius < 0.25 * f64::from(MOST_REACH)
    }

    /// As [`new`](Self::new), of positions that may each be `position_error` from where they are said to be, as after rounding
    /// to a lattice; fewest of some `eyes` decide between planes that are as good otherwise.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    #[must_use]
    pub(super) fn within(mesh: &Mesh, starts: &[u32], position_error: f64, eyes: &[Eye]) -> Self {
        let (positions, faces) = (mesh.positions(), mesh.faces());
        assert!(faces.is_empty() || !positions.is_empty(), "no positions");
        let is_whole = starts.first() == Some(&0)
            && starts.last() == Some(&index32(faces.len()))
            && starts.is_sorted();
        assert!(is_whole, "clusters do not rise from 0 to all faces");

        // A ball around all that is used, with its center in single precision.
        let ball = Ball::around(mesh.corner_positions());
        let center = ball.map_or([0.0; 3], |ball| ball.center.map(rounded));
        let origin = widened(center);
        let reach = ball.map_or(0.0, |ball| {
            let moved = sub(ball.center, origin)
                .iter()
                .map(|x| x.abs())
                .sum::<f64>();
            (ball.radius + moved + position_error) * (1.0 + MARGIN)
        });
        let is_sound = reach > f64::from(f32::MIN_POSITIVE) && reach < 0.5 * f64::from(MOST_REACH);

        // The planes of each cluster.
        let eyes: Vec<[f64; 4]> = eyes.iter().filter_map(|eye| eye.around(origin)).collect();
        let planes_of = |range: Range<u32>| {
            let mut all = Vec::with_capacity(range.len());
            for face in &faces[range.start as usize..range.end as usize] {
                let corners = face.map(|vertex| widened(positions[vertex as usize]));
                match Facing::planes_within(corners, origin, position_error) {
                    Some(planes) if is_sound => all.extend(planes),
                    _ => return planes::ALWAYS,
                }
            }
            planes::around(&mut all, reach, &eyes)
        };
        let clusters = starts.windows(2).map(|pair| pair[0]..pair[1]);
        let clusters: Vec<Range<u32>> = clusters.collect();
        let chunks = clusters.chunks(64).collect();
        let planes = parallel::map(chunks, |chunk: &[Range<u32>]| {
            chunk
                .iter()
                .cloned()
                .map(planes_of)
                .collect::<Vec<Planes>>()
        });
        Self {
            center,
            reach: rounded(reach * (1.0 + MARGIN)),
            starts: starts.to_vec(),
            groups: grouped(&planes.concat()),
        }
    }

    /// The table of these parts, as a file has them: [`center`](Self::center), [`reach`](Self::reach),
    /// [`starts`](Self::starts) and the [`planes`](Self::planes) of each cluster. Whether it is true of a mesh is not
    /// known: a table of another mesh may leave out what is seen.
    ///
    /// # Errors
    /// No table has such parts.
    ///
    /// # Complexity
    /// Time and space O(clusters).
    pub fn from_parts(
        center: [f32; 3],
        reach: f32,
        starts: Vec<u32>,
        planes: &[[[f32; 4]; 4]],
    ) -> Result<Self, CullingTableError> {
        if starts.first() != Some(&0) || !starts.is_sorted() {
            return Err(CullingTableError::Starts);
        }
        let clusters = starts.len() - 1;
        if planes.len() != clusters {
            let found = planes.len();
            return Err(CullingTableError::Count { clusters, found });
        }
        // Also false for NaN.
        let is_in_range = (0.0..MOST_REACH).contains(&reach);
        if !is_in_range || center.iter().any(|x| !x.is_finite()) {
            return Err(CullingTableError::Ball);
        }
        let is_sound =
            |planes: &Planes| planes.iter().all(|&plane| planes::is_within(plane, reach));
        match planes.iter().position(|planes| !is_sound(planes)) {
            Some(cluster) => Err(CullingTableError::Plane { cluster }),
            None => Ok(Self {
                center,
                reach,
                starts,
                groups: grouped(planes),
            }),
        }
    }

    /// The planes of a cluster that is always drawn.
    pub const ALWAYS_DRAWN: [[f32; 4]; 4] = planes::ALWAYS;

    /// How many clusters there are.
    #[must_use]
    pub fn cluster_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Where the faces of each cluster begin, and how many faces there are.
    #[must_use]
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The origin of the planes.
    #[must_use]
    pub fn center(&self) -> [f32; 3] {
        self.center
    }

    /// How far positions are from the origin at most.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// The four planes `(x, y, z, o)` of a cluster: it may be left out if `(x, y, z) · (p − w center) + o w` is below 0, by more than
    /// rounding, for all of them.
    ///
    /// # Panics
    /// If there is no such cluster.
    #[must_use]
    pub fn planes(&self, cluster: usize) -> [[f32; 4]; 4] {
        assert!(cluster < self.cluster_count(), "no such cluster");
        let group = &self.groups[cluster / LANES];
        let lane = cluster % LANES;
        group.map(|plane| plane.map(|numbers| numbers[lane]))
    }

    /// The faces that may be front faces, as ranges of the faces: all front faces are in them.
    ///
    /// # Complexity
    /// Time O(clusters), 28 additions and multiplications each, eight clusters side by side; memory only if the ranges
    /// have too little room.
    pub fn visible_ranges<'a>(&self, eye: Eye, ranges: &'a mut Ranges) -> &'a Ranges {
        self.ranges_of::<false>(eye.around(widened(self.center)), [0.0; 3], ranges)
    }

    /// The faces that may be front faces for some eye in a box, as ranges of the faces.
    ///
    /// # Complexity
    /// As [`visible_ranges`](Self::visible_ranges), with about twice the arithmetic.
    pub fn ranges_visible_within<'a>(&self, eyes: EyeBox, ranges: &'a mut Ranges) -> &'a Ranges {
        let middle = eyes.middle(widened(self.center));
        let half = middle.map_or([0.0; 3], |(_, half)| half);
        self.ranges_of::<true>(middle.map(|(middle, _)| middle), half, ranges)
    }

    fn ranges_of<'a, const BOX: bool>(
        &self,
        eye: Option<[f64; 4]>,
        half: [f64; 3],
        ranges: &'a mut Ranges,
    ) -> &'a Ranges {
        ranges.clear();
        let view = eye.and_then(|eye| ScaledEye::new(eye, half, f64::from(self.reach)));
        let Some(view) = view else {
            ranges.push_all(*self.starts.last().unwrap_or(&0) as usize);
            return ranges;
        };
        for (words, groups) in self.groups.chunks(64 / LANES).enumerate() {
            // A bit for each cluster that is drawn.
            let mut bits = 0_u64;
            for (place, group) in groups.iter().enumerate() {
                bits |= u64::from(view.seen::<BOX>(group)) << (place * LANES);
            }
            let first = 64 * words;
            let count = (self.cluster_count() - first).min(64);
            bits &= u64::MAX >> (64 - count);

            // Runs of them.
            while bits != 0 {
                let start = bits.trailing_zeros();
                let end = start + (bits >> start).trailing_ones();
                let at = |bit: u32| self.starts[first + bit as usize];
                ranges.push(at(start)..at(end));
                bits = match end {
                    64 => 0,
                    _ => bits & (u64::MAX << end),
                };
            }
        }
        ranges
    }
}

fn grouped(planes: &[Planes]) -> Vec<Group> {
    let mut groups = vec![[[[0.0; LANES]; 4]; 4]; planes.len().div_ceil(LANES)];
    for (cluster, planes) in planes.iter().enumerate() {
        let group = &mut groups[cluster / LANES];
        for (plane, numbers) in group.iter_mut().zip(planes) {
            for (lanes, &number) in plane.iter_mut().zip(numbers) {
                lanes[cluster % LANES] = number;
            }
        }
    }
    groups
}

/// An eye relative to the origin of planes, so that none of its numbers is above 1; half of a box of them; and how far behind a plane
/// it must be.
#[derive(Debug, Clone, Copy)]
struct ScaledEye {
    eye: [f32; 4],
    half: [f32; 3],
    limit: f32,
}

impl ScaledEye {
    /// `None` if the eye says nothing.
    fn new([x, y, z, w]: [f64; 4], half: [f64; 3], reach: f64) -> Option<Self> {
        let sum = |[a, b, c]: [f64; 3]| a.abs() + b.abs() + c.abs();
        let size = sum([x, y, z]) + sum(half) + APEX_REACH * w * reach;
        // Also false for NaN.
        let is_sound =
            size > f64::MIN_POSITIVE && size < f64::MAX && reach >= f64::from(f32::MIN_POSITIVE);
        is_sound.then(|| {
            let scale = 1.0 / size;
            Self {
                eye: [x, y, z, w].map(|part| rounded(part * scale)),
                half: half.map(|part| rounded(part * scale)),
                limit: rounded(-2.0 * MARGIN),
            }
        })
    }

    /// Which clusters of a group are seen, a bit each.
    #[inline]
    fn seen<const BOX: bool>(&self, group: &Group) -> u8 {
        let [x, y, z, w] = self.eye;
        let [hx, hy, hz] = self.half;
        let mut most = [f32::NEG_INFINITY; LANES];
        for [xs, ys, zs, os] in group {
            for lane in 0..LANES {
                let mut at = xs[lane] * x + ys[lane] * y + (zs[lane] * z + os[lane] * w);
                if BOX {
                    at += xs[lane].abs() * hx + ys[lane].abs() * hy + zs[lane].abs() * hz;
                }
                // Not `f32::max`, which takes care of NaN: there is none.
                most[lane] = if at > most[lane] { at } else { most[lane] };
            }
        }
        let mut seen = 0_u32;
        for (lane, most) in most.iter().enumerate() {
            seen |= u32::from(*most >= self.limit) << lane;
        }
        #[expect(clippy::cast_possible_truncation, reason = "eight bits")]
        let seen = seen as u8;
        seen
    }
}
