//! Writing the result of a job.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use meshweft::files::{Document, Format, copy_file, is_gzip};

use super::interrupt;
use super::jobs::Job;

/// What became of a job's result.
pub(crate) struct Written {
    pub(crate) bytes: u64,
    /// Notes about buffers that have another name now.
    pub(crate) renamed: Vec<String>,
}

/// Writes the result of a job, creating folders; a read-only file is replaced with `force` only.
pub(crate) fn write(
    job: &Job,
    document: &Document,
    is_changed: bool,
    force: bool,
) -> Result<Written> {
    let target = &job.target;
    let _no_interrupt = interrupt::hold_off();
    if let Some(folder) = target.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    if !force && fs::metadata(target).is_ok_and(|data| data.permissions().readonly()) {
        bail!(
            "{} is read-only: give --force to replace it",
            target.display()
        );
    }

    if !is_changed && is_to_be_copied(document, &job.input, target) {
        let copied = copy_file(&job.input, target);
        let bytes = copied.with_context(|| target.display().to_string())?;
        let renamed = Vec::new();
        return Ok(Written { bytes, renamed });
    }
    let written = document.write(target)?;
    let file = target.display();
    let note = |(old, new): &(PathBuf, String)| {
        format!("{file}: its buffer {} is now called {new}", old.display())
    };
    Ok(Written {
        bytes: written.bytes,
        renamed: written.renamed.iter().map(note).collect(),
    })
}

/// Whether an unchanged file is copied instead of written: a compressed one, whose bytes might
/// change otherwise, and which brings no buffers along.
fn is_to_be_copied(document: &Document, input: &Path, target: &Path) -> bool {
    let is_one_file = document.format() != Format::Gltf;
    let same_format = Format::of_path(target) == Some(document.format());
    is_gzip(input) && is_gzip(target) && is_one_file && same_format
}
