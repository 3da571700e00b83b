//! How far a coarser surface is from the vertices that left.

use crate::geometry::triangle::{PreparedTriangle, SquareDistance};
use crate::topology::half_edges::NONE;

/// The points that left, each with the face that was nearest when it was last looked for.
#[derive(Debug)]
pub(super) struct NearestFaces {
    /// The first point with each face, and the one after each point.
    first_of_face: Vec<u32>,
    next: Vec<u32>,
    /// Those that have to be given to other faces.
    homeless: Vec<u32>,
    /// The faces that they are given to, each with the least that the square of a point's distance can be.
    around: Vec<(u32, PreparedTriangle, f64)>,
}

impl NearestFaces {
    pub(super) fn new(face_count: usize, point_count: usize) -> Self {
        Self {
            first_of_face: vec![NONE; face_count],
            next: vec![NONE; point_count],
            homeless: Vec::new(),
            around: Vec::new(),
        }
    }

    /// A point leaves, and the faces at it change: so their points have to be given to others.
    pub(super) fn take(&mut self, point: u32, faces: &[u32]) {
        self.homeless.clear();
        self.homeless.push(point);
        for &face in faces {
            let mut at = std::mem::replace(&mut self.first_of_face[face as usize], NONE);
            while at != NONE {
                self.homeless.push(at);
                at = self.next[at as usize];
            }
        }
    }

    /// The points that were given to other faces last.
    pub(super) fn given(&self) -> &[u32] {
        &self.homeless
    }

    /// Gives them to the nearest of some faces, which are there now; returns how far the farthest is.
    pub(super) fn give(
        &mut self,
        faces: &[(u32, [[f64; 3]; 3])],
        position: impl Fn(u32) -> [f64; 3],
    ) -> f64 {
        self.around.clear();
        let prepared = faces
            .iter()
            .map(|&(face, corners)| (face, PreparedTriangle::new(corners), 0.0));
        self.around.extend(prepared);
        let mut farthest = 0.0_f64;
        for &point in &self.homeless {
            let from = position(point);
            let mut nearest = (NONE, f64::INFINITY);

            // Most points are above a face; few of the others can be nearer.
            for (face, triangle, least) in &mut self.around {
                *least = match triangle.bound(from) {
                    SquareDistance::AtLeast(least) => least,
                    SquareDistance::Exact(square) => {
                        if square < nearest.1 {
                            nearest = (*face, square);
                        }
                        f64::INFINITY
                    }
                };
            }
            for &(face, ref triangle, least) in &self.around {
                if least < nearest.1 {
                    let square = triangle.square_distance(from);
                    if square < nearest.1 {
                        nearest = (face, square);
                    }
                }
            }

            // Where a corner is not finite, some face.
            let (face, square) = match (nearest, self.around.first()) {
                ((NONE, _), Some(&(face, ..))) => (face, 0.0),
                ((NONE, _), None) => continue,
                (nearest, _) => nearest,
            };
            farthest = farthest.max(square);
            let first = &mut self.first_of_face[face as usize];
            self.next[point as usize] = std::mem::replace(first, point);
        }
        farthest.sqrt()
    }
}
