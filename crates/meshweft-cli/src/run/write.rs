//! Writing the result of a job.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use meshweft::files::{Document, Format, is_gzip};

use super::interrupt;
use super::jobs::Job;

/// Writes the result of a job, creating folders; returns the number of bytes written.
pub(crate) fn write(job: &Job, document: &Document, is_changed: bool) -> Result<u64> {
    let target = &job.target;
    let _no_interrupt = interrupt::hold_off();
    if let Some(folder) = target.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }

    if !is_changed && is_to_be_copied(document, &job.input, target) {
        return fs::copy(&job.input, target).with_context(|| target.display().to_string());
    }
    Ok(document.write(target)?.bytes)
}

/// Whether an unchanged file is copied instead of written: a compressed one, whose bytes might
/// change otherwise, and which brings no buffers along.
fn is_to_be_copied(document: &Document, input: &Path, target: &Path) -> bool {
    let is_one_file = document.format() != Format::Gltf;
    let same_format = Format::of_path(target) == Some(document.format());
    is_gzip(input) && is_gzip(target) && is_one_file && same_format
}
