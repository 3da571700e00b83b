//! Writing what became of a file.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use meshweft::files::{Document, Format};

use super::interrupt;
use super::jobs::Job;

/// Writes the document of a job to where its result goes; folders are made.
pub(crate) fn write(job: &Job, document: &Document, is_changed: bool) -> Result<()> {
    let target = &job.target;
    let _whole = interrupt::hold_off();
    if let Some(folder) = target.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    if !is_changed && is_copied(document, &job.input, target) {
        fs::copy(&job.input, target).with_context(|| target.display().to_string())?;
        return Ok(());
    }
    document.write(target)?;
    Ok(())
}

/// Whether an unchanged file is copied as it is: a compressed one, which written again might come
/// out in other bytes.
fn is_copied(document: &Document, input: &Path, target: &Path) -> bool {
    let is_gzip = |path: &Path| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
    };
    let is_one_file = document.format() != Format::Gltf;
    let same_format = Format::of_path(target) == Some(document.format());
    is_gzip(input) && is_gzip(target) && is_one_file && same_format
}
