//! The end of a job: its result is written, and its report says where it went.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use meshweft::files::{Document, Written};
use meshweft::operations::FileReport;

use super::arguments::Run;
use super::jobs::{Job, Jobs};
use super::output;
use super::side_file::SideFile;
use super::write;

/// What it takes to end a job.
pub(crate) struct Ending<'a, 'b> {
    pub(crate) job: &'a Job,
    pub(crate) jobs: &'a Jobs,
    pub(crate) run: &'a Run,
    /// When the job began.
    pub(crate) start: Instant,
    /// A file to be written beside the mesh, and its text.
    pub(crate) beside: Option<(&'static SideFile, &'b Path, &'b dyn Fn() -> String)>,
}

impl<'a> Ending<'a, '_> {
    /// Writes the document if the flags of the run say so.
    pub(crate) fn write(self, document: &Document, is_changed: bool) -> Result<Ended<'a>> {
        let to = (self.run, &self.jobs.outputs);
        let written = write::write_with_side_file(self.job, document, to, is_changed, self.beside)?;
        Ok(Ended {
            job: self.job,
            start: self.start,
            written,
        })
    }
}

/// A job that is done.
pub(crate) struct Ended<'a> {
    job: &'a Job,
    start: Instant,
    written: Option<Written>,
}

impl Ended<'_> {
    /// Adds to its report where the document went and how long all took; what there is to note, a line each.
    pub(crate) fn tell(self, report: &mut FileReport) -> Vec<String> {
        let mut renamed = Vec::new();
        if let Some(written) = self.written {
            report.set_output(&self.job.target, written.bytes);
            report.add_written(&written);
            renamed = write::renamed_lines(self.job, &written);
        }
        report.seconds = Some(self.start.elapsed().as_secs_f64());
        let mut notes = output::note_lines(&report.file, &report.notes);
        notes.append(&mut renamed);
        notes
    }
}

/// Lines, each after a break, for where a document went and what was copied; where it was not changed, `nothing` says so, and
/// `stays` that it is where it was.
pub(crate) fn where_it_went(
    report: &FileReport,
    is_changed: bool,
    [nothing, stays]: [&str; 2],
) -> String {
    let mut text = match (is_changed, &report.output) {
        (true, Some(output)) => format!("\n  written to {}", output.display()),
        (false, Some(output)) => format!("\n  {nothing}: copied to {}", output.display()),
        (true, None) => "\n  not written: dry run".to_owned(),
        (false, None) => format!("\n  {nothing}: {stays}"),
    };
    if report.copied > 0 {
        let s = if report.copied == 1 { "" } else { "s" };
        text += &format!("\n  copied {} file{s} that it names", report.copied);
    }
    text
}
