//! Writing the result of a job.

use std::path::Path;

use anyhow::{Context, Result};
use meshweft::files::{Document, Outputs, WriteOptions, Written};

use super::arguments::Run;
use super::interrupt;
use super::jobs::{Job, Jobs, names_of};
use super::side_file::{MANIFEST, PendingFile, SideFile};
use crate::usage::Usage;

/// Writes the result of a job, as the flags of the run say.
fn write(job: &Job, document: &Document, run: &Run, outputs: &Outputs) -> Result<Written> {
    let _no_interrupt = interrupt::hold_off();
    let mut options = WriteOptions::default();
    options.copy_companions = !run.no_copy;
    options.replace_read_only = run.force;
    options.outputs = Some(outputs);
    Ok(document.write_with(&job.target, &options)?)
}

/// Refuses a file to be written beside the mesh if there are several meshes, or it would replace one, the list
/// of the run, or a file of others.
pub(crate) fn check_side_file(kind: &SideFile, path: &Path, jobs: &Jobs, run: &Run) -> Result<()> {
    if !jobs.is_one_file {
        return Err(Usage(format!("{} takes one file at a time", kind.flag)).into());
    }
    kind.check_no_mesh(path, names_of(&jobs.list))?;
    if let Some(list) = &run.manifest {
        kind.check_other(path, list, MANIFEST.flag)?;
    }
    kind.check(path, run.force)?;
    Ok(())
}

/// Writes the result of a job if the flags of the run say so, and the text of a file beside it.
pub(crate) fn write_with_side_file(
    job: &Job,
    document: &Document,
    (run, outputs): (&Run, &Outputs),
    is_changed: bool,
    beside: Option<(&SideFile, &Path, &dyn Fn() -> String)>,
) -> Result<Option<Written>> {
    // On the disk before the mesh is, and named after it.
    let beside = beside.filter(|_| !run.dry_run).map(|(kind, path, text)| {
        let pending = PendingFile::new(path, text());
        let pending = pending.with_context(|| path.display().to_string())?;
        anyhow::Ok((kind, path, pending))
    });
    let beside = beside.transpose()?;

    let written = run.writes(is_changed);
    let written = written.then(|| write(job, document, run, outputs));
    let written = written.transpose()?;
    if let Some((kind, path, pending)) = beside {
        // A buffer that was just written may have that name.
        kind.check(path, run.force)?;
        let committed = pending.commit();
        committed.with_context(|| path.display().to_string())?;
    }
    Ok(written)
}

/// Says which buffers have another name now.
pub(crate) fn renamed_lines(job: &Job, written: &Written) -> Vec<String> {
    let file = job.target.display();
    let renamed = written.renamed.iter();
    let line = renamed
        .map(|(old, new)| format!("{file}: its buffer {} is now called {new}", old.display()));
    line.collect()
}
