//! Flips of edges until the inner vertices have four to eight neighbours.

use super::delaunay::{Quad, Triangulation};

const LEAST: usize = 4;
const MOST: usize = 8;

/// Flips edges until each vertex after the first `boundary` has a degree in the range; whether that came
/// about. Every flip brings the degrees nearer to the range, so there are few.
pub(super) fn put_in_range(mesh: &mut Triangulation, boundary: usize) -> bool {
    let mut degrees = vec![0_usize; mesh.point_count()];
    // An inner vertex has as many faces as neighbours; of those on the boundary nothing is asked.
    for &corner in mesh.faces().as_flattened() {
        degrees[corner] += 1;
    }
    let missing = |vertex: usize, degree: usize| match vertex < boundary {
        true => 0,
        false => LEAST.saturating_sub(degree) + degree.saturating_sub(MOST),
    };

    let mut gains = |_: &Triangulation, quad: &Quad| {
        let [a, b, c, d] = quad.corners;
        let after = [
            (a, degrees[a] + 1),
            (d, degrees[d] + 1),
            (b, degrees[b] - 1),
            (c, degrees[c] - 1),
        ];
        let before = quad.corners.map(|vertex| missing(vertex, degrees[vertex]));
        let sum_after: usize = after
            .map(|(vertex, degree)| missing(vertex, degree))
            .iter()
            .sum();
        let is_better = sum_after < before.iter().sum();
        if is_better {
            after
                .into_iter()
                .for_each(|(vertex, degree)| degrees[vertex] = degree);
        }
        is_better
    };
    while mesh.flip_where(&mut gains) > 0 {}
    (0..degrees.len()).all(|vertex| missing(vertex, degrees[vertex]) == 0)
}

#[cfg(test)]
mod tests {
    use super::super::{BOUNDARY, VERTICES, points};
    use super::*;

    #[test]
    fn most_meshes_get_there_by_few_flips() {
        let mut in_range = 0;
        for seed in 1..=20 {
            let before = Triangulation::of_disk(points(VERTICES, BOUNDARY, seed), BOUNDARY);
            let mut after = before.clone();
            if put_in_range(&mut after, BOUNDARY) {
                in_range += 1;
            }
            let faces = before.faces().iter().zip(after.faces());
            let changed = faces.filter(|(before, after)| before != after).count();
            assert!(changed < 200, "{changed}");
        }
        assert!(in_range >= 15, "{in_range}");
    }
}
