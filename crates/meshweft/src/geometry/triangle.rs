//! The way from a point to the nearest point of a triangle.

use super::double::{cross, dot, scaled, sub};

/// Squares of sines below this: the triangle is taken as its three edges, as its normal says nothing.
const FLAT: f64 = 1e-24;

/// The same for triangles of which planes are used without looking at the edges.
const THIN: f64 = 1e-12;

/// The vector from `p` to the nearest point of the triangle.
///
/// A triangle without an area is its edges, an edge without a length its point. Coordinates are finite.
#[inline]
pub(crate) fn way_to_triangle(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [from_a, from_b, from_c] = [a, b, c].map(|corner| sub(p, corner));
    let [ab, bc, ca] = [sub(b, a), sub(c, b), sub(a, c)];
    let normal = cross(ca, ab);
    let square = dot(normal, normal);
    let is_flat = square <= FLAT * (dot(ab, ab) * dot(ca, ca));

    // On which side of an edge the point is, seen along the normal: inside is not negative. Products
    // with the normal, as differences of scalar products would cancel in thin triangles.
    let edges = [(from_a, ab), (from_b, bc), (from_c, ca)];
    let is_beyond = edges.map(|(from, edge)| is_flat || dot(cross(edge, from), normal) < 0.0);
    if is_beyond == [false; 3] {
        return scaled(normal, -dot(normal, from_a) / square);
    }

    // The nearest point is on an edge that has the point on its outer side.
    let mut nearest = ([0.0; 3], f64::INFINITY);
    for ((from, edge), is_beyond) in edges.into_iter().zip(is_beyond) {
        if is_beyond {
            let way = way_to_edge(from, edge);
            let square = dot(way, way);
            if square <= nearest.1 {
                nearest = (way, square);
            }
        }
    }
    nearest.0
}

/// The vector from a point to the nearest one of an edge; `from` goes from the edge's start to the point.
#[inline]
fn way_to_edge(from: [f64; 3], edge: [f64; 3]) -> [f64; 3] {
    let (along, length) = (dot(from, edge), dot(edge, edge));
    if along <= 0.0 {
        return scaled(from, -1.0);
    }
    if along >= length {
        return sub(edge, from);
    }
    sub(scaled(edge, along / length), from)
}

/// A triangle to which the distances of many points are asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PreparedTriangle {
    corners: [[f64; 3]; 3],
    /// Of length 1; `None` if the triangle is so thin that it would not be exact.
    normal: Option<[f64; 3]>,
    /// Of each edge the direction of length 1 to the inside, in the plane.
    inside: [[f64; 3]; 3],
}

/// How far a point is from a triangle, as far as that is known with little work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SquareDistance {
    /// The square of the distance.
    Exact(f64),
    /// It is not less than this.
    AtLeast(f64),
}

impl PreparedTriangle {
    pub(crate) fn new(corners: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = corners;
        let edges = [sub(b, a), sub(c, b), sub(a, c)];
        let normal = cross(edges[2], edges[0]);
        let square = dot(normal, normal);
        let is_thin = square <= THIN * (dot(edges[0], edges[0]) * dot(edges[2], edges[2]));
        let normal = scaled(normal, 1.0 / square.sqrt());
        let inside = edges.map(|edge| {
            let way = cross(edge, normal);
            scaled(way, -1.0 / dot(way, way).sqrt())
        });
        Self {
            corners,
            normal: (!is_thin && square > 0.0).then_some(normal),
            inside,
        }
    }

    /// What is known of the distance from where the point is along the normal and beyond the edges.
    #[inline]
    pub(crate) fn bound(&self, p: [f64; 3]) -> SquareDistance {
        let Some(normal) = self.normal else {
            return SquareDistance::AtLeast(0.0);
        };
        let [from_a, from_b, from_c] = self.corners.map(|corner| sub(p, corner));
        let height = dot(normal, from_a);
        let [beyond_ab, beyond_bc, beyond_ca] = [
            dot(self.inside[0], from_a),
            dot(self.inside[1], from_b),
            dot(self.inside[2], from_c),
        ];
        let least = beyond_ab.min(beyond_bc).min(beyond_ca);
        match least >= 0.0 {
            true => SquareDistance::Exact(height * height),
            false => SquareDistance::AtLeast(height * height + least * least),
        }
    }

