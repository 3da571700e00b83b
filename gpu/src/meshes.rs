//! Meshes from files.

use std::path::Path;

use meshweft::files::Document;
use meshweft::{Limits, Mesh};

use crate::error::GpuError;

/// A mesh of a file.
#[derive(Debug, Clone)]
pub struct NamedMesh {
    /// The file's name without its endings, with the mesh's number if there are several.
    pub name: String,
    /// Its faces; every vertex has a position in the unit cube around the origin.
    pub mesh: Mesh,
}

/// All meshes of a file that have faces.
///
/// # Errors
/// If the file cannot be read.
pub fn read(file: &Path) -> Result<Vec<NamedMesh>, GpuError> {
    let wrong = |error: &dyn std::fmt::Display| GpuError::input(error.to_string());
    let document = Document::open(file, Limits::default()).map_err(|error| wrong(&error))?;
    let file_name = file.file_name().unwrap_or_default().to_string_lossy();
    let name = file_name.split('.').next().unwrap_or_default();
    let mut meshes = Vec::new();
    for (number, entry) in document.meshes().iter().enumerate() {
        if entry.mesh.face_count() == 0 {
            continue;
        }
        let positions = document.positions(number).map_err(|error| wrong(&error))?;
        let positions = in_unit_cube(positions.unwrap_or_default(), entry.mesh.vertex_count());
        let mesh = Mesh::new(positions, entry.mesh.faces());
        meshes.push(NamedMesh {
            name: match document.meshes().len() {
                1 => name.to_owned(),
                _ => format!("{name}:{number}"),
            },
            mesh: mesh.map_err(|error| wrong(&error))?,
        });
    }
    Ok(meshes)
}

/// As many positions as there are vertices, moved and scaled into the cube from -1 to 1; those that are
/// missing or not finite are at the origin.
fn in_unit_cube(mut positions: Vec<[f32; 3]>, vertex_count: usize) -> Vec<[f32; 3]> {
    let is_finite = |position: &[f32; 3]| position.iter().all(|x| x.is_finite());
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for position in positions.iter().filter(|p| is_finite(p)) {
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    // Halves first: the difference of two finite numbers may not be finite.
    let sizes = (0..3).map(|axis| high[axis] / 2.0 - low[axis] / 2.0);
    let size = sizes.fold(f32::MIN_POSITIVE, f32::max);
    for position in &mut positions {
        *position = match is_finite(position) {
            true => [0, 1, 2].map(|axis| {
                let centre = low[axis] / 2.0 + high[axis] / 2.0;
                ((position[axis] - centre) / size).clamp(-1.0, 1.0)
            }),
            false => [0.0; 3],
        };
    }
    positions.resize(vertex_count, [0.0; 3]);
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_fill_the_unit_cube() {
        let positions = vec![[1.0, 2.0, 3.0], [5.0, 2.0, 4.0], [f32::NAN, 9.0, 9.0]];
        let placed = in_unit_cube(positions, 4);
        assert_eq!(
            placed,
            [[-1.0, 0.0, -0.25], [1.0, 0.0, 0.25], [0.0; 3], [0.0; 3]]
        );
        assert_eq!(in_unit_cube(Vec::new(), 1), [[0.0; 3]]);
        assert_eq!(in_unit_cube(vec![[f32::NAN; 3]], 1), [[0.0; 3]]);
    }
}
