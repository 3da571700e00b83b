//! The nearest point of a surface.
//!
//! A tree of boxes: a node's faces are cut in two halves across the longest side of the box of their
//! centres, down to a few faces a leaf. A search goes to the nearer half first and leaves out what is
//! farther than the nearest face so far.

use super::double::{dot, sub, widened};
use super::triangle::way_to_triangle;
use crate::index::index32;

/// Most faces of a leaf.
const LEAF: usize = 4;
/// The largest coordinate that a search takes: all products with those of faces are finite.
const FARTHEST: f64 = 1e100;
/// More levels than a tree of 2³² leaves has.
const LEVELS: usize = 64;

/// Triangles in space, arranged so that the one nearest to any point is found quickly.
///
/// Any faces will do: open, in parts, crossing each other. A face without an area is an edge or a
/// point. A face with a coordinate that is not finite is left out, and so is a vertex that no other
/// face uses.
///
/// ```
/// use meshweft::geometry::Surface;
/// let positions = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let surface = Surface::new(&positions, &[[0, 1, 2]]);
/// let nearest = surface.nearest([1.0, 1.0, 2.5]).expect("there is a face");
/// assert_eq!((nearest.face, nearest.point), (0, [1.0, 1.0, 0.0]));
/// assert_eq!(nearest.distance, 2.5);
/// ```
#[derive(Debug, Clone)]
pub struct Surface<'a> {
    positions: &'a [[f32; 3]],
    faces: &'a [[u32; 3]],
    /// The faces in the order of the leaves.
    order: Vec<u32>,
    /// Their corners, so that a leaf is read in one go.
    corners: Vec<[[f32; 3]; 3]>,
    /// The root first; none if there is no face.
    nodes: Vec<BoxNode>,
}

/// The point of a surface that is nearest to a given one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The face that it is on: of several at the same distance, the first.
    pub face: u32,
    /// Where it is.
    pub point: [f64; 3],
    /// How far it is, in the unit of the positions.
    pub distance: f64,
}

#[derive(Debug, Clone, Copy)]
struct BoxNode {
    low: [f32; 3],
    high: [f32; 3],
    /// Of a leaf the first of its faces, of any other node the first of its two children.
    first: u32,
    /// Faces of a leaf; 0 of any other node.
    len: u32,
}

/// The nearest face so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearFace {
    /// Its place in the order of the leaves.
    pub(super) place: usize,
    /// The square of its distance.
    pub(super) square: f64,
    way: [f64; 3],
}

impl<'a> Surface<'a> {
    /// The surface of these faces.
    ///
    /// # Panics
    /// If a face names a vertex that has no position, or there are more than 2³² − 1 faces.
    ///
    /// # Complexity
    /// Time O(faces · log faces), space at most 72 bytes a face.
    #[must_use]
    pub fn new(positions: &'a [[f32; 3]], faces: &'a [[u32; 3]]) -> Self {
        assert!(u32::try_from(faces.len()).is_ok(), "too many faces");
        let corners_of = |face: u32| faces[face as usize].map(|v| positions[v as usize]);
        let mut centers = Vec::with_capacity(faces.len());
        for face in 0..index32(faces.len()) {
            let corners = corners_of(face);
            if corners.as_flattened().iter().all(|x| x.is_finite()) {
                let [low, high] = bounds(corners.iter().copied());
                // Halved before they are added, as the sum may be too large.
                let center = [0, 1, 2].map(|axis| low[axis] * 0.5 + high[axis] * 0.5);
                centers.push((center, face));
            }
        }

        let nodes = tree(&mut centers, corners_of);
        let order: Vec<u32> = centers.into_iter().map(|(_, face)| face).collect();
        Self {
            positions,
            faces,
            corners: order.iter().map(|&face| corners_of(face)).collect(),
            order,
            nodes,
        }
    }

    /// The point of the surface that is nearest to `point`; `None` if there is no face, or a coordinate
    /// is not a number or beyond ±10¹⁰⁰, where products would have no room.
    ///
    /// Distances are exact to a few units in the last place of the face's size.
    ///
    /// # Complexity
    /// O(log faces) where the point is near the surface compared with its bends; never above O(faces).
    #[must_use]
    pub fn nearest(&self, point: [f64; 3]) -> Option<Nearest> {
        if self.order.is_empty() || !point.iter().all(|x| x.abs() <= FARTHEST) {
            return None;
        }
        let found = self.search(point, 0);
        Some(Nearest {
            face: self.order[found.place],
            point: [0, 1, 2].map(|axis| point[axis] + found.way[axis]),
            distance: found.square.sqrt(),
        })
    }

    /// How many faces there are, without those left out.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// The corners of each face, in the order of the leaves: what is near in space is mostly near there.
    pub(super) fn corners(&self) -> &[[[f32; 3]; 3]] {
        &self.corners
    }

