//! An object with fewer faces: which faces and vertices of its meshes stay.

use super::levels::{LevelFigures, figures};
use super::options::SimplifyOptions;
use super::progressive_object::ProgressiveObject;
use super::reduced_mesh::ReducedMesh;
use super::removals::Removals;
use crate::files::Document;
use crate::geometry::Distances;
use crate::progressive::{Collapses, StopReason, Walk};

/// What is to be left of an object.
pub(super) struct Reduced {
    /// What is left of each mesh that has faces, in their order; empty if all stays.
    pub(super) meshes: Vec<ReducedMesh>,
    pub(super) faces_before: usize,
    pub(super) faces_after: usize,
    pub(super) stop: StopReason,
    /// The error of the last removal, as an estimate.
    pub(super) estimated_error: f32,
    /// How far the result is from the object, if that was measured.
    pub(super) distances: Option<Distances>,
    /// The diagonal of the bounding box.
    pub(super) diagonal: f64,
    pub(super) removals: Option<Removals>,
    pub(super) levels: Vec<LevelFigures>,
}

/// How far one object is to go.
pub(super) struct Goal {
    /// It stops at this number of faces.
    pub(super) faces: usize,
    /// From how many points of either surface the error is measured.
    pub(super) samples: usize,
}

impl Reduced {
    /// Simplifies the meshes of an object together; those without faces are not among `meshes`.
    ///
    /// # Errors
    /// Why they cannot be simplified.
    ///
    /// # Complexity
    /// That of [`Collapses::build`] and [`deviation`](crate::geometry::deviation()).
    pub(super) fn new(
        document: &Document,
        meshes: &[usize],
        options: &SimplifyOptions,
        goal: &Goal,
    ) -> Result<Self, String> {
        // All levels down to what was asked for.
        let object = ProgressiveObject::new(document, meshes, |diagonal| Collapses {
            effort: options.ordering.effort,
            lock_border: options.lock_border,
            drop_parts: options.drop_parts,
            // A face never has corners of two parts of a texture.
            cross_seams: false,
            faces: match options.with_removals || options.levels > 0 {
                true => 0,
                false => goal.faces,
            },
            error: options
                .error
                .map_or(f32::INFINITY, |limit| limit.of_diagonal(diagonal)),
            weights: options.weights,
        })?;
        let ProgressiveObject {
            gathered,
            progressive,
            diagonal,
        } = &object;

        // The level, which has a face left.
        let mut level = progressive.level_of_faces(goal.faces);
        while level > 0 && progressive.face_count(level) == 0 {
            level -= 1;
        }
        let mut walk = Walk::new(progressive);
        walk.go_to(level);
        let mut reduced = Self {
            meshes: Vec::new(),
            faces_before: gathered.mesh.face_count(),
            faces_after: progressive.face_count(level),
            stop: match progressive.face_count(level) <= goal.faces {
                true => StopReason::Faces,
                false => progressive.stop(),
            },
            estimated_error: progressive.error(level),
            distances: None,
            diagonal: *diagonal,
            removals: options
                .with_removals
                .then(|| Removals::new(progressive, gathered)),
            levels: match options.levels {
                0 => Vec::new(),
                count => figures(progressive, count),
            },
        };
        if level == 0 {
            return Ok(reduced);
        }

        reduced.meshes = object.reduced_meshes(document.meshes(), meshes, &walk);
        if goal.samples > 0 {
            reduced.distances = Some(object.distances(&walk, goal.samples));
        }
        Ok(reduced)
    }
}
