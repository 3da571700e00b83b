//! `optimize`: the main job.

mod algorithm;
mod batch;
mod improve;
mod interrupt;
mod jobs;
mod manifest;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use meshweft::CacheModel;
use meshweft::files::{Document, Format, ReadOptions, remove_abandoned};
use meshweft::order::Target;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde_json::{Value, json};

use crate::args::{self, Optimize, Usage};
use crate::count::{Counts, by_model, ratio};
use crate::output;
use algorithm::Algorithm;
use improve::Improvement;
use jobs::Job;
use manifest::Manifest;

/// What there is to say about a file.
struct Outcome {
    json: Value,
    text: String,
    notes: Vec<String>,
    /// Done by an earlier run.
    was_done: bool,
}

/// Optimises each file.
pub(crate) fn run(arguments: &Optimize) -> Result<()> {
    let algorithm = Algorithm::of(arguments)?;
    if arguments.output.is_none() && !arguments.in_place && !arguments.dry_run {
        let text = "where to? Give -o OUT, --in-place, or --dry-run";
        return Err(Usage(text.into()).into());
    }
    let jobs = jobs::jobs(arguments)?;
    let manifest = arguments.manifest.as_deref().map(Manifest::open);
    let manifest = manifest.transpose()?;
    let shared = jobs::shared_buffers(&jobs);
    let workers = Workers::new(arguments, jobs.len());
    if !arguments.dry_run {
        interrupt::watch();
        for folder in jobs
            .iter()
            .filter_map(|job| job.target.parent())
            .collect::<BTreeSet<_>>()
        {
            remove_abandoned(folder);
        }
    }
    let bar = output::progress(jobs.len(), &arguments.report);
    let work = |index: usize| {
        let job: &Job = &jobs[index];
        if manifest
            .as_ref()
            .is_some_and(|m| m.has(&job.input, &job.target))
        {
            return Ok(Outcome::of_earlier_run(job));
        }
        let done = optimize(job, &shared, &algorithm, &workers.threads()?, arguments);
        if let (Some(manifest), false) = (&manifest, arguments.dry_run) {
            let _whole = interrupt::hold_off();
            let total = done.as_ref().map(|outcome| outcome.json["total"].clone());
            let total = total.map_err(|error| format!("{error:#}"));
            manifest.add(&job.input, &job.target, &total)?;
        }
        done
    };
    let mut is_first_failure = true;
    let done = batch::run(
        jobs.len(),
        workers.jobs,
        arguments.keep_going,
        work,
        |index, result| {
            bar.inc(1);
            bar.suspend(|| match result {
                Ok(outcome) => outcome.print(arguments),
                Err(error) => {
                    let file = jobs[index].input.display().to_string();
                    let text = format!("{error:#}");
                    arguments.report.json(&json!({
                        "schema": 1, "command": "optimize", "file": file, "error": text,
                    }))?;
                    // The first is reported as the error of the whole run.
                    if !std::mem::take(&mut is_first_failure) {
                        eprintln!("error: {text}");
                    }
                    Ok(())
                }
            })
        },
    );
    bar.finish_and_clear();
    done
}

/// How many threads do what.
struct Workers {
    jobs: usize,
    /// For each file.
    threads: usize,
}

impl Workers {
    fn new(arguments: &Optimize, files: usize) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let jobs = arguments.jobs.map_or(cores, usize::from).min(files.max(1));
        let threads = arguments.threads.map_or(cores.div_ceil(jobs), usize::from);
        Self { jobs, threads }
    }

    /// The threads for a file.
    fn threads(&self) -> Result<ThreadPool> {
        let threads = ThreadPoolBuilder::new().num_threads(self.threads).build();
        threads.context("no threads to work with")
    }
}

fn optimize(
    job: &Job,
    shared: &[PathBuf],
    algorithm: &Algorithm,
    threads: &ThreadPool,
    arguments: &Optimize,
) -> Result<Outcome> {
    let Job { input, target } = job;
    let mut options = ReadOptions::default();
    options.strict = arguments.strict;
    options
        .assume_order_safe
        .clone_from(&arguments.assume_order_safe);
    options.across_groups = arguments.across_groups;
    options.keep_buffers = shared.to_vec();
    let mut document = Document::open(input, options)?;
    let models = models(arguments.cache);
    let before = counts(&document, &models);
    let meshes = document.meshes();
    let improvement = threads.install(|| improve::improve(meshes, algorithm, arguments));
    improvement.apply(&mut document)?;
    let after = counts(&document, &models);

    let writes = !arguments.dry_run && (improvement.changes() || !arguments.in_place);
    if writes {
        let _whole = interrupt::hold_off();
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        }
        match improvement.changes() {
            true => drop(document.write(target)?),
            false => write_unchanged(&document, input, target)?,
        }
    }
    if let Some(file) = &arguments.write_permutation {
        let text = improvement.permutation_json(&document).to_string();
        fs::write(file, text).with_context(|| file.display().to_string())?;
    }
    Ok(outcome(
        &document,
        target,
        writes,
        arguments,
        &improvement,
        [&before, &after],
    ))
}

impl Outcome {
    fn of_earlier_run(job: &Job) -> Self {
        let [file, output] = [&job.input, &job.target].map(|path| path.display().to_string());
        Self {
            text: format!("{file}\n  done before: {output}"),
            json: json!({
                "schema": 1, "command": "optimize", "file": file, "output": output,
                "done_before": true,
            }),
            notes: Vec::new(),
            was_done: true,
        }
    }

