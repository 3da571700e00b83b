//! Reports as JSON: one schema for the program and every binding.

use serde_json::{Map, Value, json};

use super::counts::Counts;
use crate::cache::CacheModel;
use crate::files::Note;

/// The version of the schema that reports follow. Members are added without a new number.
pub const SCHEMA: u32 = 1;

/// The beginning of a report: schema, command, version of this library.
pub(super) fn head(command: &str) -> Map<String, Value> {
    let mut report = Map::new();
    report.insert("schema".into(), json!(SCHEMA));
    report.insert("command".into(), json!(command));
    report.insert("version".into(), json!(env!("CARGO_PKG_VERSION")));
    report
}

impl Counts {
    /// The counts as the members of a JSON object.
    pub(super) fn json(&self) -> Map<String, Value> {
        let misses = self.misses.iter();
        let misses = misses.map(|(model, count)| (model.to_string(), json!(count)));
        let mut object = Map::new();
        object.insert("vertices".into(), json!(self.vertices));
        object.insert("used_vertices".into(), json!(self.used_vertices));
        object.insert("faces".into(), json!(self.faces));
        object.insert("misses".into(), Value::Object(misses.collect()));
        object.insert("acmr".into(), by_model(self.acmr()));
        object.insert("atvr".into(), by_model(self.atvr()));
        object.insert("overfetch".into(), json!(self.overfetch));
        object
    }
}

/// An object from model names to numbers.
fn by_model(values: impl Iterator<Item = (CacheModel, f64)>) -> Value {
    let members = values.map(|(model, value)| (model.to_string(), json!(value)));
    Value::Object(members.collect())
}

/// The counts after a change, with both figures where they differ.
pub(super) fn change(before: &Counts, after: &Counts) -> Map<String, Value> {
    let mut before = before.json();
    let mut object = after.json();
    for key in ["acmr", "atvr", "misses", "overfetch"] {
        let both = json!({"before": before.remove(key), "after": object.get(key)});
        object.insert(key.into(), both);
    }
    object
}

/// What was left as it is, and why.
pub(super) fn notes(notes: &[Note]) -> Value {
    let note = |note: &Note| json!({"place": note.place.to_string(), "text": note.text, "more": note.more});
    notes.iter().map(note).collect()
}
