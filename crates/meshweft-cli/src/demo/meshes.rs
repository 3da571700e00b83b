//! Irregular meshes made from formulas: no file, no download.

use std::collections::HashMap;
use std::f32::consts::TAU;

use meshweft::geometry::{cross, normalized, sub};
use meshweft::{FaceOrder, Mesh, Permutation, VertexOrder};

/// A trefoil knot as a tube whose rings are shifted and whose diagonals are random.
pub(super) fn knot(face_count: u32) -> Mesh {
    // Twice as many faces as vertices; the tube is about 22 times as long as its girth.
    let around = (face_count / 44).isqrt().max(5);
    let along = (face_count / (2 * around)).max(8);

    let chance = Permutation::random((around * along) as usize, 1);
    let chance = |x: u32, y: u32, sides: u32| {
        chance.new_to_old()[((y % along) * around + x % around) as usize] % sides
    };

    let mut positions = Vec::new();
    for y in 0..along {
        for x in 0..around {
            let shift = chance(x, y, 61) as f32 / 61.0 - 0.5;
            let t = (y as f32 + 0.3 * shift) / along as f32 * TAU;
            let s = (x as f32 + 0.6 * shift) / around as f32 * TAU;
            positions.push(on_knot(t, s));
        }
    }

    let vertex = |x: u32, y: u32| (y % along) * around + x % around;
    let mut faces = Vec::new();
    for y in 0..along {
        for x in 0..around {
            let [a, b] = [vertex(x, y), vertex(x + 1, y)];
            let [c, d] = [vertex(x, y + 1), vertex(x + 1, y + 1)];
            match chance(x, y, 7) % 2 {
                0 => faces.extend([[a, b, c], [c, b, d]]),
                _ => faces.extend([[a, b, d], [a, d, c]]),
            }
        }
    }
    Mesh::new(positions, faces).expect("all indices are of the grid")
}

/// The point at angle `s` around the tube, `t` along the knot.
fn on_knot(t: f32, s: f32) -> [f32; 3] {
    let center = |t: f32| {
        let r = 2.0 + (3.0 * t).cos();
        [r * (2.0 * t).cos(), r * (2.0 * t).sin(), (3.0 * t).sin()]
    };
    let [here, ahead] = [center(t), center(t + 1e-3)];
    let tangent = normalized(sub(ahead, here));
    let side = normalized(cross(tangent, [0.0, 0.0, 1.0]));
    let up = cross(tangent, side);
    let (sin, cos) = s.sin_cos();
    let at = |i: usize| here[i] + 0.45 * (cos * side[i] + sin * up[i]);
    [at(0), at(1), at(2)]
}

/// An isosurface of three rounded tubes and a ball, by marching tetrahedra: slivers and valences
/// from 3 to 20, as scanners and simulations make them.
pub(super) fn isosurface(face_count: u32) -> Mesh {
    // The surface crosses enough of the grid's `n³` cells to give about `11 n²` faces.
    let n = (face_count / 11).isqrt().max(6);

    // The field, whose zeros are the surface.
    let point = |[x, y, z]: [u32; 3]| [x, y, z].map(|i| (i as f32 / n as f32 - 0.5) * 4.2);
    let value = |corner: [u32; 3]| {
        let [x, y, z] = point(corner);
        let tube = |a: f32, b: f32| 1.0 / (0.05 + a * a + b * b);
        let ball = 3.0 / (0.1 + x * x + y * y + z * z);
        let fall = (1.0 - (x * x + y * y + z * z) / 4.2).max(-1.0);
        (tube(x, y) + tube(y, z) + tube(z, x) + ball) * fall - 5.0
    };

    // A vertex where the surface crosses an edge, one for all cells around it.
    let mut vertices: HashMap<[[u32; 3]; 2], u32> = HashMap::new();
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut faces = Vec::new();
    let mut crossing = |a: [u32; 3], b: [u32; 3]| {
        let edge = if a < b { [a, b] } else { [b, a] };
        *vertices.entry(edge).or_insert_with(|| {
            let [va, vb] = edge.map(value);
            let t = (va / (va - vb)).clamp(0.05, 0.95);
            let [pa, pb] = edge.map(point);
            positions.push([0, 1, 2].map(|i| pa[i] + t * (pb[i] - pa[i])));
            u32::try_from(positions.len() - 1).expect("limited by the face count")
        })
    };

    for x in 0..n {
        for y in 0..n {
            for z in 0..n {
                for order in PATHS {
                    // From the lowest to the highest corner of the cell along three axes.
                    let mut corners = [[x, y, z]; 4];
                    for (step, &axis) in order.iter().enumerate() {
                        for corner in &mut corners[step + 1..] {
                            corner[axis] += 1;
                        }
                    }
                    let odd = matches!(order, [0, 2, 1] | [1, 0, 2] | [2, 1, 0]);
                    tetrahedron(corners, odd, value, &mut crossing, &mut faces);
                }
            }
        }
    }
    Mesh::new(positions, faces).expect("all indices were handed out")
}

