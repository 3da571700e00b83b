//! Positions and eyes on a lattice, where what a front face is can be told exactly.

use meshweft::Mesh;
use meshweft::culling::Eye;

/// Coordinates are multiples of this. An eye at a hundred times the size of a mesh still has it exactly in `f32`.
const UNIT: f64 = 1.0 / 65536.0;

/// The nearest point of the lattice.
#[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
pub(super) fn on_lattice(point: [f64; 3]) -> [f32; 3] {
    point.map(|x| ((x / UNIT).round() * UNIT) as f32)
}

/// A mesh with all vertices on the lattice.
pub(super) fn snapped(mesh: &Mesh) -> Mesh {
    let positions = mesh.positions().iter();
    let positions: Vec<[f32; 3]> = positions.map(|p| on_lattice(p.map(f64::from))).collect();
    Mesh::new(positions, mesh.faces()).expect("the same faces as before")
}

fn in_units(point: [f32; 3]) -> [i128; 3] {
    point.map(|x| {
        let units = f64::from(x) / UNIT;
        debug_assert!(units == units.round(), "{x} is on the lattice");
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        let units = units as i128;
        units
    })
}

/// Whether a face of a mesh is a front face, exactly.
pub(super) fn is_front(mesh: &Mesh, face: u32, eye: Eye) -> bool {
    let corners = mesh.faces()[face as usize];
    let [a, b, c] = corners.map(|vertex| in_units(mesh.positions()[vertex as usize]));
    let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (minus(b, a), minus(c, a));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let [x, y, z, w] = eye.point;
    let point = in_units([x, y, z]);
    let way = match w == 0.0 {
        true => point,
        false => minus(point, a),
    };
    n[0] * way[0] + n[1] * way[1] + n[2] * way[2] > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_face_turns_left_and_one_seen_from_its_plane_is_none() {
        let positions = [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]];
        let mesh = snapped(&Mesh::new(positions, [[0, 1, 2]]).unwrap());
        let unit = 1.0 / 65536.0;
        for (z, is_seen) in [(0.5 + unit, true), (0.5, false), (0.5 - unit, false)] {
            assert_eq!(is_front(&mesh, 0, Eye::at([9.0, -3.0, z])), is_seen);
        }
        assert!(is_front(&mesh, 0, Eye::towards([5.0, 5.0, unit])));
        assert!(!is_front(&mesh, 0, Eye::towards([5.0, 5.0, 0.0])));
    }
}
