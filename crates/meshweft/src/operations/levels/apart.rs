//! Each level of a document as a document of its own.

use std::collections::BTreeMap;

use super::coarser::put_in_order;
use super::made::{MadeLevels, MadeObject};
use super::options::{LevelsError, LevelsOptions};
use super::report::{LevelsParts, LevelsReport, counts_of};
use crate::files::{Document, FileError, Note, Place};
use crate::operations::file_report::FileReport;
use crate::operations::simplify::{Applied, ReducedMesh, apply};
use crate::operations::stage::Stage;
use crate::progress::Progress;

/// The levels that [`levels`](super::levels) makes, each as a document of its own with the vertices that it needs, fine to
/// coarse: of every format that faces can be left out of. `read_again` gives the document once more for each.
///
/// Each is ordered as by [`optimize`](crate::operations::optimize()). `document` stays as it is.
///
/// # Errors
/// [`LevelsError`]: the options are not sound, the document has levels already, or no mesh has fewer faces at any level; or
/// the document cannot be read again.
///
/// # Complexity
/// As [`levels`](super::levels), and a document in memory for each level.
pub fn levels_apart(
    document: &Document,
    read_again: &mut dyn FnMut() -> Result<Document, FileError>,
    options: &LevelsOptions,
    progress: &dyn Progress,
) -> Result<(Vec<Document>, LevelsReport), LevelsError> {
    options.check().map_err(LevelsError::Options)?;
    let mut of_file = FileReport::of(document);
    let making = Stage::new(progress, 0.0, 0.6, 1);
    let mut made = MadeLevels::checked(document, options, &making)?;

    // Each on its own.
    let ordering = Stage::new(progress, 0.6, 1.0, 1);
    let mut counts = vec![counts_of(document.meshes(), options)];
    let mut apart = Vec::with_capacity(made.level_count());
    for number in 0..made.level_count() {
        let count = made.level_count() as f64;
        let part = ordering.part(number as f64 / count, (number + 1) as f64 / count, 1);
        let mut level = read_again()?;
        let notes = select(&mut level, &made, number);
        made.notes.extend(notes);
        put_in_order(&mut level, options, &part)?;
        counts.push(counts_of(level.meshes(), options));
        apart.push(level);
    }
    of_file.notes.append(&mut made.notes);
    let report = LevelsReport::new(LevelsParts {
        is_stopped: making.is_stopped() || ordering.is_stopped(),
        names: made.names(document),
        of_file,
        options,
        lost: Vec::new(),
        made,
        counts,
    });
    Ok((apart, report))
}

/// Leaves in the document what there is at a level; what there is to say of it.
fn select(document: &mut Document, made: &MadeLevels, number: usize) -> Vec<Note> {
    let names = made.names(document);
    let with_levels = made.objects.iter().zip(names);
    let with_levels = with_levels.filter(|(object, _)| !object.levels.is_empty());
    let (objects, names): (Vec<&MadeObject>, Vec<String>) = with_levels.unzip();
    let reduced = objects.iter().map(|object| &*object.levels[number].meshes);
    let reduced: Vec<&[ReducedMesh]> = reduced.collect();
    let applied = apply(document, &reduced, &mut BTreeMap::new());
    let note = |(applied, name): (Applied, String)| {
        let text = match applied {
            Applied::Whole => return None,
            Applied::WithoutVertices(why) => format!("no vertex leaves the file: {why}"),
            Applied::Refused(why) => format!("it is the same at level {}: {why}", number + 1),
        };
        Some(Note::new(Place::File, format!("{name}: {text}")))
    };
    applied.into_iter().zip(names).filter_map(note).collect()
}
