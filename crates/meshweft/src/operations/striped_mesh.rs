//! How much of a mesh faces an eye, and how much of it Kim and Lee's stripes draw: what the paper's tables count.

use crate::culling::{Eye, NormalStripes, Ranges, StripedFaces};
use crate::geometry::Ball;
use crate::geometry::double::{cross, dot, scaled, sub, widened};
use crate::mesh::Mesh;
use crate::random::SplitMix64;

/// From where a mesh is seen, as the paper says it: by the ball around the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewFrom {
    /// From the middle of the ball towards the viewer, of any length above 0.
    pub direction: [f64; 3],
    /// How far the eye is from the middle, in radii of the ball; `None` for an orthographic view.
    pub radii: Option<f64>,
}

impl ViewFrom {
    /// Directions alike in all parts of the sphere, by chance; the same ones in each call.
    #[must_use]
    pub fn uniform(count: usize, radii: Option<f64>) -> Vec<Self> {
        let mut random = SplitMix64(1);
        let mut wide = || (random.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        // Points in a ball: no sine that platforms round differently.
        let in_ball = move || loop {
            let point = [wide(), wide(), wide()];
            let square = dot(point, point);
            if (1e-6..=1.0).contains(&square) {
                return scaled(point, 1.0 / square.sqrt());
            }
        };
        let directions = std::iter::repeat_with(in_ball).take(count);
        directions
            .map(|direction| Self { direction, radii })
            .collect()
    }

    /// The eye, and how the ball is seen from it.
    fn eye(self, ball: Ball) -> (Eye, Sight) {
        #[expect(clippy::cast_possible_truncation, reason = "eyes are f32")]
        let narrowed = |point: [f64; 3]| point.map(|x| x as f32);
        let unit = scaled(self.direction, 1.0 / length(self.direction));
        match self.radii {
            None => {
                let point = narrowed(unit);
                let direction = widened(point);
                let direction = scaled(direction, 1.0 / length(direction));
                (
                    Eye::towards(point),
                    Sight {
                        direction,
                        distance: f64::INFINITY,
                    },
                )
            }
            Some(radii) => {
                let far = scaled(unit, radii * ball.radius);
                let point = narrowed([0, 1, 2].map(|axis| ball.center[axis] + far[axis]));
                let way = sub(widened(point), ball.center);
                let distance = length(way);
                let direction = scaled(way, 1.0 / distance);
                (
                    Eye::at(point),
                    Sight {
                        direction,
                        distance,
                    },
                )
            }
        }
    }
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The direction of an eye that was rounded, and how far it is from the middle of the ball.
#[derive(Debug, Clone, Copy)]
struct Sight {
    direction: [f64; 3],
    distance: f64,
}

/// The planes of a mesh's faces, which say from where each is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct FacePlanes {
    /// Normals of length 1, and how far each plane is from the middle of the ball; zeros for a face without an area.
    planes: Vec<([f64; 3], f64)>,
    ball: Ball,
}

impl FacePlanes {
    /// The planes; `None` without positions that are finite.
    ///
    /// # Complexity
    /// Time and space O(faces).
    #[must_use]
    pub fn of(mesh: &Mesh) -> Option<Self> {
        let positions = mesh.positions();
        if positions.is_empty() {
            return None;
        }
        let at = |vertex: u32| widened(positions[vertex as usize]);
        let used = mesh.faces().as_flattened().iter();
        let ball = Ball::around(used.map(|&vertex| at(vertex)))?;
        let plane = |face: &[u32; 3]| {
            let [a, b, c] = face.map(at);
            let normal = cross(sub(b, a), sub(c, a));
            let length = length(normal);
            // Also false for NaN.
            match length > 0.0 && length < f64::INFINITY {
                true => {
                    let normal = scaled(normal, 1.0 / length);
                    (normal, dot(normal, sub(a, ball.center)))
                }
                false => ([0.0; 3], 0.0),
            }
        };
        Some(Self {
            planes: mesh.faces().iter().map(plane).collect(),
            ball,
        })
    }

    /// The smallest ball around all vertices of faces.
    #[must_use]
    pub fn ball(&self) -> Ball {
        self.ball
    }

    /// Whether each face is a back face: turned away, in a plane with the eye, or without an area.
    #[must_use]
    pub fn is_back(&self, view: ViewFrom) -> Vec<bool> {
        let sight = view.eye(self.ball).1;
        let planes = self.planes.iter();
        planes.map(|plane| is_back(plane, sight)).collect()
    }

    /// How many faces are back faces.
    #[must_use]
    pub fn back_count(&self, view: ViewFrom) -> usize {
        let sight = view.eye(self.ball).1;
        let planes = self.planes.iter();
        planes.filter(|plane| is_back(plane, sight)).count()
    }

