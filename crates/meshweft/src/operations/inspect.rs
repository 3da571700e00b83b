//! Counts of a document as it is.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::counts::Counts;
use super::json;
use crate::cache::CacheModel;
use crate::files::{Document, Format, Note};

/// The counts of a document's meshes under these models.
///
/// # Complexity
/// One [`cache::report`](crate::cache::report) a mesh and model.
#[must_use]
pub fn inspect(document: &Document, models: &[CacheModel]) -> InspectReport {
    let entries = document.meshes();
    let counts = Counts::of_each(entries, models);
    let total = Counts::total(entries, &counts, models);
    let names = entries.iter().map(|entry| entry.name.clone());
    InspectReport {
        file: document.path().to_owned(),
        format: document.format(),
        bytes: document.source_bytes(),
        meshes: names.zip(counts).collect(),
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
    /// Each mesh by name.
    pub meshes: Vec<(String, Counts)>,
    /// All meshes together.
    pub total: Counts,
    /// What cannot be re-ordered, and why.
    pub notes: Vec<Note>,
}

impl InspectReport {
    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mesh = |(name, counts): &(String, Counts)| {
            let mut object = counts.json();
            object.shift_insert(0, "name".into(), json!(name));
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