    /// The square of the distance.
    pub(crate) fn square_distance(&self, p: [f64; 3]) -> f64 {
        let way = way_to_triangle(p, self.corners);
        dot(way, way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const CORNERS: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]];

    #[test]
    fn the_way_to_inside_edges_and_corners() {
        let cases = [
            ([1.0, 1.0, 2.0], [0.0, 0.0, -2.0]),
            ([1.0, 1.0, 0.0], [0.0, 0.0, 0.0]),
            ([1.0, -2.0, 1.0], [0.0, 2.0, -1.0]),
            ([-1.0, -2.0, 0.5], [1.0, 2.0, -0.5]),
            ([9.0, -1.0, 0.0], [-5.0, 1.0, 0.0]),
            ([4.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
            // Beyond the long edge, 5 long, by one length of its normal (3, 4) / 5.
            ([2.0 + 0.6, 1.5 + 0.8, 0.0], [-0.6, -0.8, 0.0]),
        ];
        for (p, expected) in cases {
            for turn in 0..3 {
                let corners = [0, 1, 2].map(|i| CORNERS[(i + turn) % 3]);
                let [a, b, c] = corners;
                for corners in [corners, [c, b, a]] {
                    let way = way_to_triangle(p, corners);
                    let off = sub(way, expected);
                    assert!(dot(off, off) < 1e-30, "{p:?}: {way:?}, not {expected:?}");
                }
            }
        }
    }

    #[test]
    fn triangles_without_an_area_are_edges_and_points() {
        let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
        for corners in [[a, b, c], [b, c, a], [c, b, a], [a, c, c], [c, a, c]] {
            let way = way_to_triangle([4.0, 3.0, 3.0], corners);
            assert_eq!(way, [-1.0, 0.0, 0.0], "{corners:?}");
        }
        assert_eq!(way_to_triangle([4.0, 3.0, 3.0], [c; 3]), [-1.0, 0.0, 0.0]);
        assert_eq!(way_to_triangle(c, [c; 3]), [0.0; 3]);
    }

    #[test]
    fn what_is_known_with_little_work_is_true() {
        let mut random = SplitMix64(2);
        let mut exact = 0;
        for number in 0..20_000 {
            let mut place =
                |size: f64| [(); 3].map(|()| (random.below(1001) as f64 / 500.0 - 1.0) * size);
            let [p, a] = [place(1.0), place(0.5)];
            let thin = [1.0, 1e-3, 1e-7, 0.0][number % 4];
            let b = place(0.5);
            let (bent, along) = (place(thin), 0.3);
            let c = [0, 1, 2].map(|i| a[i] + along * (b[i] - a[i]) + bent[i]);
            let triangle = PreparedTriangle::new([a, b, c]);
            let expected = triangle.square_distance(p);
            let close = 1e-6 * expected + 1e-12;
            match triangle.bound(p) {
                SquareDistance::Exact(found) => {
                    exact += 1;
                    assert!((found - expected).abs() <= close, "{found} {expected}");
                }
                SquareDistance::AtLeast(least) => {
                    assert!(least <= expected + close, "{least} {expected}");
                }
            }
        }
        assert!(exact > 300, "{exact}");
    }

    /// No point of a fine lattice of the triangle is nearer, and the point found is in the triangle.
    #[test]
    fn no_point_of_the_triangle_is_nearer() {
        let mut random = SplitMix64(1);
        let mut coordinate = || random.below(1000) as f64 / 500.0 - 1.0;
        for _ in 0..300 {
            let [p, a, b, c] = [(); 4].map(|()| [(); 3].map(|()| coordinate()));
            let way = way_to_triangle(p, [a, b, c]);
            let found = dot(way, way).sqrt();
            let longest = [sub(b, a), sub(c, b), sub(a, c)].map(|e| dot(e, e).sqrt());
            let longest = longest.into_iter().fold(0.0, f64::max);

            let steps = 40;
            let mut least = f64::INFINITY;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let weights = [i, j, steps - i - j].map(|w| f64::from(w) / f64::from(steps));
                    let at = [0, 1, 2]
                        .map(|x| weights[0] * a[x] + weights[1] * b[x] + weights[2] * c[x]);
                    least = least.min(dot(sub(at, p), sub(at, p)).sqrt());
                }
            }
            assert!(found <= least + 1e-12, "{found} {least}");
            assert!(
                least <= found + longest / f64::from(steps),
                "{found} {least}"
            );
        }
    }
}
