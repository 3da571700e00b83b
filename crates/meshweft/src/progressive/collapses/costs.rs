//! What it costs to remove a point.

use super::attributes::Lengths;
use super::fan::{Fan, Move, Precision, border};
use super::patch::Patch;
use super::remaining::RemainingMesh;
use super::settings::Collapses;
use super::sides::SidePairing;
use super::witnesses::{Witnesses, farthest_middle};
use crate::attribute::Attribute;
use crate::geometry::double::{Bounds, cross, dot, sub};
use crate::order::Effort;
use crate::progressive::records::SidePair;

/// What the square of the estimated distance from the full surface weighs, in mean areas of a face.
const HISTORY: f64 = 5.0;
/// What the square of the greatest distance of a witness weighs, in mean areas of a face.
const FARTHEST: f64 = 10.0;
/// What the mean of their squares weighs, in areas of the fan.
const MEAN: f64 = 4.0;

/// The least area of a face for what the depth of a hierarchy costs, in squares of the bounding box's diagonal: about as
/// small as positions of 24 bits can be apart.
const LEAST_AREA: f64 = 1e-15;

/// The point that is looked at, its moves, and what their costs are made of.
pub(super) struct RemovalCosts {
    /// The largest error that is allowed, and whether a point stayed because of it.
    most_error: f64,
    pub(super) is_limited: bool,
    /// How far the surface at each point may be from the full one.
    history: Vec<f32>,
    pub(super) sides: SidePairing,
    witnesses: Option<Witnesses>,
    /// The area of all faces at the beginning, twice.
    double_area: f64,
    /// The square of the bounding box's diagonal.
    extent: f64,
    /// Makes a cost that of a mesh of size 1.
    scale: f64,

    pub(super) fan: Fan,
    pub(super) moves: Vec<Move>,
    pub(super) pairs: Vec<SidePair>,
    /// The faces of the fan, and those that stay when the point moves.
    old: Patch,
    stay: Patch,
}

impl RemovalCosts {
    pub(super) fn new(
        settings: &Collapses,
        rest: &RemainingMesh<'_>,
        attributes: &[&Attribute],
    ) -> Self {
        let (points, faces) = (rest.point_count(), rest.face_count() as usize);
        let (double_area, diagonal) = size(rest);
        let lengths = Lengths::new(attributes, settings.weights, points, diagonal);
        let has_witnesses = settings.effort != Effort::Fast;
        Self {
            most_error: settings.error.into(),
            is_limited: false,
            history: vec![0.0; points],
            sides: SidePairing::new(rest, attributes, lengths, settings.cross_seams, diagonal),
            witnesses: has_witnesses.then(|| Witnesses::new(faces, points)),
            double_area,
            extent: diagonal * diagonal,
            scale: if diagonal > 0.0 {
                diagonal.powi(-4)
            } else {
                1.0
            },
            fan: Fan::default(),
            moves: Vec::new(),
            pairs: Vec::new(),
            old: Patch::default(),
            stay: Patch::default(),
        }
    }

    /// By what a removal of this cost waits for its turn.
    #[expect(clippy::cast_possible_truncation, reason = "only its octave counts")]
    pub(super) fn key(&self, cost: f64) -> f32 {
        (cost * self.scale).min(f64::from(f32::MAX)) as f32
    }

    /// Finds the faces at a point and what its moves cost at least; `false` if it has none, or too many.
    pub(super) fn look_around(&mut self, rest: &mut RemainingMesh<'_>, point: u32) -> bool {
        let is_small = self.fan.gather(rest, point);
        if is_small {
            self.find_moves(rest, point);
        }
        is_small
    }

    /// The mean area of the faces, now.
    pub(super) fn mean_area(&self, rest: &RemainingMesh<'_>) -> f64 {
        0.5 * self.double_area / rest.live_faces() as f64
    }

    /// The same, but never nearly nothing: where all faces are flat, depth still counts.
    pub(super) fn area_for_balance(&self, rest: &RemainingMesh<'_>) -> f64 {
        self.mean_area(rest).max(LEAST_AREA * self.extent)
    }

    /// What it costs that the surface is that far from the full one.
    pub(super) fn of_distance(&self, rest: &RemainingMesh<'_>, distance: f64) -> f64 {
        HISTORY * self.mean_area(rest) * distance * distance
    }

    /// The moves to all neighbours, with costs by the planes of the faces.
    fn find_moves(&mut self, rest: &RemainingMesh<'_>, point: u32) {
        self.moves.clear();
        let weight = HISTORY * self.mean_area(rest);
        let fan = &self.fan;
        let history = f64::from(self.history[point as usize]);
        let area = 0.5 * fan.double_area;
        let mut consider = |to: u32, step, [border, border_distance]: [f64; 2]| {
            let planes = fan.planes_at(step);
            let distance = if area > 0.0 {
                (planes / area).sqrt()
            } else {
                0.0
            };
            let distance = distance.max(border_distance);
            let far = history + distance;
            let base = planes + border;
            let cost = base + weight * far * far;
            if cost.is_finite() {
                self.moves.push(Move {
                    to,
                    step,
                    base,
                    cost,
                    distance,
                    precision: Precision::Planes,
                });
            }
        };

        let Some([start, end]) = fan.ends else {
            for (face, spokes) in fan.faces.iter().zip(&fan.spokes) {
                consider(face.ring[0], spokes[0], [0.0; 2]);
            }
            return;
        };

        // A border point goes along the border.
        let [Some(first), Some(last)] = [start, end].map(|end| fan.spoke(end)) else {
            return;
        };
        let (square, length) = border(first, last);
        for (to, step) in [(start, first), (end, last)] {
            let cost = square * length * dot(step, step).sqrt();
            consider(to, step, [cost, square.sqrt()]);
        }
    }

