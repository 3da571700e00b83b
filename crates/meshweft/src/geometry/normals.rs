//! Normals of surfaces.

use super::vector::{cross, normalized, sub};

/// Normals at the vertices, each the mean of its faces' weighted by their area; zero where a vertex
/// has no face with an area.
///
/// # Panics
/// If a face names a vertex that has no position.
///
/// # Complexity
/// Time O(vertices + faces), space 12 bytes a vertex.
#[must_use]
pub fn vertex_normals(positions: &[[f32; 3]], faces: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mut normals = vec![[0.0_f32; 3]; positions.len()];
    for face in faces {
        let [a, b, c] = face.map(|v| positions[v as usize]);
        let area = cross(sub(b, a), sub(c, a));
        for &vertex in face {
            for (sum, part) in normals[vertex as usize].iter_mut().zip(area) {
                *sum += part;
            }
        }
    }
    normals.into_iter().map(normalized).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_patch_points_up() {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [9.0; 3],
        ];
        let normals = vertex_normals(&positions, &[[0, 1, 2], [2, 1, 3]]);
        assert_eq!(normals[..4], [[0.0, 0.0, 1.0]; 4]);
        assert_eq!(normals[4], [0.0; 3]);
    }
}
