//! Faces without the numbers of their vertices.

use meshweft::Mesh;

/// Faces by the bits of their corners' positions, each beginning with the least.
pub(crate) fn placed_faces(
    mesh: &Mesh,
    faces: impl Iterator<Item = [u32; 3]>,
) -> Vec<[[u32; 3]; 3]> {
    let bits = |vertex: u32| mesh.positions()[vertex as usize].map(|x| (x + 0.0).to_bits());
    let mut placed: Vec<_> = faces
        .map(|face| {
            let mut corners = face.map(bits);
            let first = (0..3).min_by_key(|&slot| corners[slot]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    placed.sort_unstable();
    placed
}
