//! `optimize`: the main job.

mod algorithm;
mod arguments;
mod improve;
mod outcome;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use meshweft::CacheModel;
use meshweft::files::Document;
use meshweft::order::Target;

use crate::caches::USUAL;
use crate::count::Counts;
use crate::run::jobs::{Job, Jobs};
use crate::run::{self, Outcome, write};
use crate::usage::Usage;
use algorithm::Algorithm;
pub(crate) use arguments::Optimize;
use outcome::Optimized;

/// Optimises each file.
pub(crate) fn run(arguments: &Optimize) -> Result<()> {
    let algorithm = Algorithm::of(arguments)?;
    let jobs = Jobs::new(&arguments.inputs, &arguments.run)?;
    if arguments.write_permutation.is_some() && !jobs.is_one_file {
        return Err(Usage("--write-permutation takes one file at a time".into()).into());
    }
    let work = |job: &Job| optimize(job, &jobs.shared_buffers, &algorithm, arguments);
    run::over_files(
        "optimize",
        &jobs.list,
        &arguments.run,
        &arguments.report,
        work,
    )
}

/// Orders the meshes of a file, and writes it.
fn optimize(
    job: &Job,
    shared_buffers: &[PathBuf],
    algorithm: &Algorithm,
    arguments: &Optimize,
) -> Result<Outcome> {
    let mut document = Document::open(&job.input, arguments.reading.options(shared_buffers))?;
    let models = models(arguments.cache);
    let before = counts(&document, &models);
    let improvement = improve::improve(document.meshes(), algorithm, arguments);
    improvement.apply(&mut document)?;
    let after = counts(&document, &models);

    let is_written = arguments.run.writes(improvement.changes());
    if is_written {
        write::write(job, &document, improvement.changes())?;
    }
    if let Some(file) = &arguments.write_permutation {
        let text = improvement.permutation_json(&document).to_string();
        fs::write(file, text).with_context(|| file.display().to_string())?;
    }

    let optimized = Optimized {
        document: &document,
        improvement: &improvement,
        target: &job.target,
        is_written,
        total: [&before, &after].map(|c| Counts::total(document.meshes(), c, &models)),
        meshes: [&before, &after],
    };
    Ok(optimized.outcome(arguments))
}

/// The caches that were ordered for, and the usual ones.
fn models(target: Target) -> Vec<CacheModel> {
    let mut models = target.models().to_vec();
    let others = USUAL
        .iter()
        .filter(|model| !target.models().contains(model));
    models.extend(others);
    models
}

fn counts(document: &Document, models: &[CacheModel]) -> Vec<Counts> {
    let meshes = document.meshes().iter();
    meshes
        .map(|entry| Counts::of(&entry.mesh, models))
        .collect()
}