    fn print(&self, arguments: &Optimize) -> Result<()> {
        arguments.report.json(&self.json)?;
        if !self.was_done || !arguments.report.quiet {
            arguments.report.text(&self.text)?;
        }
        Ok(arguments.report.notes(&self.notes)?)
    }
}

/// Writes a file in which nothing was moved; a compressed one as it was, not compressed anew.
fn write_unchanged(document: &Document, path: &Path, target: &Path) -> Result<()> {
    let is_gzip = |path: &Path| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
    };
    let is_one_file = document.format() != Format::Gltf;
    let same_format = Format::of_path(target) == Some(document.format());
    if is_gzip(path) && is_gzip(target) && is_one_file && same_format {
        fs::copy(path, target).with_context(|| target.display().to_string())?;
        return Ok(());
    }
    document.write(target)?;
    Ok(())
}

/// The caches that were ordered for, and the usual ones.
fn models(target: Target) -> Vec<CacheModel> {
    let mut models = target.models().to_vec();
    let usual = args::Caches { models: Vec::new() }.models();
    models.extend(
        usual
            .into_iter()
            .filter(|model| !target.models().contains(model)),
    );
    models
}

fn counts(document: &Document, models: &[CacheModel]) -> Vec<Counts> {
    let meshes = document.meshes().iter();
    meshes
        .map(|entry| Counts::of(&entry.mesh, models))
        .collect()
}

fn outcome(
    document: &Document,
    target: &Path,
    written: bool,
    arguments: &Optimize,
    improvement: &Improvement,
    [before, after]: [&[Counts]; 2],
) -> Outcome {
    let models = models(arguments.cache);
    let total = [before, after].map(|c| Counts::total(document.meshes(), c, &models));
    let meshes: Vec<Value> = document
        .meshes()
        .iter()
        .enumerate()
        .map(|(i, entry)| {
            let mut object = change(&before[i], &after[i]);
            object.insert("changed".into(), json!(improvement.moved_faces(i)));
            object.insert(
                "vertices_moved".into(),
                json!(improvement.moved_vertices(entry)),
            );
            if let Some(reason) = improvement.reason(i) {
                object.insert("reason".into(), json!(reason));
            }
            if let Some(pushes) = improvement.scheduled(i) {
                let per_face = ratio(pushes as f64, entry.mesh.face_count());
                object.insert("scheduled".into(), json!(per_face));
            }
            object.shift_insert(0, "name".into(), json!(entry.name));
            Value::Object(object)
        })
        .collect();
    let shown = |path: &Path| path.display().to_string();
    let json = json!({
        "schema": 1,
        "command": "optimize",
        "file": shown(document.path()),
        "output": written.then(|| shown(target)),
        "cache": arguments.cache.to_string(),
        "effort": arguments.effort.to_string(),
        "mode": match arguments.mode { args::Mode::Fast => "fast", args::Mode::Faithful => "faithful" },
        "meshes": meshes,
        "total": change(&total[0], &total[1]),
        "notes": output::notes_json(document),
    });
    let ordered_for = |model: &CacheModel| {
        !matches!(model, CacheModel::Batch(_)) && arguments.cache.models().contains(model)
    };
    let caches = total[0].acmr().zip(total[1].acmr());
    let caches = caches.filter(|((model, _), _)| ordered_for(model));
    let caches = caches.map(|((model, a), (_, b))| format!("{model} {a:.4} -> {b:.4}"));
    let caches: Vec<_> = caches.collect();
    let mut text = format!(
        "{}\n  {} faces, {} vertices",
        shown(document.path()),
        total[0].faces,
        total[0].vertices,
    );
    if !caches.is_empty() {
        text += &format!("\n  misses per face: {}", caches.join(", "));
    }
    let gpus = total[0].atvr().zip(total[1].atvr());
    let gpus = gpus.filter(|((model, _), _)| matches!(model, CacheModel::Batch(_)));
    let gpus = gpus.map(|((model, a), (_, b))| format!("{model} {a:.3} -> {b:.3}"));
    let gpus: Vec<_> = gpus.collect();
    text += &format!("\n  transforms per vertex: {}", gpus.join(", "));
    if let Some(scheduled) = improvement.scheduled_total() {
        let per_face = ratio(scheduled as f64, total[1].faces);
        text += &format!("\n  scheduled pushes per face: {per_face:.4}");
    }
    text += &match (improvement.changes(), written) {
        (true, true) => format!("\n  written to {}", shown(target)),
        (false, true) => format!("\n  nothing to improve: copied to {}", shown(target)),
        (true, false) => "\n  not written: dry run".to_owned(),
        (false, false) => "\n  nothing to improve: left as it is".to_owned(),
    };
    Outcome {
        json,
        text,
        notes: output::note_lines(document),
        was_done: false,
    }
}

fn change(before: &Counts, after: &Counts) -> serde_json::Map<String, Value> {
    let mut object = after.json();
    let both = |a, b| json!({"before": a, "after": b});
    object.insert(
        "acmr".into(),
        both(by_model(before.acmr()), by_model(after.acmr())),
    );
    object.insert(
        "atvr".into(),
        both(by_model(before.atvr()), by_model(after.atvr())),
    );
    for key in ["misses", "overfetch"] {
        let [a, b] = [before, after].map(|c| c.json().remove(key).unwrap_or_default());
        object.insert(key.into(), both(a, b));
    }
    object
}
