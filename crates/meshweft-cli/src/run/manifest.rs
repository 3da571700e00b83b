//! The list of what a run has done, from which a later run continues where it was cut off.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Result};
use meshweft::operations::SCHEMA;
use serde_json::{Value, json};

use super::side_file::is_list;
use crate::usage::Usage;

/// A file of JSON lines, one for each finished input.
pub(super) struct Manifest {
    path: PathBuf,
    /// `None` if nothing is to be written.
    file: Option<Mutex<File>>,
    /// Input and output of what was done before.
    done: BTreeSet<(String, String)>,
}

impl Manifest {
    /// Reads what is in the manifest, and opens it, or a new one, unless nothing is to be written.
    pub(super) fn open(path: &Path, is_dry_run: bool) -> Result<Self> {
        let context = || path.display().to_string();
        let text = match fs::read(path) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(error).with_context(context),
        };

        if !is_list(text.as_bytes()) {
            let text =
                "not every line of this file is one that --manifest writes: choose another name";
            return Err(Usage(format!("--manifest {}: {text}", path.display())).into());
        }

        // What is done. Lines that are not whole, or say something else, are passed over.
        let mut done = BTreeSet::new();
        let lines = text
            .split_inclusive('\n')
            .filter(|line| line.ends_with('\n'));
        for line in lines {
            let Ok(line) = serde_json::from_str::<Value>(line) else {
                continue;
            };
            let member = |name: &str| line[name].as_str().map(str::to_owned);
            if line["status"] == "done"
                && let Some(pair) = member("file").zip(member("output"))
            {
                done.insert(pair);
            }
        }

        let path = path.to_owned();
        if is_dry_run {
            let file = None;
            return Ok(Self { path, file, done });
        }
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let mut file = file.with_context(context)?;
        // A run that was killed may have left half a line: the next one must not be added to it.
        if !text.is_empty() && !text.ends_with('\n') {
            file.write_all(b"\n").with_context(context)?;
        }
        let file = Some(Mutex::new(file));
        Ok(Self { path, file, done })
    }

    /// Whether an earlier run wrote `output` from `input`, and it is still there.
    pub(super) fn has(&self, input: &Path, output: &Path) -> bool {
        // In the list, names that are not UTF-8 may be equal where they are not.
        if input.to_str().is_none() || output.to_str().is_none() {
            return false;
        }
        let pair = (input.display().to_string(), output.display().to_string());
        self.done.contains(&pair) && output.exists()
    }

    /// Adds the line of an input, unless nothing is to be written: the sums of its report, as JSON, or why it failed.
    pub(super) fn add(
        &self,
        input: &Path,
        output: &Path,
        result: Result<&str, String>,
    ) -> Result<()> {
        let Some(file) = &self.file else {
            return Ok(());
        };
        let mut line = json!({
            "schema": SCHEMA,
            "file": input.display().to_string(),
            "output": output.display().to_string(),
        });
        match result {
            Ok(total) => {
                line["status"] = "done".into();
                line["total"] = serde_json::from_str(total)?;
            }
            Err(error) => {
                line["status"] = "failed".into();
                line["error"] = error.into();
            }
        }

        // In one write: no other thread's line comes in between.
        let line = format!("{line}\n");
        let mut file = file.lock().unwrap_or_else(|lock| lock.into_inner());
        file.write_all(line.as_bytes())
            .with_context(|| self.path.display().to_string())
    }
}
