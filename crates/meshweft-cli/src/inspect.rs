//! `inspect`: counts, without writing anything.

use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result};
use clap::Args;
use meshweft::cache::nvidia::DrawCounts;
use meshweft::files::Document;
use meshweft::operations::{self, Counts, InspectReport, Method};
use meshweft::{CacheModel, Mesh};

use crate::caches::Caches;
use crate::columns::columns;
use crate::plot::{self, Axis, Curve};
use crate::run::arguments::Size;
use crate::run::inputs;
use crate::run::output::{self, Report};
use crate::run::side_file::{PLOT, PendingFile};
use crate::usage;

#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Files, folders with files, or patterns
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    /// Draw misses per face over the size of a FIFO cache: one curve a file
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<PathBuf>,
    /// Let --plot replace a file that another program wrote
    #[arg(long, requires = "plot")]
    force: bool,
    /// Also draw a curve for each file as ordered by every method
    #[arg(long, requires = "plot")]
    methods: bool,
    #[command(flatten)]
    caches: Caches,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints the counts of each file.
pub(crate) fn run(arguments: &Inspect) -> Result<()> {
    let models = arguments.caches.models();
    let inputs = inputs::expand(&arguments.inputs, None)?;
    if let Some(path) = &arguments.plot {
        PLOT.check_no_mesh(path, inputs.iter().map(|input| input.path.as_path()))?;
        PLOT.check(path, arguments.force)?;
    }
    let mut failed: Option<Error> = None;
    let mut curves = Vec::new();
    for input in inputs {
        match inspect(&input.path, &models, arguments) {
            Ok(more) => curves.extend(more),
            Err(error) => {
                if let Some(earlier) = failed.replace(error) {
                    eprintln!("error: {}", usage::message(&earlier));
                }
            }
        }
    }
    if let Some(path) = &arguments.plot {
        write_plot(path, &curves)?;
    }
    failed.map_or(Ok(()), Err)
}

fn write_plot(path: &Path, curves: &[Curve]) -> Result<()> {
    let axes = [Axis::of_cache_sizes(), Axis::of_misses(curves)];
    let svg = plot::svg("Misses per face over the cache size", &axes, curves);
    let written = PendingFile::new(path, svg).and_then(PendingFile::commit);
    written.with_context(|| path.display().to_string())
}

/// A file's curve, and those of its orders by each method if they are asked for.
fn curves(document: &Document, with_methods: bool) -> Vec<Curve> {
    let file = document.path().file_name().unwrap_or_default();
    let file = file.to_string_lossy().into_owned();
    let full = || document.meshes().iter().filter(|it| it.level.is_none());
    let meshes = || full().map(|entry| &entry.mesh);
    let mut curves = vec![Curve::of_cache_sizes(
        file.clone(),
        meshes().map(Mesh::faces),
    )];
    if with_methods {
        for method in Method::SHOWN {
            let orders: Vec<_> = meshes()
                .map(|mesh| method.order(mesh).apply(mesh.faces()))
                .collect();
            let name = format!("{file}, {method}");
            curves.push(Curve::of_cache_sizes(
                name,
                orders.iter().map(Vec::as_slice),
            ));
        }
    }
    curves
}

fn inspect(path: &Path, models: &[CacheModel], arguments: &Inspect) -> Result<Vec<Curve>> {
    let document = Document::open(path, arguments.size.limits())?;
    let report = operations::inspect(&document, models);
    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    let notes = output::note_lines(&report.file, &report.notes);
    arguments.report.notes(&notes)?;
    Ok(match arguments.plot {
        Some(_) => curves(&document, arguments.methods),
        None => Vec::new(),
    })
}

fn text(report: &InspectReport) -> String {
    let total = &report.total;
    let mut rows = vec![vec![
        "mesh".to_owned(),
        "faces".into(),
        "vertices".into(),
        "used".into(),
    ]];
    for (model, _) in &total.misses {
        rows[0].push(format!("ACMR {model}"));
        rows[0].push("ATVR".into());
    }

    let row = |name: &str, counts: &Counts| {
        let sizes = [counts.faces, counts.vertices, counts.used_vertices];
        let sizes = sizes.map(|n| n.to_string());
        let ratios = counts.acmr().zip(counts.atvr());
        let ratios = ratios.flat_map(|(a, b)| [a.1, b.1].map(|x| format!("{x:.3}")));
        let name = [name.to_owned()].into_iter();
        name.chain(sizes).chain(ratios).collect::<Vec<_>>()
    };
    for mesh in &report.meshes {
        rows.push(row(&mesh.name, &mesh.counts));
        for level in &mesh.levels {
            let error = level.error.map(|error| format!(", error {error}"));
            let name = format!("  level {}{}", level.number, error.unwrap_or_default());
            rows.push(row(&name, &level.counts));
        }
    }
    if report.meshes.len() != 1 {
        rows.push(row("total", total));
    }
    let mut text = format!("{}\n{}", report.file.display(), columns(&rows));
    if let Some(card) = &total.card {
        text += &format!("\n{}", card_line(card));
    }
    text
}

/// What an NVIDIA card counts, each figure with the least that it can be.
fn card_line(card: &DrawCounts) -> String {
    format!(
        "nvidia: {} invocations of {} distinct vertices in {} warps ({:.3} of the fewest), {} setup cycles \
         ({:.3} of the fewest)",
        card.invocations,
        card.distinct_vertices,
        card.warps,
        card.warps_over_floor(),
        card.setup_cycles,
        card.setup_cycles_over_floor()
    )
}