    /// How many faces stripes and ranges without a width would leave out: those whose normal is of no front face anywhere in the ball.
    #[must_use]
    pub fn beyond_count(&self, view: ViewFrom) -> usize {
        let sight = view.eye(self.ball).1;
        let sine = self.ball.radius / sight.distance;
        let is_beyond = |(normal, _): &&([f64; 3], f64)| dot(*normal, sight.direction) < -sine;
        self.planes.iter().filter(is_beyond).count()
    }

    /// The mean share of back faces over all directions, exactly: *1/2 + h / (2 D)* of each face, *h* how far its plane is
    /// from the middle of the ball, towards its front, and *D* how far the eye is, at least the radius.
    #[must_use]
    pub fn mean_back_share(&self, radii: Option<f64>) -> f64 {
        let half = radii.map_or(0.0, |radii| 0.5 / (radii * self.ball.radius));
        self.mean(|offset| 0.5 + offset * half, 1.0)
    }

    /// The mean share of [`beyond_count`](Self::beyond_count) over all directions, exactly: *(1 − s) / 2* of the faces with an area, *s*
    /// the radius over the distance.
    #[must_use]
    pub fn mean_beyond_share(&self, radii: Option<f64>) -> f64 {
        let sine = radii.map_or(0.0, |radii| 1.0 / radii);
        self.mean(|_| (1.0 - sine) / 2.0, 0.0)
    }

    /// The mean over the faces, of a number by the offset of the plane and of another where there is no plane.
    fn mean(&self, of_plane: impl Fn(f64) -> f64, of_none: f64) -> f64 {
        let numbers = self.planes.iter().map(|(normal, offset)| match normal {
            [0.0, 0.0, 0.0] => of_none,
            _ => of_plane(*offset),
        });
        numbers.sum::<f64>() / self.planes.len().max(1) as f64
    }
}

fn is_back((normal, offset): &([f64; 3], f64), sight: Sight) -> bool {
    let toward = dot(*normal, sight.direction);
    // An infinite distance times 0 is no number.
    match sight.distance == f64::INFINITY {
        true => toward <= 0.0,
        false => toward * sight.distance <= *offset,
    }
}

/// A mesh whose faces are in stripes by their normals.
///
/// ```
/// use meshweft::Mesh;
/// use meshweft::operations::{FacePlanes, StripedMesh, ViewFrom};
///
/// // A tetrahedron, seen from below: one face is turned to the eye, and of the other three one is left out.
/// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = Mesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])?;
/// let view = ViewFrom { direction: [0.0, -1.0, 0.0], radii: Some(4.0) };
/// let striped = StripedMesh::new(&mesh, Some(4), 16);
/// assert_eq!(striped.drawn(view), [[0, 2, 1], [0, 3, 2], [0, 1, 3]]);
/// assert_eq!(FacePlanes::of(&mesh).unwrap().back_count(view), 3);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct StripedMesh {
    faces: Vec<[u32; 3]>,
    striped: StripedFaces,
}

impl StripedMesh {
    /// The faces in stripes: so many, or as many as the paper gives a mesh of this size; in each so many ranges.
    ///
    /// # Panics
    /// As [`NormalStripes::order`], if the mesh has no positions, or if there were more than 2³² ranges.
    ///
    /// # Complexity
    /// That of [`NormalStripes::order`].
    #[must_use]
    pub fn new(mesh: &Mesh, stripe_count: Option<u32>, range_count: u32) -> Self {
        let stripes = NormalStripes {
            stripe_count,
            range_count,
            optimizer: None,
        };
        let striped = stripes.order(mesh);
        Self {
            faces: striped.order().apply(mesh.faces()),
            striped,
        }
    }

    /// How many stripes there are.
    #[must_use]
    pub fn stripe_count(&self) -> usize {
        self.striped.stripe_count()
    }

    /// The faces in their new order.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The stripe of each face, in the order of the mesh; `None` for faces that are always drawn.
    #[must_use]
    pub fn stripe_of_faces(&self) -> Vec<Option<usize>> {
        let mut stripes = vec![None; self.faces.len()];
        for stripe in 0..self.stripe_count() {
            let range = self.striped.faces_of(stripe);
            for &face in &self.striped.order().new_to_old()[range] {
                stripes[face as usize] = Some(stripe);
            }
        }
        stripes
    }

    /// What is drawn: ranges of the faces in their new order, each by a call.
    #[must_use]
    pub fn ranges(&self, view: ViewFrom) -> Ranges {
        let mut ranges = Ranges::default();
        // Without a ball everything is drawn, whatever the eye.
        let eye = match self.striped.ball() {
            Some(ball) => view.eye(ball).0,
            None => Eye::towards([0.0, 1.0, 0.0]),
        };
        self.striped.visible_ranges(eye, &mut ranges);
        ranges
    }

    /// The faces that are drawn, one after the other.
    #[must_use]
    pub fn drawn(&self, view: ViewFrom) -> Vec<[u32; 3]> {
        let mut drawn = Vec::new();
        for range in self.ranges(view).as_slice() {
            drawn.extend_from_slice(&self.faces[range.start as usize..range.end as usize]);
        }
        drawn
    }