/// The six paths along the edges of a cube: one tetrahedron each.
const PATHS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

fn tetrahedron(
    corners: [[u32; 3]; 4],
    odd: bool,
    value: impl Fn([u32; 3]) -> f32,
    crossing: &mut impl FnMut([u32; 3], [u32; 3]) -> u32,
    faces: &mut Vec<[u32; 3]>,
) {
    let inside = corners.map(|corner| value(corner) > 0.0);
    let (mut ins, mut outs) = (Vec::new(), Vec::new());
    for (i, inside) in inside.into_iter().enumerate() {
        if inside { ins.push(i) } else { outs.push(i) }
    }

    let mut cut = |a: usize, b: usize| crossing(corners[a], corners[b]);

    // Swapping two corners mirrors the tetrahedron: an odd number of inversions flips the faces.
    let order: Vec<usize> = ins.iter().chain(&outs).copied().collect();
    let pairs = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
    let inversions = pairs.filter(|&(i, j)| order[i] > order[j]).count();
    let flip = (inversions % 2 == 1) != odd;
    let mut add = |[a, b, c]: [u32; 3]| {
        if a != b && b != c && c != a {
            faces.push(if flip { [a, c, b] } else { [a, b, c] });
        }
    };

    match (&ins[..], &outs[..]) {
        (&[i], &[a, b, c]) => add([cut(i, a), cut(i, b), cut(i, c)]),
        (&[a, b, c], &[o]) => add([cut(a, o), cut(b, o), cut(c, o)]),
        (&[i, j], &[a, b]) => {
            let [ia, ib, jb, ja] = [cut(i, a), cut(i, b), cut(j, b), cut(j, a)];
            add([ia, ib, jb]);
            add([ia, jb, ja]);
        }
        _ => {}
    }
}

/// The mesh with faces and vertices in random order.
pub(super) fn shuffled(mesh: &Mesh) -> Mesh {
    let faces = FaceOrder::from(Permutation::random(mesh.face_count(), 2));
    let vertices = VertexOrder::from(Permutation::random(mesh.vertex_count(), 3));
    mesh.with_face_order(&faces).with_vertex_order(&vertices)
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshweft::geometry::dot;
    use std::collections::BTreeMap;

    /// Every edge is run once in each direction: closed, manifold, oriented.
    fn is_closed(mesh: &Mesh) -> bool {
        let mut edges = BTreeMap::new();
        for &[a, b, c] in mesh.faces() {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        let paired = |(&(a, b), &n): (&(u32, u32), &i32)| n == 1 && edges.contains_key(&(b, a));
        edges.iter().all(paired)
    }

    #[test]
    fn the_meshes_are_closed_surfaces_of_about_the_size_asked_for() {
        for mesh in [knot(4000), isosurface(4000)] {
            assert!(is_closed(&mesh));
            assert!(
                (2000..8000).contains(&mesh.face_count()),
                "{}",
                mesh.face_count()
            );
        }
    }

    #[test]
    fn faces_look_outward() {
        for (name, mesh) in [("knot", knot(4000)), ("isosurface", isosurface(4000))] {
            let corner = |v: u32| mesh.positions()[v as usize];
            let volume = |f: &[u32; 3]| dot(corner(f[0]), cross(corner(f[1]), corner(f[2])));
            assert!(mesh.faces().iter().map(volume).sum::<f32>() > 0.0, "{name}");
        }
    }
}
