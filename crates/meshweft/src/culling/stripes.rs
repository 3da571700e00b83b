//! Faces in stripes by the latitude of their normals, in each by their longitude.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::eye::{Eye, EyeBox};
use super::facing::{MARGIN, normal};
use super::inner_order;
use super::ranges::Ranges;
use crate::geometry::Ball;
use crate::geometry::angle::{angle, arc_cosine};
use crate::geometry::double::{dot, scaled, widened};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::order::Optimizer;
use crate::permutation::{FaceOrder, Permutation};

/// The paper's order: stripes by the latitude of normals, from the one that points along +y to the one along −y; in each,
/// ranges by longitude, from z towards x.
///
/// Where the paper leaves room, or errs:
/// - It takes the circle of a stripe's bounding cylinder "whose intersections are closer to the viewpoint". That leaves out up to 6 %
///   of the front faces. A stripe has a bounding parallel on either side, with a radius of its own; what may be seen of all between
///   them is never more than what may be seen of the two: the wider one is taken (see [`StripedFaces::visible_ranges`]).
/// - The range in which an interval ends is drawn too: faces are known by range, not by longitude.
/// - An eye in or on the bounding sphere sees everything.
/// - Faces without an area, or with so little that rounding may have turned their normal, are in no stripe: they come last, and
///   are always drawn. So are faces with a corner that is not finite.
/// - Faces of a range stay in the order of the mesh, unless an [`optimizer`](Self::optimizer) is given: the paper has no order there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NormalStripes {
    /// *V*; `None` for the one with which the nearest sphere of the paper's Table 3 was drawn fastest.
    pub stripe_count: Option<u32>,
    /// *N*, for each stripe.
    pub range_count: u32,
    /// What puts the faces of each range in order; `None` for the order of the mesh.
    pub optimizer: Option<Optimizer>,
}

impl Default for NormalStripes {
    fn default() -> Self {
        Self {
            stripe_count: None,
            range_count: 512,
            optimizer: None,
        }
    }
}

/// The faces of the paper's spheres, and the *V* with which each was drawn fastest.
const SPHERES: [(usize, u32); 6] = [
    (1_080, 2),
    (3_968, 2),
    (16_000, 2),
    (65_000, 16),
    (261_000, 32),
    (1_056_000, 256),
];

impl NormalStripes {
    /// How many stripes a mesh gets, by its number of faces.
    #[must_use]
    pub fn stripe_count_of(&self, face_count: usize) -> u32 {
        let nearest = || {
            let spheres = SPHERES.iter();
            let nearest = spheres.min_by_key(|(faces, _)| faces.abs_diff(face_count));
            nearest.map_or(1, |&(_, stripes)| stripes)
        };
        self.stripe_count.unwrap_or_else(nearest).max(1)
    }

    /// The faces of a mesh in stripes.
    ///
    /// # Panics
    /// If the mesh has no positions, or if there were more than 2³² ranges.
    ///
    /// # Complexity
    /// Time O(vertices + faces + stripes × ranges), and what the optimizer takes; space 16 bytes a face, and 4 for each range.
    #[must_use]
    pub fn order(&self, mesh: &Mesh) -> StripedFaces {
        let (positions, faces) = (mesh.positions(), mesh.faces());
        assert!(faces.is_empty() || !positions.is_empty(), "no positions");
        let stripe_count = self.stripe_count_of(faces.len());
        let range_count = self.range_count.max(1);
        let place_count = stripe_count.checked_mul(range_count).expect("fewer ranges") as usize;

        // The place of each face.
        let mut bands = vec![Band::EMPTY; stripe_count as usize];
        let place_of = |face: &[u32; 3]| {
            let corners = face.map(|vertex| widened(positions[vertex as usize]));
            let Some([x, y, z]) = normal(corners) else {
                return index32(place_count);
            };
            let latitude = angle(y, (x * x + z * z).sqrt());
            let stripe = part_of(latitude / PI, stripe_count);
            bands[stripe as usize].add(y);
            stripe * range_count + part_of(angle(z, x) / TAU, range_count)
        };
        let places: Vec<u32> = faces.iter().map(place_of).collect();

        // Faces by place.
        let mut starts = vec![0_u32; place_count + 2];
        for &place in &places {
            starts[place as usize + 1] += 1;
        }
        for place in 0..=place_count {
            starts[place + 1] += starts[place];
        }
        let mut next = starts.clone();
        let mut new_to_old = vec![0; faces.len()];
        for (face, &place) in (0..).zip(&places) {
            let next = &mut next[place as usize];
            new_to_old[*next as usize] = face;
            *next += 1;
        }

        let order = match &self.optimizer {
            None => Permutation::from_algorithm(new_to_old).into(),
            Some(optimizer) => {
                let ranges = starts.windows(2).filter(|ends| ends[0] < ends[1]);
                let members =
                    ranges.map(|ends| new_to_old[ends[0] as usize..ends[1] as usize].to_vec());
                inner_order::of_groups(mesh, members.collect(), optimizer)
            }
        };
        StripedFaces {
            order,
            ball: Ball::around(mesh.corner_positions()),
            bands,
            range_count,
            starts,
        }
    }
}