    /// Whether each face is drawn, in the order of the mesh.
    #[must_use]
    pub fn is_drawn(&self, view: ViewFrom) -> Vec<bool> {
        let mut is_drawn = vec![false; self.faces.len()];
        let new_to_old = self.striped.order().new_to_old();
        for range in self.ranges(view).as_slice() {
            for &face in &new_to_old[range.start as usize..range.end as usize] {
                is_drawn[face as usize] = true;
            }
        }
        is_drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::index32;

    /// Faces anywhere, one of them without an area.
    fn soup() -> Mesh {
        let mut random = SplitMix64(7);
        let mut coordinate = || random.below(1000) as f32 / 100.0;
        let positions = (0..60).map(|_| [coordinate(), coordinate(), coordinate()]);
        let positions: Vec<[f32; 3]> = positions.collect();
        let mut faces = vec![[5, 5, 9]];
        faces.extend((0..200).map(|_| [(); 3].map(|()| index32(random.below(60)))));
        faces.retain(|[a, b, c]| *a == 5 || a != b && b != c && c != a);
        Mesh::new(positions, faces).unwrap()
    }

    /// The mean of shares, and six times its standard error.
    fn mean(shares: &[f64]) -> (f64, f64) {
        let count = shares.len() as f64;
        let mean = shares.iter().sum::<f64>() / count;
        let squares = shares.iter().map(|share| (share - mean).powi(2));
        (mean, 6.0 * squares.sum::<f64>().sqrt() / count)
    }

    #[test]
    fn means_over_directions_are_near_the_closed_forms() {
        let mesh = soup();
        let planes = FacePlanes::of(&mesh).unwrap();
        for radii in [Some(1.5), Some(4.0), None] {
            let views = ViewFrom::uniform(2000, radii);
            let of = |count: fn(&FacePlanes, ViewFrom) -> usize| {
                let counts = views.iter().map(|&view| count(&planes, view) as f64);
                mean(
                    &counts
                        .map(|count| count / mesh.face_count() as f64)
                        .collect::<Vec<_>>(),
                )
            };
            let (back, error) = of(FacePlanes::back_count);
            assert!((back - planes.mean_back_share(radii)).abs() < error);
            let (beyond, error) = of(FacePlanes::beyond_count);
            assert!((beyond - planes.mean_beyond_share(radii)).abs() < error);
        }
    }

    #[test]
    fn what_is_not_drawn_is_a_back_face_and_beyond() {
        let mesh = soup();
        let planes = FacePlanes::of(&mesh).unwrap();
        let striped = StripedMesh::new(&mesh, Some(64), 64);
        let mut left_out = 0;
        for radii in [Some(1.1), Some(4.0), None] {
            for view in ViewFrom::uniform(100, radii) {
                let is_drawn = striped.is_drawn(view);
                let is_back = planes.is_back(view);
                assert!(
                    is_drawn
                        .iter()
                        .zip(&is_back)
                        .all(|(drawn, back)| *drawn || *back)
                );
                assert!(is_back[0] && is_drawn[0], "a face without an area");
                assert_eq!(
                    is_back.iter().filter(|back| **back).count(),
                    planes.back_count(view)
                );

                let drawn = striped.drawn(view);
                assert_eq!(striped.ranges(view).face_count(), drawn.len());
                assert_eq!(is_drawn.iter().filter(|drawn| **drawn).count(), drawn.len());
                assert!(mesh.face_count() - drawn.len() <= planes.beyond_count(view));
                left_out += mesh.face_count() - drawn.len();
            }
        }
        assert!(left_out > 10_000, "{left_out}");
    }

    #[test]
    fn stripes_go_from_normals_upward_to_normals_downward() {
        let mesh = soup();
        let striped = StripedMesh::new(&mesh, Some(3), 512);
        let stripes = striped.stripe_of_faces();
        assert_eq!(stripes[0], None);
        for (face, stripe) in mesh.faces().iter().zip(stripes).skip(1) {
            let [a, b, c] = face.map(|vertex| widened(mesh.positions()[vertex as usize]));
            let normal = cross(sub(b, a), sub(c, a));
            let height = normal[1] / length(normal);
            // The cosine of 60 degrees.
            let expected = [height > 0.5, height > -0.5, true]
                .iter()
                .position(|is| *is);
            assert_eq!(stripe, expected);
        }
    }

    #[test]
    fn without_positions_there_are_no_planes() {
        let mesh = Mesh::connectivity_only(3, vec![[0, 1, 2]]).unwrap();
        assert!(FacePlanes::of(&mesh).is_none());
        let mesh = Mesh::new(vec![[f32::NAN; 3]; 3], vec![[0, 1, 2]]).unwrap();
        assert!(FacePlanes::of(&mesh).is_none());
        let ranges = StripedMesh::new(&mesh, None, 512).ranges(ViewFrom {
            direction: [1.0, 0.0, 0.0],
            radii: Some(2.0),
        });
        assert_eq!(ranges.face_count(), 1);
    }
}
