//! One object at its levels.

use super::bands::GroupBands;
use super::options::{LevelsError, LevelsOptions, LevelsOptionsError};
use crate::files::{Document, MeshEntry};
use crate::operations::indices::{IndexOptions, optimize_indices_with};
use crate::operations::optimize::{OptimizeError, optimize};
use crate::operations::options::Options;
use crate::operations::simplify::{ProgressiveObject, ReducedMesh};
use crate::progress::Progress;
use crate::progressive::Walk;

/// A level of an object.
pub(super) struct ObjectLevel {
    /// What is left of each of its meshes.
    pub(super) meshes: Vec<ReducedMesh>,
    pub(super) faces: usize,
    /// How far it is from the object, in units of its positions.
    pub(super) error: f64,
}

/// The levels of an object, whose numbers of removals rise; none where nothing has left. `samples` is the number of points that each
/// is measured from.
pub(super) fn levels_of_object(
    document: &Document,
    meshes: &[usize],
    object: &ProgressiveObject,
    removals: &[usize],
    samples: usize,
) -> Vec<ObjectLevel> {
    if removals.iter().all(|&count| count == 0) {
        return Vec::new();
    }
    let progressive = &object.progressive;
    let mut walk = Walk::new(progressive);
    let mut levels: Vec<ObjectLevel> = Vec::with_capacity(removals.len());
    for &count in removals {
        walk.go_to(count);
        let error = match samples {
            0 => f64::from(progressive.error(count)),
            _ if count == 0 => 0.0,
            _ => object.distances(&walk, samples).max,
        };
        // What was measured from other points may be less.
        let before = levels.last().map_or(0.0, |level| level.error);
        levels.push(ObjectLevel {
            meshes: object.reduced_meshes(document.meshes(), meshes, &walk),
            faces: progressive.face_count(count),
            error: error.max(before),
        });
    }
    levels
}

/// Puts the faces of a level in a good order, for vertices that will be in these bands; those of a mesh whose faces must stay
/// are left in that of the file.
pub(super) fn put_list_in_order(
    entry: &MeshEntry,
    faces: &mut [[u32; 3]],
    bands: Option<&GroupBands>,
    options: &LevelsOptions,
    progress: &dyn Progress,
) {
    if !entry.faces_movable {
        return;
    }
    let optimizer = &options.optimizer;
    let options = IndexOptions {
        target: optimizer.target,
        effort: optimizer.effort,
        seed: optimizer.seed,
        budget: optimizer.budget,
        keep_corners: optimizer.keep_corners || !entry.corners_turnable,
        ..IndexOptions::default()
    };
    if let Some(bands) = bands {
        bands.renumber(faces);
    }
    let vertex_count = entry.mesh.vertex_count();
    let corners = faces.as_flattened_mut();
    let ordered = optimize_indices_with(corners, vertex_count, &options, progress);
    ordered.expect("the corners are vertices of the mesh");
    if let Some(bands) = bands {
        bands.restore(faces);
    }
}

/// Puts a document in the order that its levels get.
pub(super) fn put_in_order(
    document: &mut Document,
    options: &LevelsOptions,
    progress: &dyn Progress,
) -> Result<(), LevelsError> {
    let optimizer = &options.optimizer;
    let options = Options {
        target: optimizer.target,
        effort: optimizer.effort,
        seed: optimizer.seed,
        budget: optimizer.budget,
        keep_corners: optimizer.keep_corners,
        ..Options::default()
    };
    match optimize(document, &options, progress) {
        Ok(_) => Ok(()),
        Err(OptimizeError::File(error)) => Err(error.into()),
        Err(OptimizeError::Options(error)) => {
            Err(LevelsError::Options(LevelsOptionsError::Ordering(error)))
        }
    }
}
