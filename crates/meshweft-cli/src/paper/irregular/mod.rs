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

/// Vertices of the paper's mesh.
pub(super) const VERTICES: usize = 509;
/// Vertices on the boundary: a disk of as many and of [`VERTICES`] in all has 950 faces, as the paper's.
pub(super) const BOUNDARY: usize = 66;

/// Lattice points along each side of the square around the inner points, a power of two.
const LATTICE: u32 = 1024;
/// How far these are from each other.
const SPACING: i64 = 32;
/// Radius of the circle with the boundary.
const RADIUS: f64 = 17_500.0;
/// How many points each inner one is chosen from.
const CANDIDATES: usize = 5;

/// The mesh, drawn in the plane z = 0; the vertices of the boundary are the first, counterclockwise.
pub(super) fn irregular_mesh(seed: u64) -> Mesh {
    // Seldom the flips do not get all degrees into their range: then the next seed is taken.
    let mut made = (0..).map(|more: u64| {
        let mut mesh = Triangulation::of_disk(points(seed.wrapping_add(more)), BOUNDARY);
        degrees::put_in_range(&mut mesh, BOUNDARY).then_some(mesh)
    });
    let mesh = made.by_ref().flatten().next();
    let faces = mesh.expect("a seed without end").into_faces();

    let drawn = tutte::drawing(&faces, VERTICES, BOUNDARY);
    #[expect(clippy::cast_possible_truncation, reason = "rounded")]
    let single = drawn.into_iter().map(|[x, y]| [x as f32, y as f32, 0.0]);
    Mesh::new(single.collect::<Vec<_>>(), faces).expect("faces of these vertices")
}

/// The points of the boundary, and inside it those that are farthest from all others of five each, taken
/// at random.
fn points(seed: u64) -> Vec<[i64; 2]> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "far below the largest integer"
    )]
    let on_lattice = |x: f64| (x * RADIUS).round() as i64;
    let rim = tutte::circle(BOUNDARY).into_iter();
    let mut points: Vec<[i64; 2]> = rim.map(|point| point.map(on_lattice)).collect();

    // Each lattice point once, those in the disk.
    let order = Permutation::random((LATTICE * LATTICE) as usize, seed);
    let half = i64::from(LATTICE / 2);
    let numbers = order.new_to_old().iter();
    let mut inner = numbers
        .map(|n| [n % LATTICE, n / LATTICE].map(|i| (i64::from(i) - half) * SPACING))
        .filter(|[x, y]| x * x + y * y < (half * SPACING).pow(2));

    while points.len() < VERTICES {
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
            let mesh = irregular_mesh(seed);
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
            assert_ne!(mesh, irregular_mesh(seed + 100));
        }
        assert_eq!(irregular_mesh(1), irregular_mesh(1));
    }

    #[test]
    fn no_face_is_turned_over_in_the_drawing() {
        for seed in 1..6 {
            let mesh = irregular_mesh(seed);
            for face in mesh.faces() {
                let [a, b, c] = face.map(|v| mesh.positions()[v as usize].map(f64::from));
                let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                assert!(twice > 0.0, "{face:?}: {twice}");
                assert_eq!([a[2], b[2], c[2]], [0.0; 3]);
            }
        }
    }
}
