//! The levels of a document, made and put into it.

use super::coarser::put_in_order;
use super::lists::LevelLists;
use super::made::MadeLevels;
use super::options::{LevelsError, LevelsOptions};
use super::report::{LevelsParts, LevelsReport, counts_of};
use crate::cache::CacheModel;
use crate::files::{Document, Format, Note, Place};
use crate::operations::converted::converted;
use crate::operations::counts::Counts;
use crate::operations::file_report::FileReport;
use crate::operations::stage::Stage;
use crate::progress::Progress;

/// Gives the meshes of a document levels of detail, in one ordinary glTF: see [`Edit::Levels`](crate::files::Edit::Levels) for what is added.
///
/// - Every vertex of a level is one of the file with all that is stored with it, so skins, morph targets and textures hold.
///   What is in one object (the primitives of a glTF mesh, all that shares its vertices) gets coarser together and keeps
///   meeting where it meets.
/// - All objects have one error budget: at each level none is farther off, as it is drawn, than it takes for the number of
///   faces of the whole. An object that has lost nothing at any level gets none.
/// - The vertices of each level come first in every vertex view; inside a *band*, which is what a level adds, they are in the
///   order of their first use by the full mesh. Nothing else that was there moves. The levels of a mesh without an index list
///   have copies of its vertices.
/// - Each level is ordered as by [`optimize_indices`](crate::operations::optimize_indices).
///
/// Of a document of another format a GLB is made and ordered first, with the names, positions and faces of its meshes: the
/// document then is that. The result is the same on any number of threads.
///
/// # Errors
/// [`LevelsError`]: the options are not sound, the document has levels already, or a GLB would lose something that the options
/// do not let go, or no mesh has fewer faces at any level. Nothing is changed then.
///
/// # Complexity
/// Time O(faces) for the removals and, for each sample and vertex and level, O(log faces) for the errors; then that of the
/// orders. About 250 bytes a face on top of the document.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::files::{Document, ReadOptions};
/// use meshweft::operations::{LevelsOptions, levels};
///
/// let mut document = Document::open(Path::new("scene.glb"), ReadOptions::default())?;
/// let report = levels(&mut document, &LevelsOptions::default(), &())?;
/// document.write(Path::new("scene-levels.glb"))?;
/// println!("{}", report.to_json());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn levels(
    document: &mut Document,
    options: &LevelsOptions,
    progress: &dyn Progress,
) -> Result<LevelsReport, LevelsError> {
    options.check().map_err(LevelsError::Options)?;
    let mut of_file = FileReport::of(document);
    let mut lost = Vec::new();
    let mut glb = None;
    if !matches!(document.format(), Format::Gltf | Format::Glb) {
        let mut converted = converted(document, options.drop_attributes)?;
        // A new file has no order that would have to stay.
        put_in_order(&mut converted.document, options, &())?;
        (glb, lost) = (Some(converted.document), converted.lost);
    }
    let target = glb.as_ref().unwrap_or(document);

    // How coarse each object is at each level.
    let making = Stage::new(progress, 0.0, 0.6, 1);
    let mut made = MadeLevels::checked(target, options, &making)?;

    // Into the document.
    if let Some(glb) = glb {
        *document = glb;
    }
    let ordering = Stage::new(progress, 0.6, 1.0, 1);
    let lists = LevelLists::new(document.meshes(), &made, options, &ordering);
    made.notes.extend(lists.notes(document.meshes()));
    let counts = (0..=made.level_count())
        .map(|number| counts_of(&lists.drawn_at(document.meshes(), number), options))
        .collect::<Vec<_>>();
    made.notes.extend(note_of_invocations(document, &counts[0]));
    let names = made.names(document);
    lists.apply(document)?;
    of_file.notes.clear();
    of_file.notes.extend_from_slice(document.notes());
    of_file.notes.append(&mut made.notes);
    Ok(LevelsReport::new(LevelsParts {
        is_stopped: making.is_stopped() || ordering.is_stopped(),
        of_file,
        options,
        lost,
        made,
        names,
        counts,
    }))
}

/// Says that a card transforms more vertices of the full mesh than before, if it does: it does where more than 65,536 vertices
/// were in blocks.
fn note_of_invocations(document: &Document, after: &Counts) -> Option<Note> {
    let before = Counts::of_each(document.meshes(), &[CacheModel::Nvidia]);
    let before = before.iter().filter_map(|counts| counts.card);
    let before: u64 = before.map(|card| card.invocations).sum();
    let after = after.card?.invocations;
    let is_more = after > before + before / 50;
    is_more.then(|| {
        let text = format!(
            "with its vertices in bands the full mesh takes {after} vertex shader invocations on an NVIDIA card, {before} before: \
             such cards collect vertices in blocks of 65,536, in which they stay with keep_vertex_order"
        );
        Note::new(Place::File, text)
    })
}
