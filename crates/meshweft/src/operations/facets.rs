//! What the facets of an STL store that their corners say too.

use crate::attribute::{AttributeInfo, Semantic};
use crate::files::{Document, FileError, Format};

/// How far a normal may be from that of its corners: programs write few digits, and compute in few bits.
const TOLERANCE: f64 = 0.01;

/// Whether an attribute of an STL says nothing: two bytes of each facet that are all 0, or normals of length one
/// that point where the corners of their facets turn left, as the format asks. Of a facet without area it may be
/// any, and one that is 0 or no number is none.
///
/// # Errors
/// The values cannot be read.
///
/// # Complexity
/// Time O(bytes of the facets), space 36 bytes a facet.
pub(super) fn says_nothing(
    document: &Document,
    mesh: usize,
    info: &AttributeInfo,
) -> Result<bool, FileError> {
    if document.format() != Format::Stl {
        return Ok(false);
    }
    let values = document.attribute(mesh, info)?.to_f32();
    if info.semantic != Semantic::Normal {
        return Ok(values.iter().all(|&value| value == 0.0));
    }

    let Some(positions) = document.positions(mesh)? else {
        return Ok(false);
    };
    let faces = document.meshes()[mesh].mesh.faces();
    let mut normals = values.as_chunks::<3>().0.iter().zip(faces);
    Ok(normals.all(|(&normal, face)| {
        let corners = face.map(|vertex| positions[vertex as usize].map(f64::from));
        is_implied(normal.map(f64::from), corners)
    }))
}

/// Whether a normal is that of these corners, or none.
fn is_implied(normal: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> bool {
    if normal == [0.0; 3] || normal.iter().any(|number| !number.is_finite()) {
        return true;
    }
    let [u, v] = [b, c].map(|to| [0, 1, 2].map(|axis| to[axis] - a[axis]));
    let cross = [0, 1, 2].map(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    });
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    let is_near = |(expected, number): (f64, f64)| (expected / length - number).abs() <= TOLERANCE;
    // Without area there is no length to divide by.
    length == 0.0 || cross.into_iter().zip(normal).all(is_near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_is_implied_by_corners_that_turn_left() {
        let corners = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        for (normal, is) in [
            ([0.0, 0.0, 1.0], true),
            ([1e-3, -1e-3, 0.999], true),
            ([0.0; 3], true),
            ([f64::NAN, 0.0, 1.0], true),
            ([0.0, 0.0, -1.0], false),
            ([0.0, 0.0, 4.0], false),
            ([0.0, 0.6, 0.8], false),
        ] {
            assert_eq!(is_implied(normal, corners), is, "{normal:?}");
        }
        assert!(is_implied([0.0, 0.6, 0.8], flat));
    }
}
