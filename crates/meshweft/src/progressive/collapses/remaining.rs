//! The mesh while it is simplified: faces, and the corners at each point.

use crate::index::index32;

/// Stands for no corner, no face and no point.
pub(super) const NONE: u32 = u32::MAX;

/// Faces that lose corners and leave. A point is named by the first vertex at its position.
#[derive(Debug)]
pub(super) struct RemainingMesh<'a> {
    positions: &'a [[f32; 3]],
    /// The three points of each face; the first one is [`NONE`] once it left.
    points: Vec<[u32; 3]>,
    /// The three vertices of each face; empty where every point has one vertex.
    sides: Vec<[u32; 3]>,
    /// How many corners name each vertex; empty as the sides.
    uses: Vec<u32>,
    /// The next corner at the same point, of each corner. Corners of faces that left are taken out when
    /// they are met.
    next: Vec<u32>,
    /// The first corner at each point.
    first: Vec<u32>,
    live_faces: usize,
}

/// A face at a point, seen from there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FanFace {
    /// The corner at the point: three times the face, and 0, 1 or 2.
    pub(super) corner: u32,
    /// The points of the two corners that follow.
    pub(super) ring: [u32; 2],
}

impl FanFace {
    pub(super) fn face(self) -> u32 {
        self.corner / 3
    }

    /// The two corners that follow.
    pub(super) fn others(self) -> [u32; 2] {
        let first = self.corner - self.corner % 3;
        [1, 2].map(|turn| first + (self.corner % 3 + turn) % 3)
    }

    /// The corner of the face at another point.
    pub(super) fn corner_at(self, point: u32) -> Option<u32> {
        let slot = self.ring.iter().position(|&it| it == point)?;
        Some(self.others()[slot])
    }
}

impl<'a> RemainingMesh<'a> {
    /// `faces` name vertices, `point_of` has the point of each. Faces with two corners at one point are
    /// left out from the beginning.
    pub(super) fn new(positions: &'a [[f32; 3]], faces: &[[u32; 3]], point_of: &[u32]) -> Self {
        let is_point = |&vertex: &u32| point_of[vertex as usize] == vertex;
        let is_seamless = faces.as_flattened().iter().all(is_point);
        let mut points = faces.to_vec();
        let (mut sides, mut uses) = (Vec::new(), Vec::new());
        if !is_seamless {
            uses.resize(positions.len(), 0);
            sides.extend_from_slice(faces);
            for corner in points.as_flattened_mut() {
                *corner = point_of[*corner as usize];
            }
        }

        let mut live_faces = 0;
        let mut next = vec![NONE; 3 * faces.len()];
        let mut first = vec![NONE; positions.len()];
        for face in (0..faces.len()).rev() {
            let [a, b, c] = points[face];
            if a == b || b == c || c == a {
                points[face][0] = NONE;
                continue;
            }
            live_faces += 1;
            if let Some(sides) = sides.get(face) {
                sides
                    .iter()
                    .for_each(|&side: &u32| uses[side as usize] += 1);
            }
            for slot in 0..3 {
                let corner = 3 * face + slot;
                next[corner] =
                    std::mem::replace(&mut first[points[face][slot] as usize], index32(corner));
            }
        }
        Self {
            positions,
            points,
            sides,
            uses,
            next,
            first,
            live_faces,
        }
    }

    /// How many faces are left.
    pub(super) fn live_faces(&self) -> usize {
        self.live_faces
    }

    /// How many points there were.
    pub(super) fn point_count(&self) -> usize {
        self.positions.len()
    }

    /// How many faces there were.
    pub(super) fn face_count(&self) -> u32 {
        index32(self.points.len())
    }

    pub(super) fn is_live(&self, face: u32) -> bool {
        self.points[face as usize][0] != NONE
    }

    pub(super) fn points(&self, face: u32) -> [u32; 3] {
        self.points[face as usize]
    }

    /// The position of each point.
    pub(super) fn positions(&self) -> &'a [[f32; 3]] {
        self.positions
    }

    pub(super) fn position(&self, point: u32) -> [f64; 3] {
        self.positions[point as usize].map(f64::from)
    }

    /// The vertex at a corner.
    #[inline]
    pub(super) fn side(&self, corner: u32) -> u32 {
        let corners = match self.sides.is_empty() {
            true => &self.points,
            false => &self.sides,
        };
        corners.as_flattened()[corner as usize]
    }

    /// Whether every point has one vertex.
    pub(super) fn is_seamless(&self) -> bool {
        self.sides.is_empty()
    }

    /// Whether a face has a vertex; asked where points have several.
    pub(super) fn is_side_used(&self, side: u32) -> bool {
        self.uses.get(side as usize).is_none_or(|&uses| uses > 0)
    }

    /// Puts the vertices at a point into `sides`, sorted: those of its first faces, up to a number of them.
    pub(super) fn put_sides(&mut self, point: u32, faces: usize, sides: &mut Vec<u32>) {
        sides.clear();
        self.visit(point, |face| {
            sides.push(face.corner);
            sides.len() < faces
        });
        for side in &mut *sides {
            *side = self.side(*side);
        }
        sides.sort_unstable();
        sides.dedup();
    }

    pub(super) fn is_used(&self, point: u32) -> bool {
        let mut corner = self.first[point as usize];
        while corner != NONE && !self.is_live(corner / 3) {
            corner = self.next[corner as usize];
        }
        corner != NONE
    }

    /// Calls `visit` with the faces at a point until it returns `false`; returns whether it saw all.
    #[inline]
    pub(super) fn visit(&mut self, point: u32, mut visit: impl FnMut(FanFace) -> bool) -> bool {
        let mut before = NONE;
        let mut corner = self.first[point as usize];
        while corner != NONE {
            let next = self.next[corner as usize];
            let (face, slot) = (corner / 3, corner % 3);
            let points = self.points[face as usize];
            if points[0] == NONE {
                // Taken out of the list.
                match before {
                    NONE => self.first[point as usize] = next,
                    before => self.next[before as usize] = next,
                }
            } else {
                before = corner;
                let ring = match slot {
                    0 => [points[1], points[2]],
                    1 => [points[2], points[0]],
                    _ => [points[0], points[1]],
                };
                if !visit(FanFace { corner, ring }) {
                    return false;
                }
            }
            corner = next;
        }
        true
    }

    /// Takes a face away.
    pub(super) fn remove(&mut self, face: u32) {
        debug_assert!(self.is_live(face), "a face leaves once");
        self.points[face as usize][0] = NONE;
        self.live_faces -= 1;
        if let Some(sides) = self.sides.get(face as usize) {
            sides.iter().for_each(|&side| self.uses[side as usize] -= 1);
        }
    }

    /// Moves a corner to another point and vertex.
    pub(super) fn set_corner(&mut self, corner: u32, point: u32, side: u32) {
        self.points.as_flattened_mut()[corner as usize] = point;
        if !self.sides.is_empty() {
            let before = &mut self.sides.as_flattened_mut()[corner as usize];
            self.uses[*before as usize] -= 1;
            self.uses[side as usize] += 1;
            *before = side;
        }
        self.next[corner as usize] = std::mem::replace(&mut self.first[point as usize], corner);
    }

    /// A point has no corners any more.
    pub(super) fn forget(&mut self, point: u32) {
        self.first[point as usize] = NONE;
    }
}
