//! What the reports of jobs that write files share.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use super::json;
use crate::files::{Document, Note, Written};

/// The file that a job was done on. The caller may add where it went, its size there and the time it took.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FileReport {
    /// The file that was read.
    pub file: PathBuf,
    /// The file that was written, if any: set by the caller.
    pub output: Option<PathBuf>,
    /// Size of the file and of the buffers beside it that were read.
    pub bytes_before: u64,
    /// The same of what was written; the size before where `optimize` and `simplify` change nothing.
    pub bytes_after: Option<u64>,
    /// How many files that it names were copied along: set by the caller.
    pub copied: usize,
    /// How long it took: set by the caller, who has a clock.
    pub seconds: Option<f64>,
    /// What was left as it is, and why.
    pub notes: Vec<Note>,
}

impl FileReport {
    /// Of a document as it is.
    pub(super) fn of(document: &Document) -> Self {
        Self {
            file: document.path().to_owned(),
            output: None,
            bytes_before: document.source_bytes(),
            bytes_after: None,
            copied: 0,
            seconds: None,
            notes: document.notes().to_vec(),
        }
    }

    /// Adds where the document went and what it takes there.
    pub fn set_output(&mut self, output: &Path, bytes: u64) {
        self.output = Some(output.to_owned());
        self.bytes_after = Some(bytes);
    }

    /// Adds what was copied along, and what there is to say about writing.
    pub fn add_written(&mut self, written: &Written) {
        self.copied += written.copied.len();
        self.notes.extend(written.notes.iter().cloned());
    }

    /// The beginning of the report as JSON.
    pub(super) fn json_head(&self, command: &str) -> Map<String, Value> {
        json::file_head(
            command,
            [Some(&self.file), self.output.as_deref()],
            (self.bytes_before, self.bytes_after),
            self.copied,
            self.seconds,
        )
    }
}
