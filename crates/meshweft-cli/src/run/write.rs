//! Writing the result of a job.

use anyhow::Result;
use meshweft::files::{Document, Outputs, WriteOptions, Written};

use super::arguments::Run;
use super::interrupt;
use super::jobs::Job;

/// Writes the result of a job, as the flags of the run say.
pub(crate) fn write(
    job: &Job,
    document: &Document,
    run: &Run,
    outputs: &Outputs,
) -> Result<Written> {
    let _no_interrupt = interrupt::hold_off();
    let mut options = WriteOptions::default();
    options.copy_companions = !run.no_copy;
    options.replace_read_only = run.force;
    options.outputs = Some(outputs);
    Ok(document.write_with(&job.target, &options)?)
}

/// Says which buffers have another name now.
pub(crate) fn renamed_lines(job: &Job, written: &Written) -> Vec<String> {
    let file = job.target.display();
    let renamed = written.renamed.iter();
    let line = renamed
        .map(|(old, new)| format!("{file}: its buffer {} is now called {new}", old.display()));
    line.collect()
}
