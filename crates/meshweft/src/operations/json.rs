//! Reports as JSON: one schema for the program and every binding.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::counts::Counts;
use crate::cache::CacheModel;
use crate::cache::nvidia::DrawCounts;
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

/// The beginning of a report on a file that may have been written: where it is, where it went, its sizes
/// before and after, how many files were copied along, and how long it took.
pub(super) fn file_head(
    command: &str,
    [file, output]: [Option<&Path>; 2],
    bytes: (u64, Option<u64>),
    copied: usize,
    seconds: Option<f64>,
) -> Map<String, Value> {
    let mut report = head(command);
    let members = [
        ("file", name(file)),
        ("output", name(output)),
        ("bytes", json!({"before": bytes.0, "after": bytes.1})),
        ("copied", json!(copied)),
        ("seconds", json!(seconds)),
    ];
    report.extend(members.map(|(key, value)| (key.to_owned(), value)));
    report
}

/// The name of a file, if there is one.
pub(super) fn name(path: Option<&Path>) -> Value {
    json!(path.map(|path| path.display().to_string()))
}

/// A report as one line, with `items` as the array in its member `list`.
///
/// Made item by item: all as values at once would take several times the text, which is long where
/// there are many meshes.
pub(super) fn with_list(
    report: &Map<String, Value>,
    list: &str,
    items: impl Iterator<Item = Value>,
) -> String {
    let mut items = Some(items);
    let mut text = String::from("{");
    for (key, value) in report {
        let comma = if text.len() > 1 { "," } else { "" };
        text += &format!("{comma}{}:", json!(key));
        match items.take_if(|_| key == list) {
            None => text += &value.to_string(),
            Some(items) => {
                text += "[";
                for (number, item) in items.enumerate() {
                    text += if number > 0 { "," } else { "" };
                    text += &item.to_string();
                }
                text += "]";
            }
        }
    }
    text + "}"
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
        if let Some(card) = &self.card {
            object.insert("card".into(), of_card(card));
        }
        object.insert("overfetch".into(), json!(self.overfetch));
        object
    }
}

/// What an NVIDIA card counts.
fn of_card(card: &DrawCounts) -> Value {
    json!({
        "primitives": card.primitives,
        "invocations": card.invocations,
        "distinct_vertices": card.distinct_vertices,
        "warps": card.warps,
        "warps_over_floor": card.warps_over_floor(),
        "setup_cycles": card.setup_cycles,
        "setup_cycles_over_floor": card.setup_cycles_over_floor(),
        "wide_batches": card.wide_batches,
    })
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
    for key in ["acmr", "atvr", "misses", "card", "overfetch"] {
        if let Some(after) = object.get(key) {
            let both = json!({"before": before.remove(key), "after": after});
            object.insert(key.into(), both);
        }
    }
    object
}

/// What was left as it is, and why.
pub(super) fn notes(notes: &[Note]) -> Value {
    let note = |note: &Note| json!({"place": note.place.to_string(), "text": note.text, "more": note.more});
    notes.iter().map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_made_item_by_item_is_the_same_text() {
        for items in [vec![], vec![json!({"a": 1})], vec![json!(1), json!("\"")]] {
            let mut report = head("test");
            report.insert("list".into(), Value::Null);
            report.insert("more \"".into(), json!([null, 2]));
            let text = with_list(&report, "list", items.iter().cloned());
            report["list"] = items.into();
            assert_eq!(text, Value::Object(report).to_string());
        }
    }
}