/// In which of some equal parts of 0 to 1 a share is.
fn part_of(share: f64, parts: u32) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at least 0, and clamped"
    )]
    let part = (share * f64::from(parts)) as u32;
    part.min(parts - 1)
}

/// The cosines of latitudes that normals of a stripe have.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Band {
    low: f64,
    high: f64,
}

impl Band {
    const EMPTY: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    fn add(&mut self, cosine: f64) {
        self.low = self.low.min(cosine);
        self.high = self.high.max(cosine);
    }
}

/// Faces in stripes, and what finds those that may be seen.
#[derive(Debug, Clone, PartialEq)]
pub struct StripedFaces {
    order: FaceOrder,
    /// Around all vertices of faces; none without finite ones.
    ball: Option<Ball>,
    bands: Vec<Band>,
    range_count: u32,
    /// Where the faces of each range begin, those of the first stripe first; then where those begin that are always
    /// drawn, and how many faces there are.
    starts: Vec<u32>,
}

impl StripedFaces {
    /// The order of the faces.
    #[must_use]
    pub fn order(&self) -> &FaceOrder {
        &self.order
    }

    /// How many stripes there are, *V*.
    #[must_use]
    pub fn stripe_count(&self) -> usize {
        self.bands.len()
    }

    /// The faces of a stripe, as places of the new order.
    ///
    /// # Panics
    /// If there is no such stripe.
    #[must_use]
    pub fn faces_of(&self, stripe: usize) -> Range<usize> {
        assert!(stripe < self.stripe_count(), "stripe {stripe} of fewer");
        let start = |stripe: usize| self.starts[stripe * self.range_count as usize] as usize;
        start(stripe)..start(stripe + 1)
    }

    /// Where the faces of each range begin, as places of the new order: those of the first stripe first, then the faces that are in
    /// none, and how many faces there are.
    #[must_use]
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The smallest ball around all vertices of faces.
    #[must_use]
    pub fn ball(&self) -> Option<Ball> {
        self.ball
    }

