//! Figures of meshes that get coarser: 6, 7, 8b and 8d.

use anyhow::Result;
use meshweft::operations::{Method, SequenceUpdate, collapse_history};
use meshweft::progressive::History;
use meshweft::{Mesh, MeshError};
use serde_json::json;

use super::found::{Found, fifo};
use super::steps::{jumps, steps};
use crate::paper::figure::{Figure, cells, head};
use crate::paper::irregular::Irregular;
use crate::paper::levels::{ordered_again, updated};

/// Percent of the faces.
const PERCENT: [usize; 10] = [100, 90, 80, 70, 60, 50, 40, 30, 20, 10];
/// The cache size of all these figures.
const SIZE: u32 = 16;

/// A sequence that follows two removals.
pub(super) fn fig_6() -> Result<Figure> {
    let mut rows = vec![head(&[
        "",
        "faces",
        "jumps",
        "misses per face, K = 16",
        "vertex removed next",
        "its faces",
        "new faces",
    ])];
    let mut json = Vec::new();
    for (step, name) in steps()?
        .iter()
        .zip(["high resolution", "one removed", "two removed"])
    {
        let acmr = fifo(&step.faces, SIZE);
        let row = [
            name.to_owned(),
            step.faces.len().to_string(),
            jumps(&step.faces).to_string(),
            format!("{acmr:.3}"),
        ];
        let next = step.next.as_ref();
        let next = next.map(|next| [next.vertex as usize, next.star.len(), next.hole.len()]);
        let next_cells = next.map(|next| next.map(|number| number.to_string()));
        rows.push(
            row.into_iter()
                .chain(next_cells.unwrap_or_default())
                .collect(),
        );
        json.push(json!({
            "faces": step.faces.len(), "jumps": jumps(&step.faces), "acmr": acmr,
            "next": next.map(|[vertex, removed, inserted]| {
                json!({"vertex": vertex, "removed_faces": removed, "inserted_faces": inserted})
            }),
        }));
    }

    Ok(Figure {
        title: "A small irregular mesh, made here: its sequence by recursive cut, kept up by the smart update \
                while two\nvertices are removed. A jump goes to a face without a common edge. Drawn with \
                --pictures."
            .to_owned(),
        rows,
        json: json!(json),
    })
}

/// The irregular mesh as it gets coarser.
pub(super) fn fig_7() -> Result<Figure> {
    let mesh = Irregular::of_the_paper().surface();
    let history = history(&mesh)?;
    let levels = levels(&history);
    let counts = levels.iter().map(|&level| history.face_count(level));
    let counts: Vec<usize> = counts.collect();

    let mut rows = vec![
        ["faces".to_owned()]
            .into_iter()
            .chain(counts.iter().map(usize::to_string))
            .collect(),
    ];
    let mut json = Vec::new();
    for method in [Method::RecursiveCut, Method::LinearArrangement] {
        let mut push = |name: &str, acmr: Vec<f64>| {
            rows.push(cells(format!("{method}, {name}"), acmr.iter().copied()));
            json.push(
                json!({"sequence": method.name(), "update": name.replace(' ', "_"), "acmr": acmr}),
            );
        };
        let order = method.order(history.full_faces());
        for update in [SequenceUpdate::Simple, SequenceUpdate::Smart] {
            push(
                update.name(),
                updated(update, &history, &order, &levels, SIZE)?,
            );
        }
        push(
            "new at each level",
            ordered_again(method, &history, &levels, SIZE)?,
        );
    }

    Ok(Figure {
        title: "The irregular mesh of Fig. 4b on a paraboloid as it gets coarser, by half-edge collapses: \
                misses per face at\na cache of 16. The paper drew curves and printed no numbers."
            .to_owned(),
        rows,
        json: json!({"faces": counts, "sequences": json}),
    })
}

/// The test meshes as they get coarser, each in one sequence that the smart update keeps up.
pub(super) fn fig_8_coarser(found: &[Found], method: Method) -> Result<Figure> {
    let names = PERCENT.iter().map(|percent| format!("{percent} %"));
    let mut rows = vec![[String::new()].into_iter().chain(names).collect()];
    let mut json = Vec::new();
    for it in found {
        let history = history(&it.mesh)?;
        let order = method.order(history.full_faces());
        let acmr = updated(
            SequenceUpdate::Smart,
            &history,
            &order,
            &levels(&history),
            SIZE,
        )?;
        rows.push(cells(it.name(), acmr.iter().copied()));
        json.push(json!({"mesh": it.printed.mesh, "acmr": acmr}));
    }

    Ok(Figure {
        title: format!(
            "Misses per face at a cache of 16 over the faces that are left, by half-edge collapses: the \
             sequence\nby {method}, kept up by the smart update. A row ends where no more can \
             leave. The paper drew curves.\n\
             * the file is another version of the mesh than the paper's."
        ),
        rows,
        json: json!({"percent": PERCENT, "rows": json}),
    })
}

/// A tenth of the faces is left, where that can be.
fn history(mesh: &Mesh) -> Result<History, MeshError> {
    collapse_history(mesh, mesh.face_count() / 10)
}

/// The levels of the columns, as far as the history goes.
fn levels(history: &History) -> Vec<usize> {
    let full = history.full_faces().len();
    let level = |percent: &usize| history.level_of_faces(full * percent / 100);
    PERCENT.iter().map_while(level).collect()
}
