//! Counts of a document as it is.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::counts::Counts;
use super::json;
use crate::cache::CacheModel;
use crate::files::{Document, Format, Note};

/// The counts of a document's meshes under these models. Levels of detail stand with the mesh that they are levels of.
///
/// # Complexity
/// One [`cache::report`](crate::cache::report) a mesh and model.
#[must_use]
pub fn inspect(document: &Document, models: &[CacheModel]) -> InspectReport {
    let entries = document.meshes();
    let counts = Counts::of_each(entries, models);
    let total = Counts::total(entries, &counts, models);

    // Levels by the number of their mesh.
    let mut levels: BTreeMap<usize, Vec<InspectedLevel>> = BTreeMap::new();
    for (entry, counts) in entries.iter().zip(&counts) {
        if let Some(level) = entry.level {
            levels.entry(level.of).or_default().push(InspectedLevel {
                number: level.number,
                name: entry.name.clone(),
                error: level.error,
                counts: counts.clone(),
            });
        }
    }

    // The meshes that they are of, and all others.
    let meshes = entries.iter().zip(counts).enumerate();
    let full = meshes.filter(|(_, (entry, _))| entry.level.is_none());
    let meshes = full.map(|(number, (entry, counts))| {
        let mut levels = levels.remove(&number).unwrap_or_default();
        levels.sort_by_key(|level| level.number);
        InspectedMesh {
            name: entry.name.clone(),
            counts,
            levels,
        }
    });
    InspectReport {
        file: document.path().to_owned(),
        format: document.format(),
        bytes: document.source_bytes(),
        meshes: meshes.collect(),
        total,
        notes: document.notes().to_vec(),
    }
}

/// What [`inspect`] counted.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct InspectReport {
    /// The file.
    pub file: PathBuf,
    /// Its format.
    pub format: Format,
    /// Its size and that of the buffers beside it that were read.
    pub bytes: u64,
    /// Each mesh at full resolution.
    pub meshes: Vec<InspectedMesh>,
    /// All meshes at full resolution together, without levels of detail.
    pub total: Counts,
    /// What cannot be re-ordered, and why.
    pub notes: Vec<Note>,
}

/// A mesh as it is.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct InspectedMesh {
    /// What the file calls it.
    pub name: String,
    /// What was counted.
    pub counts: Counts,
    /// Its levels of detail, from fine to coarse.
    pub levels: Vec<InspectedLevel>,
}

/// A level of detail as it is.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct InspectedLevel {
    /// 1 is the finest below full resolution.
    pub number: usize,
    /// What the file calls it.
    pub name: String,
    /// How far it is off, as the file states it, in units of the positions.
    pub error: Option<f32>,
    /// What was counted. Vertices that no face uses count too, as levels may share them.
    pub counts: Counts,
}

impl InspectReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mesh = |mesh: &InspectedMesh| {
            let mut object = mesh.counts.json();
            object.shift_insert(0, "name".into(), json!(mesh.name));
            if !mesh.levels.is_empty() {
                let levels = mesh.levels.iter().map(InspectedLevel::json);
                object.insert("levels".into(), levels.collect());
            }
            Value::Object(object)
        };
        let mut report = json::head("inspect");
        report.insert("file".into(), json!(self.file.display().to_string()));
        report.insert("format".into(), json!(self.format.to_string()));
        report.insert("bytes".into(), json!(self.bytes));
        report.insert("meshes".into(), Value::Null);
        report.insert("total".into(), Value::Object(self.total.json()));
        report.insert("notes".into(), json::notes(&self.notes));
        json::with_list(&report, "meshes", self.meshes.iter().map(mesh))
    }
}

impl InspectedLevel {
    fn json(&self) -> Value {
        let mut object = self.counts.json();
        let members = [
            ("level", json!(self.number)),
            ("name", json!(self.name)),
            ("error", json!(self.error)),
        ];
        for (place, (key, value)) in members.into_iter().enumerate() {
            object.shift_insert(place, key.to_owned(), value);
        }
        Value::Object(object)
    }
}
