//! What the tables of a document leave out, from many sides.

use super::build::{compact, positions_of};
use super::options::CullStatsOptions;
use super::stats_report::{CullStatsReport, CullingFigures};
use super::views::{CACHE, ViewSums, look_at};
use crate::cache;
use crate::culling::CullingTable;
use crate::files::{Document, FileError, Note, Place, StoredCulling};

/// Looks at each mesh that has a culling table from many sides, and counts what is drawn.
///
/// Directions are spread at random over the sphere, always the same ones. A face that faces the eye and is not drawn is
/// counted too: there is none, if the table matches the faces. A table whose numbers are out of range is not used,
/// and a note says so.
///
/// # Errors
/// Positions cannot be read.
///
/// # Complexity
/// Time O(distances × eyes × faces), space O(vertices + faces) a thread beyond the document.
pub fn cull_stats(
    document: &Document,
    options: &CullStatsOptions,
) -> Result<CullStatsReport, FileError> {
    let mut report = CullStatsReport {
        file: document.path().to_owned(),
        bytes: document.source_bytes(),
        options: options.clone(),
        meshes: Vec::new(),
        without: 0,
        total: CullingFigures::none("all meshes", options.distances.len()),
        notes: document.notes().to_vec(),
    };
    let shared = document.all_positions()?;
    for (number, entry) in document.meshes().iter().enumerate() {
        let note = |text: String| Note::new(Place::File, format!("{}: {text}", entry.name));
        let (table, positions) = match (
            document.culling(number),
            positions_of(document, shared.as_deref(), number)?,
        ) {
            (Some(table), Some(positions)) => (table, positions),
            _ => {
                report.without += 1;
                continue;
            }
        };
        let StoredCulling {
            center,
            reach,
            starts,
            planes,
        } = table;
        let table = CullingTable::from_parts(center, reach, starts, &planes);
        let mesh = compact(entry, &positions);
        let (table, mesh) = match (table, mesh) {
            (Ok(table), Ok(mesh)) => (table, mesh),
            (Err(error), _) => {
                report
                    .notes
                    .push(note(format!("its culling table is not sound: {error}")));
                report.without += 1;
                continue;
            }
            (_, Err(_)) => {
                report.without += 1;
                continue;
            }
        };

        let views = look_at(&mesh, &table, &options.distances, options.eyes);
        let wrong: u64 = views
            .iter()
            .map(|view: &ViewSums| view.wrongly_rejected)
            .sum();
        if wrong > 0 {
            report.notes.push(note(format!(
                "its culling table does not match its faces: in all views together, {wrong} front faces are left out"
            )));
        }
        let figures = CullingFigures {
            name: entry.name.clone(),
            faces: mesh.face_count(),
            clusters: table.cluster_count(),
            whole_misses: cache::misses(mesh.as_faces(), CACHE),
            views,
        };
        report.total.add(&figures);
        report.meshes.push(figures);
    }
    Ok(report)
}