    /// The faces that may be front faces, as ranges of the faces in their new order: all front faces are in them.
    ///
    /// With the bounding ball around *O* with radius *r*, an eye at the distance *D* in direction *d*, and `s = r / D` (0 for an
    /// orthographic view), some face with the normal *n* somewhere in the ball may be a front face only if `n · d >= −s`.
    /// On the parallel at height *y* these are the longitudes at most *w* from that of *d*, where
    /// `cos w = (−s − y d_y) / √((1 − y²)(1 − d_y²))`. Between two parallels that has one maximum and no minimum, so *w* is largest
    /// on one of them.
    ///
    /// # Complexity
    /// Time O(stripes); memory only if the ranges have too little room.
    pub fn visible_ranges<'a>(&self, eye: Eye, ranges: &'a mut Ranges) -> &'a Ranges {
        self.ranges_of(self.view(eye), ranges)
    }

    /// The faces that may be front faces for some eye in a box, as ranges of the faces in their new order: as by
    /// [`visible_ranges`](Self::visible_ranges) for the ball around the box.
    ///
    /// # Complexity
    /// As [`visible_ranges`](Self::visible_ranges).
    pub fn ranges_visible_within<'a>(&self, eyes: EyeBox, ranges: &'a mut Ranges) -> &'a Ranges {
        self.ranges_of(self.view_within(eyes), ranges)
    }

    fn ranges_of<'a>(&self, view: Option<BallView>, ranges: &'a mut Ranges) -> &'a Ranges {
        ranges.clear();
        match view {
            None => ranges.push_all(self.order.len()),
            Some(view) => {
                for (stripe, band) in (0..).zip(&self.bands) {
                    self.push_stripe(stripe, *band, &view, ranges);
                }
                let [.., always, end] = self.starts[..] else {
                    return ranges;
                };
                ranges.push(always..end);
            }
        }
        ranges
    }

    /// How an eye sees the bounding ball; `None` if it may see everything.
    fn view(&self, eye: Eye) -> Option<BallView> {
        let origin = self.ball?.center;
        self.view_of(eye.around(origin)?, [0.0; 3])
    }

    fn view_within(&self, eyes: EyeBox) -> Option<BallView> {
        let (middle, half) = eyes.middle(self.ball?.center)?;
        self.view_of(middle, half)
    }

    /// How all eyes at most half of a box from one see the ball: from directions that differ by an angle η and with the sine *s*
    /// at most, what one of them may see has `n · d >= −sin(arcsin s + η)` with the direction *d* of the middle.
    fn view_of(&self, [x, y, z, w]: [f64; 4], half: [f64; 3]) -> Option<BallView> {
        let way = [x, y, z];
        let distance = dot(way, way).sqrt();
        let moved = dot(half, half).sqrt();
        let near = self.ball?.radius * w / (distance - moved);
        let turn = moved / distance;
        // Also false for NaN.
        if !(near >= 0.0 && turn < 1.0 && near * near + turn * turn < 1.0) {
            return None;
        }
        let cosine = |sine: f64| ((1.0 - sine) * (1.0 + sine)).sqrt();
        let sine = near * cosine(turn) + turn * cosine(near) + MARGIN;
        if !(sine < 1.0 && distance > 0.0) {
            return None;
        }
        let [x, y, z] = scaled(way, 1.0 / distance);
        Some(BallView {
            sine,
            longitude: angle(z, x),
            up: y,
            across: (x * x + z * z).sqrt(),
        })
    }

    fn push_stripe(&self, stripe: u32, band: Band, view: &BallView, ranges: &mut Ranges) {
        let count = self.range_count;
        let first = (stripe * count) as usize;
        let starts = &self.starts[first..=first + count as usize];
        let mut push = |from: u32, to: u32| ranges.push(starts[from as usize]..starts[to as usize]);
        if band.low > band.high {
            return;
        }

        // How far on either side.
        let cosine = view.cosine_at(band.low).min(view.cosine_at(band.high));
        if cosine >= 1.0 {
            return;
        }
        let width = arc_cosine(cosine) + MARGIN;
        let from = view.longitude - width;
        let to = view.longitude + width;
        if cosine <= -1.0 || to - from >= TAU {
            return push(0, count);
        }

        // The ranges in which both ends are, and all between them.
        let range_of = |longitude: f64| part_of(longitude / TAU, count);
        match (from < 0.0, to >= TAU) {
            (false, false) => push(range_of(from), range_of(to) + 1),
            (true, _) => self.push_two(starts, [range_of(to), range_of(from + TAU)], ranges),
            (_, true) => self.push_two(starts, [range_of(to - TAU), range_of(from)], ranges),
        }
    }

    /// From the first range to one, and from another to the last.
    fn push_two(&self, starts: &[u32], [to, from]: [u32; 2], ranges: &mut Ranges) {
        let end = starts[self.range_count as usize];
        match to >= from {
            true => ranges.push(starts[0]..end),
            false => {
                ranges.push(starts[0]..starts[to as usize + 1]);
                ranges.push(starts[from as usize]..end);
            }
        }
    }
}

/// How an eye sees the bounding ball.
#[derive(Debug, Clone, Copy)]
struct BallView {
    /// *s*, rounded up: the ball's radius over its distance.
    sine: f64,
    longitude: f64,
    /// *d_y*, and how long the rest of *d* is.
    up: f64,
    across: f64,
}

impl BallView {
    /// The cosine of half the longitudes that may be seen on a parallel: at most −1 for all, at least 1 for none.
    fn cosine_at(&self, height: f64) -> f64 {
        let above = -self.sine - height * self.up;
        let radius = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt() * self.across;
        match above <= -radius {
            true => -1.0,
            false if above >= radius => 1.0,
            false => above / radius,
        }
    }
}
