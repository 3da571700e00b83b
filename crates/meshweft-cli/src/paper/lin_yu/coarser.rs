//! Figures of meshes that get coarser: 11 and 12.

use std::time::Instant;

use anyhow::Result;
use meshweft::operations::{SequenceUpdate, collapse_history};
use meshweft::order::Mode;
use meshweft::progressive::History;
use meshweft::{CacheModel, FaceOrder, Mesh, MeshError, cache};
use serde_json::{Value, json};

use super::found::{Found, SIZE, algorithm};
use super::printed::{FIG_12, FIG_12_PERCENT, Work};
use crate::paper::figure::{Figure, cells, head};
use crate::paper::levels::{ordered_again, updated};

/// Percent of the vertices that are left.
const PERCENT: [usize; 10] = [100, 90, 80, 70, 60, 50, 40, 30, 20, 10];
/// The meshes of Fig. 11.
const FIG_11: [&str; 2] = ["cow", "mannequin"];
/// A mesh that the paper has in other figures, as large as the largest of Fig. 12.
const MORE: &str = "dragon";

/// A mesh that gets coarser, and the sequence at full resolution.
struct Coarsened {
    history: History,
    order: FaceOrder,
    used_vertices: usize,
}

impl Coarsened {
    /// As far as the mesh can get coarser.
    fn new(mesh: &Mesh) -> Result<Self, MeshError> {
        let history = collapse_history(mesh, 0)?;
        let full = history.full_faces();
        let order = algorithm(CacheModel::fifo(SIZE), Mode::Fast).order(full);
        let used_vertices = cache::report(full, CacheModel::fifo(SIZE)).used_vertices;
        Ok(Self {
            history,
            order,
            used_vertices,
        })
    }

    /// What it takes to get to a level, and to order it again.
    fn work(&self, level: usize) -> Result<Work, MeshError> {
        let history = &self.history;

        // What the records name.
        let inserted = history.records().take(level);
        let inserted: usize = inserted.map(|record| record.inserted_faces.len()).sum();

        // The update.
        let start = Instant::now();
        let mut faces = Vec::new();
        SequenceUpdate::Adaptive.at_levels(history, &self.order, [level], |updated| {
            faces = updated.to_vec();
        })?;
        let seconds = start.elapsed().as_secs_f64();

        // The same faces in a new order.
        let start = Instant::now();
        let order = algorithm(CacheModel::fifo(SIZE), Mode::Fast).order(&faces);
        std::hint::black_box(order.apply(&faces));
        let new_order = start.elapsed().as_secs_f64();

        Ok(Work {
            counts: [
                history.vertex_count() - history.vertex_count_at(level),
                history.full_faces().len() + inserted - history.face_count(level),
                inserted,
            ],
            seconds,
            new_order: Some(new_order),
        })
    }

    /// The finest level at which at most this share of the vertices in use is left.
    fn level(&self, percent: usize) -> Option<usize> {
        let removed = self.used_vertices - self.used_vertices * percent / 100;
        let full = self.history.vertex_count();
        let has_removed = |level: &usize| full - self.history.vertex_count_at(*level) >= removed;
        (0..=self.history.len()).find(has_removed)
    }
}

impl Work {
    fn row(&self, mesh: String, who: &str, percent: usize) -> Vec<String> {
        let digits = if self.new_order.is_some() { 5 } else { 3 };
        let mut row = vec![mesh, who.to_owned(), format!("{percent} %")];
        row.extend(self.counts.map(|count| count.to_string()));
        row.push(format!("{:.digits$}", self.seconds));
        row.extend(self.new_order.map(|seconds| format!("{seconds:.5}")));
        row
    }

    fn json(&self, who: &str, percent: usize) -> Value {
        let [vertices, deleted, inserted] = self.counts;
        json!({
            "who": who, "percent": percent, "deleted_vertices": vertices, "deleted_faces": deleted,
            "inserted_faces": inserted, "seconds": self.seconds, "new_order_seconds": self.new_order,
        })
    }
}

