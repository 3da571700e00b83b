//! The faces around a point, and what it costs to move the point onto a neighbour.

use super::patch::Patch;
use super::remaining::{FanFace, RemainingMesh};
use crate::geometry::double::{add, cross, dot, sub};
use crate::geometry::triangle::way_to_triangle;

type Vector = [f64; 3];

/// The faces at a point that may be removed.
#[derive(Debug, Default)]
pub(super) struct Fan {
    pub(super) faces: Vec<FanFace>,
    /// Of each face: the two neighbours relative to the point.
    pub(super) spokes: Vec<[Vector; 2]>,
    /// Of each face: its normal, twice as long as its area is large.
    pub(super) normals: Vec<Vector>,
    /// At a border: the neighbours before the first and after the last face.
    pub(super) ends: Option<[u32; 2]>,
    /// Twice the area of all faces.
    pub(super) double_area: f64,
    /// The sum of n nᵀ / 2 |n| over the normals n: xx, xy, xz, yy, yz, zz.
    planes: [f64; 6],
}

/// A neighbour that the point could move to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Move {
    pub(super) to: u32,
    /// Relative to the point.
    pub(super) step: Vector,
    /// What it costs, without the distance.
    pub(super) base: f64,
    pub(super) cost: f64,
    /// The distance that the surface moves, about.
    pub(super) distance: f64,
    pub(super) precision: Precision,
}

/// What the cost of a move is made of so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Precision {
    /// The planes of the faces around the point.
    Planes,
    /// And how far the point is from the faces that stay.
    Point,
    /// And how far the witnesses are.
    Witnesses,
}

impl Fan {
    /// The fan of a point whose faces are one fan, closed or open.
    /// `false` if it has no faces, or too many.
    pub(super) fn gather(&mut self, rest: &mut RemainingMesh<'_>, point: u32) -> bool {
        self.faces.clear();
        self.spokes.clear();
        self.normals.clear();
        let is_small = rest.visit(point, |face| {
            self.faces.push(face);
            self.faces.len() <= MOST_FACES
        });
        if !is_small || self.faces.is_empty() {
            return false;
        }

        let center = rest.position(point);
        let (mut planes, mut double_area) = ([0.0; 6], 0.0);
        let (mut firsts, mut lasts) = (0_u32, 0_u32);
        for face in &self.faces {
            let spokes = face.ring.map(|point| sub(rest.position(point), center));
            let normal = cross(spokes[0], spokes[1]);
            let length = dot(normal, normal).sqrt();
            if length > 0.0 {
                let [x, y, z] = normal;
                let scale = 0.5 / length;
                for (sum, product) in
                    planes
                        .iter_mut()
                        .zip([x * x, x * y, x * z, y * y, y * z, z * z])
                {
                    *sum += product * scale;
                }
            }
            double_area += length;
            self.spokes.push(spokes);
            self.normals.push(normal);
            firsts = firsts.wrapping_add(face.ring[0]);
            lasts = lasts.wrapping_add(face.ring[1]);
        }
        self.planes = planes;
        self.double_area = double_area;

        // Around a closed fan each neighbour comes first once and last once.
        self.ends = None;
        if firsts != lasts {
            let start = self
                .faces
                .iter()
                .map(|face| face.ring[0])
                .find(|&a| self.faces.iter().all(|face| face.ring[1] != a));
            let end = self
                .faces
                .iter()
                .map(|face| face.ring[1])
                .find(|&b| self.faces.iter().all(|face| face.ring[0] != b));
            self.ends = start.zip(end).map(|(start, end)| [start, end]);
        }
        true
    }

    /// A neighbour relative to the point.
    pub(super) fn spoke(&self, neighbour: u32) -> Option<Vector> {
        self.faces
            .iter()
            .zip(&self.spokes)
            .find_map(|(face, spokes)| {
                let slot = face.ring.iter().position(|&it| it == neighbour)?;
                Some(spokes[slot])
            })
    }

    /// The sum over the faces of area times the squared distance of a place, relative to the point, from
    /// the face's plane.
    pub(super) fn planes_at(&self, step: Vector) -> f64 {
        let [x, y, z] = step;
        let [xx, xy, xz, yy, yz, zz] = self.planes;
        (x * (xx * x + 2.0 * (xy * y + xz * z)) + y * (yy * y + 2.0 * yz * z) + zz * z * z).max(0.0)
    }

    /// All faces, relative to the point.
    pub(super) fn put_all(&self, patch: &mut Patch) {
        patch.clear();
        for (face, &[a, b]) in self.faces.iter().zip(&self.spokes) {
            patch.push(face.face(), [[0.0; 3], a, b]);
        }
    }

    /// The faces that stay when the point moves to a neighbour, each with its two others relative to the
    /// point.
    pub(super) fn staying(&self, to: u32) -> impl Iterator<Item = (&FanFace, &[Vector; 2])> {
        let faces = self.faces.iter().zip(&self.spokes);
        faces.filter(move |(face, _)| !face.ring.contains(&to))
    }

    /// The faces that stay once the point took this step.
    pub(super) fn put_staying(&self, to: u32, step: Vector, patch: &mut Patch) {
        patch.clear();
        for (face, &[a, b]) in self.staying(to) {
            patch.push(face.face(), [step, a, b]);
        }
    }

    /// How far the point is from the faces that stay, once it took this step; 0 if none stays.
    pub(super) fn distance_after(&self, to: u32, step: Vector) -> f64 {
        let squares = self.staying(to).map(|(_, &[a, b])| {
            let way = way_to_triangle([0.0; 3], [step, a, b]);
            dot(way, way)
        });
        squares.reduce(f64::min).unwrap_or(0.0).sqrt()
    }

    /// Whether no face that stays turns by more than 75 degrees when the point takes this step.
    pub(super) fn keeps_sides(&self, to: u32, step: Vector) -> bool {
        self.faces
            .iter()
            .zip(&self.spokes)
            .zip(&self.normals)
            .all(|((face, &[a, b]), &old)| {
                if face.ring.contains(&to) {
                    return true;
                }
                let new = add(old, cross(step, sub(a, b)));
                let (product, old_square) = (dot(new, old), dot(old, old));
                old_square == 0.0
                    || (product > 0.0 && product * product > MOST_TURN * dot(new, new) * old_square)
            })
    }
}

/// Fans of more faces are not removed, and not searched through: their points cost too much, however
/// often their neighbours leave.
pub(super) const MOST_FACES: usize = 64;
/// The squared cosine of the largest turn of a face's normal.
const MOST_TURN: f64 = 0.25 * 0.25;

/// The squared distance of a point from the border edge that takes the place of two, and its length. Both
/// neighbours are relative to the point.
pub(super) fn border(first: Vector, last: Vector) -> (f64, f64) {
    let edge = sub(last, first);
    let square = dot(edge, edge);
    let along = match square > 0.0 {
        true => (-dot(first, edge) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    let nearest = add(first, edge.map(|x| x * along));
    (dot(nearest, nearest), square.sqrt())
}
