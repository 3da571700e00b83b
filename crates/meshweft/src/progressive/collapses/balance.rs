//! Collapses for a vertex hierarchy: shallow, and such that each can be undone alone.

use super::fan::{Fan, MOST_FACES, Move};
use super::remaining::{FanFace, NONE, RemainingMesh};
use crate::progressive::records::SidePair;

/// How much a removal above another one costs more.
const DEPTH_FACTOR: f64 = 2.0;
/// A removal costs at least as much as if a face of the mean area moved by this part of its size, squared: so flat places
/// leave level by level too. Where the mean area is nearly nothing, a part of the bounding box is taken for it: what lies on
/// a line gets a hierarchy as shallow as a surface has.
const LEAST_PART: f64 = 1e-8;

/// How many removals are one above the other at each point, at most.
#[derive(Debug)]
pub(super) struct HierarchyBalance {
    heights: Vec<u32>,
}

impl HierarchyBalance {
    pub(super) fn new(points: usize) -> Self {
        Self {
            heights: vec![0; points],
        }
    }

    /// The cost of a move, with what the depth of the hierarchy costs; `mean_area` is that of the faces, above 0 but for a mesh at one place.
    pub(super) fn cost(&self, point: u32, found: &Move, mean_area: f64) -> f64 {
        let height = self.height(point, found.to);
        let least = LEAST_PART * mean_area * mean_area;
        // Without an end the factor would be infinite, and nothing cheap any more.
        let factor = DEPTH_FACTOR.powi(i32::try_from(height).unwrap_or(i32::MAX).min(500));
        (found.cost + least) * factor
    }

    fn height(&self, point: u32, to: u32) -> u32 {
        self.heights[point as usize].max(self.heights[to as usize])
    }

    /// A point went into another.
    pub(super) fn removed(&mut self, point: u32, to: u32) {
        self.heights[to as usize] = 1 + self.height(point, to);
    }
}

/// Whether the vertices at a point and at the leaving faces can be told when the faces return, from those of the faces around
/// that they leave: two vertices of the point go to two, and where a seam is, a face beyond has the same vertex.
pub(super) fn can_return(
    rest: &mut RemainingMesh<'_>,
    fan: &Fan,
    to: u32,
    pairs: &[SidePair],
) -> bool {
    let is_ear = fan.faces.len() == 1;
    if rest.is_seamless() && !is_ear {
        return true;
    }
    let is_one_to_one = |pair: &SidePair| {
        pairs
            .iter()
            .all(|it| it.to != pair.to || it.from == pair.from)
    };
    pairs.iter().all(is_one_to_one)
        && fan.faces.iter().all(|&face| {
            let tip = match face.ring {
                [a, tip] if a == to => tip,
                [tip, b] if b == to => tip,
                _ => return true,
            };
            vertices_are_around(rest, fan, face, to, tip)
        })
}

/// The same of one face that leaves.
fn vertices_are_around(
    rest: &mut RemainingMesh<'_>,
    fan: &Fan,
    face: FanFace,
    to: u32,
    tip: u32,
) -> bool {
    let [Some(at_to), Some(at_tip)] = [to, tip].map(|point| face.corner_at(point)) else {
        return false;
    };
    let corners = [face.corner, at_to, at_tip].map(|corner| rest.side(corner));

    // Beyond the edge between the tip and the point.
    let mut beyond_point = None;
    for other in &fan.faces {
        if other.corner != face.corner
            && let Some(corner) = other.corner_at(tip)
        {
            beyond_point = Some([other.corner, corner].map(|corner| rest.side(corner)));
        }
    }

    // Beyond the edge between the tip and the neighbour, if the surface is a manifold there.
    let (mut beyond, mut count, mut seen) = ([NONE; 2], 0, 0);
    let is_small = rest.visit(to, |other| {
        seen += 1;
        if other.face() != face.face()
            && let Some(corner) = other.corner_at(tip)
        {
            beyond = [other.corner, corner];
            count += 1;
        }
        seen <= MOST_FACES
    });
    // Wound the other way: the tip comes after the neighbour in one of the two faces, and before it in the other.
    let comes_after = |[at, tip]: [u32; 2]| tip == at - at % 3 + (at + 1) % 3;
    let is_manifold = is_small && count == 1 && comes_after(beyond) != comes_after([at_to, at_tip]);
    let beyond_to = is_manifold.then(|| beyond.map(|corner| rest.side(corner)));
    told_from_point(corners, beyond_to, beyond_point).is_some()
}

/// Where the vertices of a face are read when it returns: whether that of the neighbour to which the point went, and that of the
/// tip, are those of the face beyond the edge between the point and the tip; or else those of the face beyond the edge between the neighbour and the tip.
/// `None` if neither has the same vertices.
///
/// The face has vertices at the point, at the neighbour and at the tip. Those beyond are given first at the neighbour, or the point, and then
/// at the tip. When the face returns, the point's corner beyond is at the neighbour.
pub(crate) fn told_from_point(
    [point, to, tip]: [u32; 3],
    beyond_to: Option<[u32; 2]>,
    beyond_point: Option<[u32; 2]>,
) -> Option<[bool; 2]> {
    let from = |[here, there]: [u32; 2], place: usize| {
        let is_beyond =
            |beyond: Option<[u32; 2]>, vertex| beyond.is_some_and(|it| it[place] == vertex);
        match () {
            () if is_beyond(beyond_to, there) => Some(false),
            () if is_beyond(beyond_point, here) => Some(true),
            () => None,
        }
    };
    Some([from([point, to], 0)?, from([tip, tip], 1)?])
}