/// Misses per face as two meshes get coarser.
pub(super) fn fig_11(found: &[Found]) -> Result<Figure> {
    let names = PERCENT.iter().map(|percent| format!("{percent} %"));
    let mut rows = vec![[String::new()].into_iter().chain(names).collect()];
    let mut json = Vec::new();
    for it in found.iter().filter(|it| FIG_11.contains(&it.printed.mesh)) {
        let mesh = Coarsened::new(&it.mesh)?;
        let levels: Vec<usize> = PERCENT
            .iter()
            .map_while(|&percent| mesh.level(percent))
            .collect();

        let mut object = json!({"mesh": it.printed.mesh});
        let mut push = |name: &str, acmr: Vec<f64>| {
            rows.push(cells(
                format!("{}, {name}", it.name()),
                acmr.iter().copied(),
            ));
            object[name.replace(' ', "_")] = json!(acmr);
        };
        for update in [SequenceUpdate::Simple, SequenceUpdate::Adaptive] {
            push(
                update.name(),
                updated(update, &mesh.history, &mesh.order, &levels, SIZE)?,
            );
        }
        let method = algorithm(CacheModel::fifo(SIZE), Mode::Fast);
        push(
            "new at each level",
            ordered_again(method, &mesh.history, &levels, SIZE)?,
        );
        json.push(object);
    }

    Ok(Figure {
        title: format!(
            "Misses per face at a cache of {SIZE} over the vertices that are left, by half-edge collapses; \
             sequences\nby K-Cache-Reorder, fast mode. The paper drew curves and printed no numbers.\n\
             * the file is another version of the mesh than the paper's."
        ),
        rows,
        json: json!({"percent": PERCENT, "meshes": json}),
    })
}

/// What the adaptive update has to do, and how long it takes.
pub(super) fn fig_12(found: &[Found]) -> Result<Figure> {
    let mut rows = vec![head(&[
        "",
        "",
        "vertices left",
        "deleted vertices",
        "deleted faces",
        "inserted faces",
        "adaptive, s",
        "new order, s",
    ])];

    let mut json = Vec::new();
    let printed = FIG_12.iter().map(|(name, printed)| (*name, Some(printed)));
    for (name, printed) in printed.chain([(MORE, None)]) {
        let Some(it) = found.iter().find(|it| it.printed.mesh == name) else {
            continue;
        };
        let mesh = Coarsened::new(&it.mesh)?;

        // The paper's row above ours, the name in the first.
        let mut levels = Vec::new();
        for (at, percent) in FIG_12_PERCENT.into_iter().enumerate() {
            let mut push = |who: &str, work: &Work| {
                let mesh = if at == 0 && levels.is_empty() {
                    it.name()
                } else {
                    String::new()
                };
                rows.push(work.row(mesh, who, percent));
                levels.push(work.json(who, percent));
            };
            if let Some(printed) = printed {
                push("paper", &printed[at]);
            }
            if let Some(level) = mesh.level(percent) {
                push("ours", &mesh.work(level)?);
            }
        }
        json.push(json!({"mesh": name, "levels": levels}));
    }

    Ok(Figure {
        title: format!(
            "The adaptive update from full resolution to a level, its set-up and output counted: the paper's \
             (2005), ours\nby half-edge collapses; and the time of a new order by K-Cache-Reorder, fast mode, \
             K = {SIZE}.\n* the file is another version of the mesh than the paper's."
        ),
        rows,
        json: Value::Array(json),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::irregular::Irregular;

    #[test]
    fn levels_and_counts_are_of_vertices_in_use() {
        let surface = Irregular::of_the_paper().surface();
        let mut positions = surface.positions().to_vec();
        positions.extend((0..100_u8).map(|i| [f32::from(i), 5.0, 5.0]));
        let mesh = Coarsened::new(&Mesh::new(positions, surface.faces()).unwrap()).unwrap();
        assert_eq!(mesh.used_vertices, 509);
        assert_eq!(mesh.level(100), Some(0));

        // One vertex a record; inside two faces fewer, on the boundary one.
        let level = mesh.level(50).unwrap();
        let [vertices, deleted, inserted] = mesh.work(level).unwrap().counts;
        assert_eq!((level, vertices), (255, 255));
        let left = mesh.history.face_count(level);
        assert_eq!(950 - left, deleted - inserted);
        assert!((255..=510).contains(&(deleted - inserted)));
        assert_eq!(mesh.level(0), None);
    }
}
