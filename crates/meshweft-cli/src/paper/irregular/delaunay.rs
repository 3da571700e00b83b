//! Delaunay's triangulation of points in a convex polygon, exactly.
//!
//! The polygon is cut into a fan, points are put in one by one, and edges are flipped until no circle
//! around a face has a point inside (C. Lawson: *Software for C1 Surface Interpolation*, 1977). A few
//! hundred points: nothing here is made for more.

/// No face across an edge: the boundary.
const NONE: usize = usize::MAX;

/// Faces in the plane, counterclockwise, that know their neighbours.
#[derive(Debug, Clone)]
pub(super) struct Triangulation {
    points: Vec<[i64; 2]>,
    faces: Vec<[usize; 3]>,
    /// For each corner the face across the opposite edge.
    across: Vec<[usize; 3]>,
}

/// Two faces and the edge between them: `[a, b, c]` and `[d, c, b]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quad {
    faces: [usize; 2],
    pub(super) corners: [usize; 4],
    /// Faces across ca and ab, db and cd.
    around: [usize; 4],
}

impl Triangulation {
    /// Delaunay's triangulation of these points. The first `boundary` of them are a strictly convex
    /// polygon, counterclockwise, all others inside it.
    pub(super) fn of_disk(points: Vec<[i64; 2]>, boundary: usize) -> Self {
        let last = boundary - 2;
        let fan = (1..=last).map(|i| [0, i, i + 1]);
        let across = (1..=last).map(|i| {
            let next = if i < last { i } else { NONE };
            let previous = if i > 1 { i - 2 } else { NONE };
            [NONE, next, previous]
        });
        let mut made = Self {
            faces: fan.collect(),
            across: across.collect(),
            points,
        };
        for point in boundary..made.points.len() {
            made.insert(point);
        }

        // Each flip lowers the surface over the points lifted to a paraboloid, so this ends.
        while made.flip_where(|made, quad| made.is_in_circle(quad)) > 0 {}
        made
    }

    /// The faces as indices of the points.
    pub(super) fn into_faces(self) -> Vec<[u32; 3]> {
        let index = |corner| u32::try_from(corner).expect("few points");
        self.faces.iter().map(|face| face.map(index)).collect()
    }

    pub(super) fn faces(&self) -> &[[usize; 3]] {
        &self.faces
    }

    pub(super) fn point_count(&self) -> usize {
        self.points.len()
    }

    /// Flips every edge for which `wanted` says so, looking at each once; how many these were. The two
    /// faces of each are a strictly convex quad.
    pub(super) fn flip_where(&mut self, mut wanted: impl FnMut(&Self, &Quad) -> bool) -> usize {
        let mut flips = 0;
        for face in 0..self.faces.len() {
            for corner in 0..3 {
                let Some(quad) = self.quad(face, corner) else {
                    continue;
                };
                if self.is_convex(&quad) && wanted(self, &quad) {
                    self.flip(&quad);
                    flips += 1;
                }
            }
        }
        flips
    }

    /// Puts a point into the face that it is in, which becomes three.
    fn insert(&mut self, point: usize) {
        let is_inside = |&[a, b, c]: &[usize; 3]| {
            [[a, b], [b, c], [c, a]]
                .iter()
                .all(|&[from, to]| self.area([from, to, point]) >= 0)
        };
        let first = self.faces.iter().position(is_inside);
        let first = first.expect("a point inside the polygon");
        let [second, third] = [self.faces.len(), self.faces.len() + 1];

        let [a, b, c] = self.faces[first];
        let [by_bc, by_ca, by_ab] = self.across[first];
        self.faces[first] = [a, b, point];
        self.faces.extend([[b, c, point], [c, a, point]]);
        self.across[first] = [second, third, by_ab];
        self.across
            .extend([[third, first, by_bc], [first, second, by_ca]]);
        self.relink(by_bc, first, second);
        self.relink(by_ca, first, third);

        // On an edge one of the three has no area, and goes with its neighbour.
        for face in [first, second, third] {
            if self.area(self.faces[face]) == 0 {
                let quad = self
                    .quad(face, 2)
                    .expect("the point is not on the boundary");
                self.flip(&quad);
            }
        }
    }

