//! What is said about an optimised file.

use std::path::Path;

use meshweft::CacheModel;
use meshweft::files::Document;
use serde_json::{Map, Value, json};

use super::arguments::Optimize;
use super::improve::Improvement;
use crate::count::{Counts, by_model, ratio};
use crate::run::{Outcome, output};

/// A file after the work on it; of two counts the first is from before.
pub(super) struct Optimized<'a> {
    pub(super) document: &'a Document,
    pub(super) improvement: &'a Improvement,
    pub(super) target: &'a Path,
    pub(super) is_written: bool,
    pub(super) total: [Counts; 2],
    pub(super) meshes: [&'a [Counts]; 2],
}

impl Optimized<'_> {
    /// For programs and for people.
    pub(super) fn outcome(&self, arguments: &Optimize) -> Outcome {
        Outcome {
            json: self.json(arguments),
            text: self.text(arguments),
            notes: output::note_lines(self.document),
        }
    }

    fn json(&self, arguments: &Optimize) -> Value {
        let meshes = 0..self.document.meshes().len();
        let meshes: Vec<Value> = meshes.map(|mesh| self.mesh_json(mesh)).collect();
        let [before, after] = &self.total;
        json!({
            "file": shown(self.document.path()),
            "output": self.is_written.then(|| shown(self.target)),
            "cache": arguments.cache.to_string(),
            "effort": arguments.effort.to_string(),
            "mode": arguments.mode.to_string(),
            "meshes": meshes,
            "total": change(before, after),
            "notes": output::notes_json(self.document),
        })
    }

    fn mesh_json(&self, mesh: usize) -> Value {
        let entry = &self.document.meshes()[mesh];
        let [before, after] = self.meshes;
        let (moved_faces, moved_vertices) = (
            self.improvement.moved_faces(mesh),
            self.improvement.moved_vertices(entry),
        );
        let mut object = change(&before[mesh], &after[mesh]);
        object.shift_insert(0, "name".into(), json!(entry.name));
        object.insert("changed".into(), json!(moved_faces));
        object.insert("vertices_moved".into(), json!(moved_vertices));
        if let Some(reason) = self.improvement.reason(mesh) {
            object.insert("reason".into(), json!(reason));
        }
        if let Some(pushes) = self.improvement.scheduled(mesh) {
            let per_face = ratio(pushes as f64, entry.mesh.face_count());
            object.insert("scheduled".into(), json!(per_face));
        }
        Value::Object(object)
    }

    fn text(&self, arguments: &Optimize) -> String {
        let [before, after] = &self.total;
        let mut text = format!(
            "{}\n  {} faces, {} vertices",
            shown(self.document.path()),
            before.faces,
            before.vertices,
        );

        // Caches: those that were ordered for.
        let is_gpu = |model: &CacheModel| matches!(model, CacheModel::Batch(_));
        let ordered_for = |model: &CacheModel| arguments.cache.models().contains(model);
        let caches = before.acmr().zip(after.acmr());
        let caches = caches.filter(|((model, _), _)| !is_gpu(model) && ordered_for(model));
        let caches = caches.map(|((model, a), (_, b))| format!("{model} {a:.4} -> {b:.4}"));
        let caches: Vec<_> = caches.collect();
        if !caches.is_empty() {
            text += &format!("\n  misses per face: {}", caches.join(", "));
        }

        // GPUs: all.
        let gpus = before.atvr().zip(after.atvr());
        let gpus = gpus.filter(|((model, _), _)| is_gpu(model));
        let gpus = gpus.map(|((model, a), (_, b))| format!("{model} {a:.3} -> {b:.3}"));
        let gpus: Vec<_> = gpus.collect();
        text += &format!("\n  transforms per vertex: {}", gpus.join(", "));

        if let Some(scheduled) = self.improvement.scheduled_total() {
            let per_face = ratio(scheduled as f64, after.faces);
            text += &format!("\n  scheduled pushes per face: {per_face:.4}");
        }

        let target = shown(self.target);
        text += &match (self.improvement.changes(), self.is_written) {
            (true, true) => format!("\n  written to {target}"),
            (false, true) => format!("\n  nothing to improve: copied to {target}"),
            (true, false) => "\n  not written: dry run".to_owned(),
            (false, false) => "\n  nothing to improve: left as it is".to_owned(),
        };
        text
    }
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// The counts of the new order, and from before where they may differ.
fn change(before: &Counts, after: &Counts) -> Map<String, Value> {
    let mut object = after.json();
    let both = |a, b| json!({"before": a, "after": b});
    let acmr = both(by_model(before.acmr()), by_model(after.acmr()));
    object.insert("acmr".into(), acmr);
    let atvr = both(by_model(before.atvr()), by_model(after.atvr()));
    object.insert("atvr".into(), atvr);
    for key in ["misses", "overfetch"] {
        let [a, b] = [before, after].map(|c| c.json().remove(key).unwrap_or_default());
        object.insert(key.into(), both(a, b));
    }
    object
}
