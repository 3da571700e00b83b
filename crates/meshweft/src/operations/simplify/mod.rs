//! Fewer faces for a document, by vertices that leave: none is invented, and nothing tears.
//!
//! Read `objects` for what is simplified together, `gathered` for the mesh that is simplified, `reduced` for
//! what is left of it, `progressive_object` and `reduced_mesh` for how that is found.

mod gathered;
mod levels;
mod objects;
mod options;
mod progressive_object;
mod reduced;
mod reduced_mesh;
mod removals;
mod report;
mod report_json;

use std::collections::BTreeMap;

use super::counts::{Counts, USUAL_CACHES};
use super::optimize::{OptimizeError, optimize};
use super::stage::Stage;
use crate::files::{Document, FileError, Note, Place};
use crate::parallel;
use crate::progress::Progress;
pub use crate::progressive::{AttributeWeights, StopReason};
pub use levels::{LEVEL_CACHES, LevelFigures};
pub(super) use objects::{Applied, apply, objects};
pub use options::{ErrorLimit, SimplifyOptions, SimplifyOptionsError};
pub(super) use progressive_object::ProgressiveObject;
use reduced::{Goal, Reduced};
pub(super) use reduced_mesh::ReducedMesh;
pub use removals::Removals;
pub use report::{SimplifiedMesh, SimplifiedObject, SimplifyError, SimplifyReport};

/// Takes faces away from a document until an object has as few as asked for, or nothing more can go.
///
/// Vertices leave one after the other, each to a neighbour ([`Collapses`](crate::progressive::Collapses)); so
/// every vertex of the result is one of the file with all that is stored with it. ReportParts that are in one
/// object (the primitives of a glTF mesh, all that shares its vertices) are simplified together: where they
/// meet, they keep meeting. Seams of texture coordinates, borders of materials and groups stay where they
/// are, with fewer points. Objects that meet each other only where they are drawn are told nothing of each
/// other: for them there is [`lock_border`](SimplifyOptions::lock_border).
///
/// What was simplified is then ordered as by [`optimize`], with all meshes of the file. Where nothing leaves,
/// the document stays as it is. A vertex that no face used stays.
///
/// The result is the same on any number of threads, those of the current pool with feature `parallel`.
///
/// # Errors
/// [`SimplifyError::Options`] for options that make no sense, [`SimplifyError::HasLevels`] of a document with levels of detail;
/// nothing is changed then.
/// [`SimplifyError::File`] if the document refuses an order, which it does not for those made here. An object
/// that cannot be simplified stays as it is, and the report says why.
///
/// # Complexity
/// Time O(faces) for the removals and, for each sample and vertex, O(log faces) for the error; then that of the
/// order. About 250 bytes a face on top of the document.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{SimplifyOptions, simplify};
///
/// let mut document = Document::open(Path::new("scan.ply"), ReadOptions::default())?;
/// let options = SimplifyOptions { ratio: Some(0.25), ..SimplifyOptions::default() };
/// let report = simplify(&mut document, &options, &())?;
/// if report.is_changed() {
///     document.write(Path::new("quarter.ply"))?;
/// }
/// println!("{}", report.to_json());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simplify(
    document: &mut Document,
    options: &SimplifyOptions,
    progress: &dyn Progress,
) -> Result<SimplifyReport, SimplifyError> {
    options.check().map_err(SimplifyError::Options)?;
    if let Some(level) = document.meshes().iter().find_map(|entry| entry.level) {
        return Err(SimplifyError::HasLevels {
            file: document.path().to_owned(),
            mesh: document.meshes()[level.of].name.clone(),
        });
    }
    let mut models = options.ordering.target.models().to_vec();
    models.extend(USUAL_CACHES.iter().filter(|&model| {
        let ordered_for = options.ordering.target.models();
        !ordered_for.contains(model)
    }));
    let before = Counts::of_each(document.meshes(), &models);
    let total_before = Counts::total(document.meshes(), &before, &models);

    // Objects, each with its share of what is asked for.
    let objects: Vec<Vec<usize>> = objects(document.meshes())
        .into_iter()
        .map(|mut meshes| {
            meshes.retain(|&mesh| document.meshes()[mesh].mesh.face_count() > 0);
            meshes
        })
        .filter(|meshes| !meshes.is_empty())
        .collect();
    let total = total_before.faces;
    let mut first = 0;
    let goals = objects.iter().map(|meshes| {
        let faces = |&mesh: &usize| before[mesh].faces;
        let own: usize = meshes.iter().map(faces).sum();
        let goal = Goal {
            faces: options.faces_of(own, first, total),
            samples: (options.samples as u128 * own as u128)
                .div_ceil(total as u128)
                .try_into()
                .unwrap_or(usize::MAX),
        };
        first += own;
        (goal, own)
    });
    let goals: Vec<(Goal, usize)> = goals.collect();
    let removing = Stage::new(progress, 0.0, 0.5, total);
    let jobs = objects.iter().zip(&goals).collect();
    let reduced = parallel::map(jobs, |(meshes, (goal, faces))| {
        if removing.is_stopped() {
            return Err("the work was stopped".to_owned());
        }
        let reduced = Reduced::new(document, meshes, options, goal);
        removing.add(*faces);
        reduced
    });

    // What is left of them.
    let mut kept = BTreeMap::new();
    let sound = reduced.iter().filter_map(|it| it.as_ref().ok());
    let sound: Vec<&[ReducedMesh]> = sound.map(|it| &*it.meshes).collect();
    let mut applied = apply(document, &sound, &mut kept).into_iter();
    let mut notes = Vec::new();
    let mut outcomes = Vec::with_capacity(reduced.len());
    for (reduced, meshes) in reduced.into_iter().zip(&objects) {
        let name = &document.meshes()[meshes[0]].name;
        let why = match reduced {
            Err(why) => Err(why),
            Ok(reduced) => match applied.next() {
                Some(Applied::Refused(why)) => Err(why),
                Some(Applied::WithoutVertices(why)) => {
                    let text = format!("{name}: no vertex leaves the file: {why}");
                    notes.push(Note::new(Place::File, text));
                    Ok(reduced)
                }
                _ => Ok(reduced),
            },
        };
        if let Err(why) = &why {
            let text = format!("{name}: not simplified: {why}");
            notes.push(Note::new(Place::File, text));
        }
        outcomes.push(why);
    }

    // In a good order.
    let is_changed =
        |reduced: &Result<Reduced, String>| reduced.as_ref().is_ok_and(|it| !it.meshes.is_empty());
    let ordering = Stage::new(progress, 0.5, 1.0, 1);
    let ordered = match outcomes.iter().any(is_changed) {
        true => Some(optimize(document, &options.ordering, &ordering).map_err(from_order)?),
        false => None,
    };
    let is_stopped = removing.is_stopped() || ordered.as_ref().is_some_and(|it| it.is_stopped);
    Ok(report::report(report::ReportParts {
        document,
        options,
        objects,
        goals: goals.into_iter().map(|(goal, _)| goal.faces).collect(),
        outcomes,
        kept,
        before,
        total_before,
        ordered,
        is_stopped,
        notes,
    }))
}

fn from_order(error: OptimizeError) -> SimplifyError {
    match error {
        OptimizeError::Options(error) => {
            SimplifyError::Options(SimplifyOptionsError::Ordering(error))
        }
        OptimizeError::File(error) => SimplifyError::File(error),
    }
}

impl From<FileError> for SimplifyError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}
