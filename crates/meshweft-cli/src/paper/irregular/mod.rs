//! An irregular mesh like that of Bogomjakov and Gotsman's figure 3: 509 vertices and 950 faces.
//!
//! The paper does not say where its mesh is from. This one is made of points in a disk: some on its rim,
//! which give the boundary, the others at random but not near each other. They are connected by
//! Delaunay's triangulation, edges are flipped until each inner vertex has four to eight neighbours, and
//! the mesh is drawn by Tutte's embedding. Points are on a lattice of integers, so that nothing depends
//! on how numbers are rounded.

mod degrees;
mod delaunay;
mod tutte;

use meshweft::{Mesh, Permutation};

use delaunay::Triangulation;

/// Lattice points along each side of the square around the inner points, a power of two.
const LATTICE: u32 = 1024;
/// How far these are from each other.
const SPACING: i64 = 32;
/// Radius of the circle with the boundary.
const RADIUS: f64 = 17_500.0;
/// How many points each inner one is chosen from.
const CANDIDATES: usize = 5;

/// A mesh of the paper's counts, 509 and 950: as many on the boundary give as many faces.
pub(super) const VERTICES: usize = 509;
pub(super) const BOUNDARY: usize = 66;

/// An irregular disk; the vertices of the boundary are the first, counterclockwise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Irregular {
    points: Vec<[i64; 2]>,
    faces: Vec<[u32; 3]>,
    boundary: usize,
}

impl Irregular {
    /// A disk of `vertices`, of which `boundary`, at least nine, are on its boundary.
    pub(super) fn new(vertices: usize, boundary: usize, seed: u64) -> Self {
        // Seldom the flips do not get all degrees into their range: then the next seed is taken.
        let mut made = (0..).map(|more: u64| {
            let points = points(vertices, boundary, seed.wrapping_add(more));
            let mut mesh = Triangulation::of_disk(points.clone(), boundary);
            let is_in_range = degrees::put_in_range(&mut mesh, boundary);
            is_in_range.then(|| Self {
                points,
                faces: mesh.into_faces(),
                boundary,
            })
        });
        let mesh = made.by_ref().flatten().next();
        mesh.expect("a seed without end")
    }

    /// The mesh of the paper's counts.
    pub(super) fn of_the_paper() -> Self {
        Self::new(VERTICES, BOUNDARY, 1)
    }

    /// Drawn by Tutte's embedding in the circle of radius 1, in the plane z = 0.
    pub(super) fn drawing(&self) -> Mesh {
        let drawn = tutte::drawing(&self.faces, self.points.len(), self.boundary);
        self.mesh(drawn.into_iter().map(|[x, y]| [x, y, 0.0]))
    }

    /// Where the points were taken, in the circle of radius 1, on a paraboloid of height 1/2: a surface
    /// that a simplifier can tell from its approximations.
    pub(super) fn surface(&self) -> Mesh {
        let scaled = self.points.iter().map(|p| p.map(|x| x as f64 / RADIUS));
        self.mesh(scaled.map(|[x, y]| [x, y, (1.0 - x * x - y * y) / 2.0]))
    }

    fn mesh(&self, positions: impl Iterator<Item = [f64; 3]>) -> Mesh {
        #[expect(clippy::cast_possible_truncation, reason = "rounded")]
        let single = positions.map(|position| position.map(|x| x as f32));
        let positions: Vec<[f32; 3]> = single.collect();
        Mesh::new(positions, self.faces.as_slice()).expect("faces of these vertices")
    }
}

/// The points of the boundary, and inside it those that are farthest from all others of five each, taken
/// at random.
fn points(vertices: usize, boundary: usize, seed: u64) -> Vec<[i64; 2]> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "far below the largest integer"
    )]
    let on_lattice = |x: f64| (x * RADIUS).round() as i64;
    let rim = tutte::circle(boundary).into_iter();
    let mut points: Vec<[i64; 2]> = rim.map(|point| point.map(on_lattice)).collect();

    // Each lattice point once, those in the disk.
    let order = Permutation::random((LATTICE * LATTICE) as usize, seed);
    let half = i64::from(LATTICE / 2);
    let numbers = order.new_to_old().iter();
    let mut inner = numbers
        .map(|n| [n % LATTICE, n / LATTICE].map(|i| (i64::from(i) - half) * SPACING))
        .filter(|[x, y]| x * x + y * y < (half * SPACING).pow(2));

    while points.len() < vertices {
        let candidates = inner.by_ref().take(CANDIDATES);
        let room = |p: &[i64; 2]| {
            let squares = points
                .iter()
                .map(|q| (p[0] - q[0]).pow(2) + (p[1] - q[1]).pow(2));
            squares.min()
        };
        let farthest = candidates.max_by_key(room);
        points.push(farthest.expect("the lattice has far more points"));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_counts_and_degrees_of_the_paper() {
        for seed in 1..6 {
            let mesh = Irregular::new(VERTICES, BOUNDARY, seed).drawing();
            assert_eq!((mesh.vertex_count(), mesh.face_count()), (509, 950));

            // Each edge of a face is in one other face, the other way round, or on the boundary.
            let mut edges = std::collections::HashSet::new();
            for &[a, b, c] in mesh.faces() {
                for edge in [(a, b), (b, c), (c, a)] {
                    assert!(edges.insert(edge), "twice: {edge:?}");
                }
            }
            let mut rim: Vec<_> = edges
                .iter()
                .filter(|(a, b)| !edges.contains(&(*b, *a)))
                .collect();
            rim.sort();
            let around = (0..66).map(|v| (v, (v + 1) % 66));
            assert!(rim.into_iter().copied().eq(around));

            let mut degrees = vec![0; VERTICES];
            edges.iter().for_each(|&(a, _)| degrees[a as usize] += 1);
            let inner = &degrees[BOUNDARY..];
            assert!(
                inner.iter().all(|degree| (4..=8).contains(degree)),
                "{inner:?}"
            );
            // Irregular: not six nearly everywhere.
            let others = inner.iter().filter(|&&degree| degree != 6).count();
            assert!(others > 150, "{others}");
            let other = Irregular::new(VERTICES, BOUNDARY, seed + 100);
            assert_ne!(mesh, other.drawing());
        }
        let again = Irregular::new(VERTICES, BOUNDARY, 1);
        assert_eq!(Irregular::of_the_paper(), again);
    }

    #[test]
    fn no_face_is_turned_over_seen_from_above() {
        for seed in 1..6 {
            for (vertices, boundary) in [(VERTICES, BOUNDARY), (40, 12), (20, 9)] {
                let disk = Irregular::new(vertices, boundary, seed);
                for mesh in [disk.drawing(), disk.surface()] {
                    assert_eq!(mesh.face_count(), 2 * vertices - 2 - boundary);
                    for face in mesh.faces() {
                        let [a, b, c] = face.map(|v| mesh.positions()[v as usize].map(f64::from));
                        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                        assert!(twice > 0.0, "{face:?}: {twice}");
                    }
                }
            }
        }
    }
}
