//! What the tables of a document leave out, from many sides.

use std::collections::BTreeSet;

use super::build::compact;
use super::options::CullStatsOptions;
use super::stats_report::{CullStatsReport, CullingFigures};
use super::views::{CACHE, ViewSums, look_at};
use crate::cache;
use crate::culling::CullingTable;
use crate::files::{Document, FileError, MeshEntry, Note, PlacedTable, StoredCulling};

/// Looks at the faces of each culling table from many sides, and counts what is drawn.
///
/// Several primitives may draw the faces of a mesh; each table is judged by the positions of its own. Directions are
/// spread at random over the sphere, always the same ones. A face that faces the eye and is not drawn is counted too:
/// there is none, if the table matches the faces. A table that does not match them, or that cannot be used, is among
/// [`CullStatsReport::wrong`], with its place. The tables of levels of detail are only looked at for that: what is counted is of
/// meshes at full resolution.
///
/// # Errors
/// Positions cannot be read.
///
/// # Complexity
/// Time O(distances × eyes × faces of all tables), of which no more than 64 are looked at for a mesh; space O(vertices +
/// faces) a thread beyond the document.
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
        wrong: document.damaged_table().cloned().into_iter().collect(),
        total: CullingFigures::none("all meshes", options.distances.len()),
        notes: document.notes().to_vec(),
    };

    // Each table.
    let mut judged = BTreeSet::new();
    document.each_table(&mut |placed| {
        let mesh = placed.mesh;
        let place = placed.place.clone();
        let entry = &document.meshes()[mesh];
        match figures(entry, placed, options) {
            Ok(None) => {}
            Ok(Some(figures)) => {
                let wrong: u64 = figures.views.iter().map(|view| view.wrongly_rejected).sum();
                if wrong > 0 {
                    report.wrong.push(Note::new(place, format!(
                        "{}: its culling table does not match its faces: in all views together, {wrong} front faces are left out",
                        figures.name
                    )));
                }
                if entry.level.is_none() {
                    judged.insert(mesh);
                    report.total.add(&figures);
                    report.meshes.push(figures);
                }
            }
            Err(why) => {
                let name = &entry.name;
                report.wrong.push(Note::new(place, format!("{name}: {why}")));
            }
        }
    })?;
    let full = document.meshes().iter().filter(|it| it.level.is_none());
    report.without = full.count() - judged.len();
    Ok(report)
}

/// What a table leaves out; nothing to say if its primitive has no positions.
///
/// # Errors
/// Why the table cannot be used.
fn figures(
    entry: &MeshEntry,
    placed: PlacedTable<'_>,
    options: &CullStatsOptions,
) -> Result<Option<CullingFigures>, String> {
    let StoredCulling {
        center,
        reach,
        starts,
        planes,
    } = placed
        .table
        .ok_or("there are more culling tables of the same faces than are looked at")?;
    let table = CullingTable::from_parts(center, reach, starts, &planes);
    let table = table.map_err(|error| format!("its culling table is out of range: {error}"))?;
    let Some(Ok(mesh)) = placed.positions.map(|positions| compact(entry, positions)) else {
        return Ok(None);
    };
    let views: Vec<ViewSums> = look_at(&mesh, &table, &options.distances, options.eyes);
    Ok(Some(CullingFigures {
        name: match placed.is_first {
            true => entry.name.clone(),
            false => format!("{}, drawn by {}", entry.name, placed.place),
        },
        faces: mesh.face_count(),
        clusters: table.cluster_count(),
        whole_misses: cache::misses(mesh.as_faces(), CACHE),
        views,
    }))
}