    /// The vertices in use, each once, in the order of the leaves.
    pub(super) fn used_vertices(&self) -> Vec<[f32; 3]> {
        let mut is_seen = vec![false; self.positions.len()];
        let mut used = Vec::new();
        for &face in &self.order {
            for vertex in self.faces[face as usize].map(|v| v as usize) {
                if !std::mem::replace(&mut is_seen[vertex], true) {
                    used.push(self.positions[vertex]);
                }
            }
        }
        used
    }

    /// The face nearest to a point that [`nearest`](Self::nearest) takes, if there is a face, found the
    /// sooner the nearer to it the face at the place `start` is.
    pub(super) fn search(&self, point: [f64; 3], start: usize) -> NearFace {
        let mut nearest = self.near_face(point, start);
        // Nodes that wait, with the squares of their distances: at most one a level, and a last one.
        let mut waiting = [(0.0, 0_u32); LEVELS];
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let (square, node) = waiting[len];
            if square > nearest.square {
                continue;
            }
            let node = &self.nodes[node as usize];

            // The nearer child is looked at first, so it waits last.
            if node.len == 0 {
                let mut children = [node.first, node.first + 1]
                    .map(|child| (self.nodes[child as usize].square_to(point), child));
                if children[0].0 < children[1].0 {
                    children.swap(0, 1);
                }
                for child in children {
                    if child.0 <= nearest.square {
                        waiting[len] = child;
                        len += 1;
                    }
                }
                continue;
            }

            let first = node.first as usize;
            for place in first..first + node.len as usize {
                let found = self.near_face(point, place);
                let is_nearer = found.square < nearest.square
                    || found.square == nearest.square
                        && self.order[place] < self.order[nearest.place];
                if is_nearer {
                    nearest = found;
                }
            }
        }
        nearest
    }

    #[inline]
    fn near_face(&self, point: [f64; 3], place: usize) -> NearFace {
        let way = way_to_triangle(point, self.corners[place].map(widened));
        NearFace {
            place,
            square: dot(way, way),
            way,
        }
    }
}

impl BoxNode {
    /// The square of the distance to the box.
    #[inline]
    fn square_to(&self, point: [f64; 3]) -> f64 {
        let below = sub(widened(self.low), point);
        let above = sub(point, widened(self.high));
        // Not `f64::max`, which looks for NaN.
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let outside = [0, 1, 2].map(|axis| larger(larger(below[axis], above[axis]), 0.0));
        dot(outside, outside)
    }
}

/// Least and greatest coordinates.
fn bounds(points: impl Iterator<Item = [f32; 3]>) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for point in points {
        for (axis, x) in point.into_iter().enumerate() {
            bounds[0][axis] = bounds[0][axis].min(x);
            bounds[1][axis] = bounds[1][axis].max(x);
        }
    }
    bounds
}

/// Makes the nodes of a tree, and puts the faces, given by their centres, in the order of the leaves.
fn tree(
    centers: &mut [([f32; 3], u32)],
    corners_of: impl Fn(u32) -> [[f32; 3]; 3],
) -> Vec<BoxNode> {
    let mut nodes: Vec<BoxNode> = Vec::new();
    if centers.is_empty() {
        return nodes;
    }
    let placeholder = BoxNode {
        low: [0.0; 3],
        high: [0.0; 3],
        first: 0,
        len: 0,
    };
    nodes.push(placeholder);
    let mut open = vec![(0, 0..centers.len())];
    while let Some((node, range)) = open.pop() {
        let part = &mut centers[range.clone()];
        let corners = part.iter().flat_map(|&(_, face)| corners_of(face));
        let [low, high] = bounds(corners);
        let is_leaf = part.len() <= LEAF;
        nodes[node] = BoxNode {
            low,
            high,
            first: index32(if is_leaf { range.start } else { nodes.len() }),
            len: if is_leaf { index32(part.len()) } else { 0 },
        };
        if is_leaf {
            continue;
        }

        // Halves of equal size across the longest side, ties by number: the same tree everywhere.
        let [low, high] = bounds(part.iter().map(|&(center, _)| center));
        let sides = [0, 1, 2].map(|axis| high[axis] * 0.5 - low[axis] * 0.5);
        let longest = (1..3).fold(0, |best, axis| match sides[axis] > sides[best] {
            true => axis,
            false => best,
        });
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |(a, face_a), (b, face_b)| {
            a[longest].total_cmp(&b[longest]).then(face_a.cmp(face_b))
        });
        let children = nodes.len();
        nodes.extend([placeholder; 2]);
        let middle = range.start + half;
        open.push((children + 1, middle..range.end));
        open.push((children, range.start..middle));
    }
    nodes
}

#[cfg(test)]
mod tests;
