//! `optimize`: the main job.

mod improve;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result};
use meshweft::files::{Document, Format};
use meshweft::order::{KCacheReorder, Mode};
use meshweft::{CacheModel, Limits};
use serde_json::{Value, json};

use crate::args::{self, Optimize, Usage};
use crate::count::{Counts, by_model, ratio};
use improve::Improvement;

/// The largest cache that orders are made for here.
const MAX_SIZE: u32 = 1024;

/// Optimises each file.
pub(crate) fn run(arguments: &Optimize) -> Result<()> {
    check(arguments)?;
    let mut failed: Option<Error> = None;
    for path in &arguments.inputs {
        if let Err(error) = optimize(path, arguments) {
            if !arguments.keep_going {
                return Err(error);
            }
            if let Some(earlier) = failed.replace(error) {
                eprintln!("error: {earlier:#}");
            }
        }
    }
    failed.map_or(Ok(()), Err)
}

/// Refuses what cannot be done before any file is touched.
fn check(arguments: &Optimize) -> Result<(), Usage> {
    let size = arguments.cache.size();
    match arguments.cache {
        CacheModel::Fifo { .. } | CacheModel::Controllable { .. } if size <= MAX_SIZE => {}
        CacheModel::Fifo { .. } | CacheModel::Controllable { .. } => {
            return Err(Usage(format!(
                "--cache {}: orders are made for caches of 3 to {MAX_SIZE} vertices",
                arguments.cache
            )));
        }
        other => {
            return Err(Usage(format!(
                "--cache {other}: orders are made for fifo:K and controllable:K; fifo:10 and \
                 fifo:12 do well on GPUs, and inspect counts for {other}"
            )));
        }
    }
    if arguments.output.is_none() && !arguments.in_place && !arguments.dry_run {
        return Err(Usage(
            "where to? Give -o OUT, --in-place, or --dry-run".into(),
        ));
    }
    if arguments.inputs.len() > 1 {
        let is_folder =
            |out: &PathBuf| out.is_dir() || out.as_os_str().as_encoded_bytes().ends_with(b"/");
        if arguments.output.as_ref().is_some_and(|out| !is_folder(out)) {
            return Err(Usage(
                "several files go into a folder: give -o FOLDER/".into(),
            ));
        }
        if arguments.write_permutation.is_some() {
            return Err(Usage("--write-permutation takes one file at a time".into()));
        }
    }
    Ok(())
}

/// Where the result of `input` goes.
fn target(input: &Path, arguments: &Optimize) -> Result<PathBuf> {
    let Some(output) = &arguments.output else {
        return Ok(input.to_owned());
    };
    let is_folder = output.is_dir() || arguments.inputs.len() > 1;
    let target = match (is_folder, input.file_name()) {
        (true, Some(name)) => {
            fs::create_dir_all(output).with_context(|| output.display().to_string())?;
            output.join(name)
        }
        _ => output.clone(),
    };
    let same = |a: &Path, b: &Path| Some(fs::canonicalize(a).ok()? == fs::canonicalize(b).ok()?);
    if same(&target, input) == Some(true) {
        return Err(Error::new(Usage(format!(
            "{} is the input itself: use --in-place to replace it",
            target.display()
        ))));
    }
    Ok(target)
}

fn optimize(path: &Path, arguments: &Optimize) -> Result<()> {
    let target = target(path, arguments)?;
    let mut document = Document::open(path, Limits::default())?;
    let algorithm = KCacheReorder {
        cache: arguments.cache,
        mode: match arguments.mode {
            args::Mode::Fast => Mode::Fast,
            args::Mode::Faithful => Mode::Faithful,
        },
        k1: arguments.k1,
        k2: arguments.k2,
        k3: arguments.k3,
        keep_corners: arguments.keep_corners,
        first_focus: None,
    };
    let models = models(arguments.cache);
    let before = counts(&document, &models);
    let improvement = improve::improve(document.meshes(), &algorithm, arguments);
    improvement.apply(&mut document)?;
    let after = counts(&document, &models);

    let writes = !arguments.dry_run && (improvement.changes() || !arguments.in_place);
    if writes {
        match improvement.changes() {
            true => document.write(&target)?,
            false => write_unchanged(&document, path, &target)?,
        }
    }
    if let Some(file) = &arguments.write_permutation {
        let text = improvement.permutation_json(&document).to_string();
        fs::write(file, text).with_context(|| file.display().to_string())?;
    }
    report(
        &document,
        &target,
        writes,
        arguments,
        &improvement,
        [&before, &after],
    )
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
    Ok(document.write(target)?)
}

/// The cache that was ordered for, and the usual ones.
fn models(cache: CacheModel) -> Vec<CacheModel> {
    let mut models = vec![cache];
    let usual = args::Caches { models: Vec::new() }.models();
    models.extend(usual.into_iter().filter(|&model| model != cache));
    models
}

fn counts(document: &Document, models: &[CacheModel]) -> Vec<Counts> {
    let meshes = document.meshes().iter();
    meshes
        .map(|entry| Counts::of(&entry.mesh, models))
        .collect()
}

fn report(
    document: &Document,
    target: &Path,
    written: bool,
    arguments: &Optimize,
    improvement: &Improvement,
    [before, after]: [&[Counts]; 2],
) -> Result<()> {
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
    arguments.report.json(&json!({
        "schema": 1,
        "command": "optimize",
        "file": shown(document.path()),
        "output": written.then(|| shown(target)),
        "cache": arguments.cache.to_string(),
        "mode": match arguments.mode { args::Mode::Fast => "fast", args::Mode::Faithful => "faithful" },
        "meshes": meshes,
        "total": change(&total[0], &total[1]),
        "notes": crate::output::notes_json(document),
    }))?;
    let first = |counts: &Counts| counts.acmr().next().map_or(0.0, |(_, acmr)| acmr);
    let mut text = format!(
        "{}\n  {} faces, {} vertices\n  misses per face, {}: {:.4} -> {:.4}",
        shown(document.path()),
        total[0].faces,
        total[0].vertices,
        arguments.cache,
        first(&total[0]),
        first(&total[1]),
    );
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
    arguments.report.text(&text)?;
    Ok(arguments.report.notes(document)?)
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
