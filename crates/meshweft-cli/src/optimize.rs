//! `optimize`: the main job.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;
use meshweft::CacheModel;
use meshweft::files::Document;
use meshweft::operations::{self, OptimizeReport, Options};

use crate::run::arguments::{Reading, Run};
use crate::run::ending::{Ending, where_it_went};
use crate::run::jobs::{Job, Jobs};
use crate::run::ordering::Ordering;
use crate::run::output::Report;
use crate::run::side_file::PERMUTATION;
use crate::run::watch::Watch;
use crate::run::{self, Outcome, write};

#[derive(Debug, Args)]
pub(crate) struct Optimize {
    /// Files, folders with files, or patterns such as 'assets/**/*.glb'
    ///
    /// .gltf, .glb, .vrm, .obj, .ply, .off, .stl, .wrl or .vrml, optionally followed by .gz. A folder
    /// stands for every such file in it and in the folders below it. What a file is, its first bytes
    /// decide where they are sure; one that is named alone may be called anything.
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    run: Run,
    #[command(flatten)]
    ordering: Ordering,
    /// Write what was moved as JSON
    ///
    /// Read it as `out[i] = in[new_to_old[i]]`, for faces and vertices; new corner j of a face is
    /// its old corner (j + rotation) % 3.
    #[arg(long, value_name = "FILE")]
    write_permutation: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    report: Report,
}

/// Optimises each file.
pub(crate) fn run(arguments: &Optimize) -> Result<()> {
    // What cannot be done is reported before a file is touched.
    let options = arguments.ordering.options()?;
    let jobs = Jobs::new(&arguments.inputs, &arguments.run)?;
    if let Some(path) = &arguments.write_permutation {
        write::check_side_file(&PERMUTATION, path, &jobs, &arguments.run)?;
    }
    let shows_bar = jobs.list.len() == 1 && arguments.report.shows_progress();
    let work = |job: &Job| optimize(job, &jobs, &options, shows_bar, arguments);
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
    jobs: &Jobs,
    options: &Options,
    shows_bar: bool,
    arguments: &Optimize,
) -> Result<Outcome> {
    let start = Instant::now();
    let mut document = Document::open(&job.input, arguments.reading.options(&jobs.shared_buffers))?;

    let watch = Watch::new(arguments.ordering.time(), shows_bar);
    let mut report = operations::optimize(&mut document, options, &watch)?;
    watch.finish();

    let permutation = || report.permutations_to_json();
    let beside = arguments.write_permutation.as_deref();
    let beside = beside.map(|path| (&PERMUTATION, path, &permutation as &dyn Fn() -> String));
    let ending = Ending {
        job,
        jobs,
        run: &arguments.run,
        start,
        beside,
    };
    let ended = ending.write(&document, report.is_changed())?;
    let notes = ended.tell(&mut report.of_file);
    Ok(Outcome {
        json: report.to_json(),
        total: report.total_to_json(),
        text: text(&report),
        notes,
    })
}

/// A line for the file, one for its caches, one for GPUs, one for whether and where it was written.
fn text(report: &OptimizeReport) -> String {
    let (before, after) = (&report.total.before, &report.total.after);
    let mut text = format!(
        "{}\n  {} faces, {} vertices",
        report.of_file.file.display(),
        before.faces,
        before.vertices,
    );

    // Caches: those that were ordered for.
    let target = report.options.target;
    let ordered_for = |model: &CacheModel| target.models().contains(model);
    let caches = before.acmr().zip(after.acmr());
    let caches = caches.filter(|((model, _), _)| !model.is_gpu() && ordered_for(model));
    let caches = caches.map(|((model, a), (_, b))| format!("{model} {a:.4} -> {b:.4}"));
    let caches: Vec<_> = caches.collect();
    if !caches.is_empty() {
        text += &format!("\n  misses per face: {}", caches.join(", "));
    }

    // GPUs: all.
    let gpus = before.atvr().zip(after.atvr());
    let gpus = gpus.filter(|((model, _), _)| model.is_gpu());
    let gpus = gpus.map(|((model, a), (_, b))| format!("{model} {a:.3} -> {b:.3}"));
    let gpus: Vec<_> = gpus.collect();
    text += &format!("\n  transforms per vertex: {}", gpus.join(", "));

    if let (Some(before), Some(after)) = (before.card, after.card) {
        text += &format!(
            "\n  nvidia: warps {:.3} -> {:.3} of the fewest, setup cycles {:.3} -> {:.3} of the fewest",
            before.warps_over_floor(),
            after.warps_over_floor(),
            before.setup_cycles_over_floor(),
            after.setup_cycles_over_floor(),
        );
    }

    if let Some(scheduled) = report.scheduled() {
        let per_face = scheduled as f64 / after.faces.max(1) as f64;
        text += &format!("\n  scheduled pushes per face: {per_face:.4}");
    }

    let worse_in: Vec<String> = report.worse_in().map(|model| model.to_string()).collect();
    if !worse_in.is_empty() {
        text += &format!("\n  misses more in: {}", worse_in.join(", "));
    }

    let unchanged = ["nothing to improve", "left as it is"];
    text + &where_it_went(&report.of_file, report.is_changed(), unchanged)
}
