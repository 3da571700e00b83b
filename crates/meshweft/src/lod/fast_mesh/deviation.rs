//! How far a coarser surface is from the vertices that left.

use crate::geometry::double::dot;
use crate::geometry::triangle::way_to_triangle;
use crate::topology::half_edges::NONE;

/// The points that left, each with the face that was nearest when it was last looked for.
#[derive(Debug)]
pub(super) struct NearestFaces {
    /// The first point with each face, and the one after each point.
    first_of_face: Vec<u32>,
    next: Vec<u32>,
    /// Those that have to be given to other faces.
    homeless: Vec<u32>,
}

impl NearestFaces {
    pub(super) fn new(face_count: usize, point_count: usize) -> Self {
        Self {
            first_of_face: vec![NONE; face_count],
            next: vec![NONE; point_count],
            homeless: Vec::new(),
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

    /// Gives them to the nearest of some faces, which are there now; returns how far the farthest is.
    pub(super) fn give(
        &mut self,
        faces: &[(u32, [[f64; 3]; 3])],
        position: impl Fn(u32) -> [f64; 3],
    ) -> f64 {
        let mut farthest = 0.0_f64;
        for &point in &self.homeless {
            let from = position(point);
            let mut nearest = (NONE, f64::INFINITY);
            for &(face, corners) in faces {
                let way = way_to_triangle(from, corners);
                let square = dot(way, way);
                if square < nearest.1 || nearest.0 == NONE {
                    nearest = (face, square);
                }
            }
            let (face, square) = nearest;
            if face == NONE {
                continue;
            }
            farthest = farthest.max(square);
            let first = &mut self.first_of_face[face as usize];
            self.next[point as usize] = std::mem::replace(first, point);
        }
        farthest.sqrt()
    }
}