    /// Puts into the cost of a move how far the faces that stay are from the point and its attributes;
    /// `false` if it cannot be made.
    pub(super) fn measure(&mut self, rest: &mut RemainingMesh<'_>, point: u32, at: usize) -> bool {
        let found = &mut self.moves[at];
        let (to, step) = (found.to, found.step);
        found.distance = found.distance.max(self.fan.distance_after(to, step));

        // Attributes count as a distance at right angles.
        let mut difference = 0.0;
        let mut border_distance = 0.0_f64;
        if !rest.is_seamless() || self.sides.lengths.is_some() {
            let Some(price) = self.sides.pair(rest, &self.fan, to, &mut self.pairs) else {
                return false;
            };
            let lengths = self.sides.lengths.as_ref();
            let there = |it: &Lengths| it.difference(rest, &self.fan, to, step, &self.pairs);
            difference = lengths.map_or(0.0, there).max(price);
            found.base += 0.5 * self.fan.double_area * difference * difference;

            // Between two parts something shows, as it does at an open border.
            if let Some(ends) = self.sides.ends_of_border(rest, &self.fan)
                && let [Some(first), Some(last)] = ends.map(|end| self.fan.spoke(end))
            {
                let (square, length) = border(first, last);
                found.base += square * length * dot(step, step).sqrt();
                border_distance = square.sqrt();
            }
        }
        found.distance = found.distance.max(border_distance).hypot(difference);

        let far = f64::from(self.history[point as usize]) + found.distance;
        if far > self.most_error {
            self.is_limited = true;
            return false;
        }
        let (base, far_cost) = (found.base, self.of_distance(rest, far));
        let found = &mut self.moves[at];
        found.cost = base + far_cost;
        found.precision = Precision::Point;
        true
    }

    /// Finds where the vertices at the point go with a move; `false` if it cannot be made.
    pub(super) fn pair(&mut self, rest: &mut RemainingMesh<'_>, to: u32) -> bool {
        let price = self.sides.pair(rest, &self.fan, to, &mut self.pairs);
        price.is_some()
    }

    /// Whether removed points are remembered.
    pub(super) fn has_witnesses(&self) -> bool {
        self.witnesses.is_some()
    }

    pub(super) fn gather_witnesses(&mut self, rest: &RemainingMesh<'_>, point: u32) {
        if let Some(witnesses) = &mut self.witnesses {
            witnesses.gather(&self.fan, rest, point);
            self.fan.put_all(&mut self.old);
        }
    }

    /// Puts into the cost of a move how far it is between the faces that stay and what was there.
    pub(super) fn ask_witnesses(&mut self, rest: &RemainingMesh<'_>, at: usize) {
        let mean_area = self.mean_area(rest);
        let found = &mut self.moves[at];
        let (to, step) = (found.to, found.step);
        self.fan.put_staying(to, step, &mut self.stay);
        if let Some(witnesses) = &self.witnesses {
            let (farthest, mean) = witnesses.squares(&self.stay);
            let farthest = farthest.max(farthest_middle(&self.fan, &self.old, to, step));
            found.cost += FARTHEST * mean_area * farthest;
            found.cost += MEAN * 0.5 * self.fan.double_area * mean;
        }
        found.precision = Precision::Witnesses;
    }

    /// The error once the point takes a measured move; what is known of it goes to the neighbour and to the
    /// faces that stay.
    pub(super) fn remove(&mut self, point: u32, found: Move) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "an estimate")]
        let error = self.history[point as usize] + found.distance as f32;
        let history = &mut self.history[found.to as usize];
        *history = history.max(error);
        if let Some(witnesses) = &mut self.witnesses {
            self.fan.put_staying(found.to, found.step, &mut self.stay);
            witnesses.hand_over(&self.fan, &self.stay);
        }
        error
    }
}

/// Twice the area of all faces, and the diagonal of their bounding box.
fn size(rest: &RemainingMesh<'_>) -> (f64, f64) {
    let mut bounds = Bounds::default();
    let mut double_area = 0.0;
    for face in (0..rest.face_count()).filter(|&face| rest.is_live(face)) {
        let corners = rest.points(face).map(|point| rest.position(point));
        corners.iter().for_each(|&corner| bounds.add(corner));
        let [a, b, c] = corners;
        let normal = cross(sub(b, a), sub(c, a));
        let area = dot(normal, normal).sqrt();
        double_area += if area.is_finite() { area } else { 0.0 };
    }
    (double_area, bounds.diagonal())
}