    fn quad(&self, face: usize, corner: usize) -> Option<Quad> {
        let other = self.across[face][corner];
        if other == NONE {
            return None;
        }
        let turned = |values: [usize; 3], by: usize| [0, 1, 2].map(|i| values[(i + by) % 3]);
        let [a, b, c] = turned(self.faces[face], corner);
        let [_, by_ca, by_ab] = turned(self.across[face], corner);
        let facing = self.across[other].iter().position(|&back| back == face);
        let facing = facing.expect("neighbours know each other");
        let [d, ..] = turned(self.faces[other], facing);
        let [_, by_bd, by_dc] = turned(self.across[other], facing);
        Some(Quad {
            faces: [face, other],
            corners: [a, b, c, d],
            around: [by_ca, by_ab, by_bd, by_dc],
        })
    }

    /// Replaces the edge bc by ad.
    fn flip(&mut self, quad: &Quad) {
        let [a, b, c, d] = quad.corners;
        let [first, second] = quad.faces;
        let [by_ca, by_ab, by_bd, by_dc] = quad.around;
        self.faces[first] = [a, b, d];
        self.faces[second] = [a, d, c];
        self.across[first] = [by_bd, second, by_ab];
        self.across[second] = [by_dc, by_ca, first];
        self.relink(by_bd, second, first);
        self.relink(by_ca, first, second);
    }

    /// The face has another neighbour where it had `old`.
    fn relink(&mut self, face: usize, old: usize, new: usize) {
        if face != NONE {
            let links = self.across[face].iter_mut();
            links
                .filter(|link| **link == old)
                .for_each(|link| *link = new);
        }
    }

    /// Twice the area, positive if counterclockwise.
    fn area(&self, corners: [usize; 3]) -> i64 {
        let [a, b, c] = corners.map(|corner| self.points[corner]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    fn is_convex(&self, quad: &Quad) -> bool {
        let [a, b, c, d] = quad.corners;
        self.area([a, b, d]) > 0 && self.area([a, d, c]) > 0
    }

    /// Whether the fourth corner is inside the circle around the other three.
    fn is_in_circle(&self, quad: &Quad) -> bool {
        let [a, b, c, d] = quad.corners.map(|corner| self.points[corner]);
        in_circle([a, b, c], d)
    }
}

/// Whether a point is strictly inside the circle around three, counterclockwise. Exact for coordinates of up
/// to 30 bits.
fn in_circle(corners: [[i64; 2]; 3], point: [i64; 2]) -> bool {
    let [a, b, c] = corners.map(|corner| {
        let [x, y] = [0, 1].map(|axis| i128::from(corner[axis] - point[axis]));
        [x, y, x * x + y * y]
    });
    let minor = |p: [i128; 3], q: [i128; 3]| p[0] * q[1] - p[1] * q[0];
    a[2] * minor(b, c) + b[2] * minor(c, a) + c[2] * minor(a, b) > 0
}

#[cfg(test)]
mod tests {
    use super::super::{BOUNDARY, VERTICES, points};
    use super::*;

    fn check(made: &Triangulation, boundary: usize) {
        assert_eq!(made.faces.len(), 2 * made.points.len() - 2 - boundary);
        let mut area = 0;
        for (face, corners) in made.faces.iter().enumerate() {
            assert!(made.area(*corners) > 0);
            area += made.area(*corners);
            for corner in 0..3 {
                if let Some(quad) = made.quad(face, corner) {
                    let [_, b, c, d] = quad.corners;
                    let other = made.faces[quad.faces[1]];
                    assert!([[d, c, b], [c, b, d], [b, d, c]].contains(&other));
                }
            }
            let circle = corners.map(|corner| made.points[corner]);
            let inside = made
                .points
                .iter()
                .filter(|&&point| in_circle(circle, point));
            assert_eq!(inside.count(), 0);
        }
        let polygon = (1..boundary - 1).map(|i| made.area([0, i, i + 1]));
        assert_eq!(area, polygon.sum::<i64>());
    }

    #[test]
    fn no_point_is_inside_a_circle() {
        for seed in 1..4 {
            let points = points(VERTICES, BOUNDARY, seed);
            check(&Triangulation::of_disk(points, BOUNDARY), BOUNDARY);
        }
    }

    /// A square lattice: all points on edges, on lines and on circles with others.
    #[test]
    fn points_on_lines_and_circles() {
        let mut points = vec![[-1, -1], [9, -1], [9, 9], [-1, 9]];
        points.extend((0..81).map(|i| [i % 9, i / 9]));
        check(&Triangulation::of_disk(points, 4), 4);
    }

    #[test]
    fn inside_a_circle_on_it_and_outside() {
        let circle = [[5, 0], [0, 5], [-5, 0]];
        assert!(in_circle(circle, [3, -3]));
        assert!(!in_circle(circle, [3, -4]));
        assert!(!in_circle(circle, [4, -4]));
    }
}
