//! A run over many files: what the verbs that write files have in common.
//!
//! Such a verb has the flags [`Run`] and [`Reading`](arguments::Reading), finds its files with
//! [`Jobs::new`](jobs::Jobs::new), hands the work on one of them to [`over_files`], and ends it with
//! [`Ending`](ending::Ending).

pub(crate) mod arguments;
mod batch;
pub(crate) mod ending;
pub(crate) mod error_limit;
pub(crate) mod inputs;
mod interrupt;
pub(crate) mod jobs;
mod manifest;
pub(crate) mod ordering;
pub(crate) mod output;
pub(crate) mod side_file;
pub(crate) mod watch;
mod workers;
pub(crate) mod write;

use std::collections::BTreeSet;

use anyhow::{Error, Result};
use meshweft::files::remove_abandoned;
use serde_json::{Value, json};

use crate::usage;
use arguments::Run;
use jobs::Job;
use manifest::Manifest;
use output::Report;
use side_file::MANIFEST;
use workers::Workers;

/// What there is to say about a file.
pub(crate) struct Outcome {
    /// Its report, one line of JSON.
    pub(crate) json: String,
    /// Its report for people, without a line break at the end.
    pub(crate) text: String,
    /// What its reader left as it is, a line each.
    pub(crate) notes: Vec<String>,
    /// The sums of the report, as JSON: what the manifest keeps of it.
    pub(crate) total: String,
}

/// Does `work` on the file of each job, several at once, each in a thread pool of its own, and reports
/// it under `verb` in the order of the jobs.
///
/// # Errors
/// The first failure, in that order. Later ones are printed.
pub(crate) fn over_files(
    verb: &str,
    jobs: &[Job],
    run: &Run,
    report: &Report,
    work: impl Fn(&Job) -> Result<Outcome> + Sync,
) -> Result<()> {
    let manifest = open_manifest(jobs, run)?;
    let workers = Workers::new(run, jobs.len())?;
    if !run.dry_run {
        prepare_to_write(jobs);
    }

    // On a worker's thread: one job, and its line in the manifest.
    let do_job = |index: usize| {
        let job = &jobs[index];
        let listed = manifest.as_ref();
        if listed.is_some_and(|manifest| manifest.has(&job.input, &job.target)) {
            return Ok(done_before(verb, job));
        }

        let done = workers.pool()?.install(|| work(job));
        if let Some(manifest) = &manifest {
            list_in(manifest, job, &done)?;
        }
        done
    };

    // On this thread: what there is to say about it.
    let bar = output::progress(jobs.len(), report);
    let mut is_first_failure = true;
    let tell = |index: usize, result: Result<&Outcome, &Error>| {
        bar.inc(1);
        // Hidden while lines are printed, or they would be drawn over.
        bar.suspend(|| match result {
            Ok(outcome) => {
                report.json_line(&outcome.json)?;
                report.text(&outcome.text)?;
                Ok(report.notes(&outcome.notes)?)
            }
            Err(error) => {
                let file = jobs[index].input.display().to_string();
                let text = usage::message(error);
                report.json(verb, &json!({"file": file, "error": text}))?;
                // The caller prints the first one, as the error of the whole run.
                if !std::mem::take(&mut is_first_failure) {
                    eprintln!("error: {text}");
                }
                Ok(())
            }
        })
    };

    let done = batch::run(jobs.len(), workers.jobs, run.keep_going, do_job, tell);
    bar.finish_and_clear();
    done
}

/// The list of what is done, if the run has one and it is not a mesh, or any other file.
fn open_manifest(jobs: &[Job], run: &Run) -> Result<Option<Manifest>> {
    let Some(path) = run.manifest.as_deref() else {
        return Ok(None);
    };
    MANIFEST.check_no_mesh(path, jobs::names_of(jobs))?;
    // It is appended to, so nothing can allow another file.
    MANIFEST.check(path, false)?;
    Ok(Some(Manifest::open(path, run.dry_run)?))
}

/// Lets no signal cut a file short, and removes the temporary files of runs that were killed.
fn prepare_to_write(jobs: &[Job]) {
    interrupt::watch();
    let folders: BTreeSet<_> = jobs.iter().filter_map(|job| job.target.parent()).collect();
    for folder in folders {
        remove_abandoned(folder);
    }
}

/// What there is to say about a file that an earlier run did.
fn done_before(verb: &str, job: &Job) -> Outcome {
    let [file, output] = [&job.input, &job.target].map(|path| path.display().to_string());
    Outcome {
        text: format!("{file}\n  done before: {output}"),
        json: output::headed(
            verb,
            &json!({"file": file, "output": output, "done_before": true}),
        ),
        total: Value::Null.to_string(),
        notes: Vec::new(),
    }
}

/// Adds a job that is done, or has failed, to the manifest.
fn list_in(manifest: &Manifest, job: &Job, done: &Result<Outcome>) -> Result<()> {
    let _no_interrupt = interrupt::hold_off();
    let total = done.as_ref().map(|outcome| outcome.total.as_str());
    manifest.add(&job.input, &job.target, total.map_err(usage::message))
}
