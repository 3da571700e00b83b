//! `cull stats`: what culling tables leave out.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use meshweft::files::{Document, ReadOptions};
use meshweft::operations::{self, CullStatsOptions, CullStatsReport, CullingFigures, ViewSums};

use super::build::counted;
use crate::columns::columns;
use crate::plot::{self, Axis, Curve};
use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::side_file::{PLOT, PendingFile};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(super) struct Stats {
    /// A file that cull build wrote
    #[arg(value_name = "FILE")]
    input: PathBuf,
    /// How many directions at each distance
    #[arg(long, value_name = "N", default_value_t = CullStatsOptions::default().eyes)]
    eyes: usize,
    /// Plot the share of faces drawn, of back faces left out, and misses per face, over the distance of the eye
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<PathBuf>,
    /// Let --plot replace a file that another program wrote
    #[arg(long, requires = "plot")]
    force: bool,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    report: Report,
}

/// Distances of a plot, evenly on its scale: 1.05 to 100 radii.
const PLOTTED: usize = 24;

/// More directions at a distance are not looked from.
const MOST_EYES: usize = 100_000;

/// Prints what the tables of a file leave out; fails if one cannot be used or leaves out anything that is seen.
pub(super) fn run(arguments: &Stats) -> Result<()> {
    if !(1..=MOST_EYES).contains(&arguments.eyes) {
        let told = format!("--eyes {}: give 1 to {MOST_EYES}", arguments.eyes);
        return Err(Usage(told).into());
    }
    if let Some(path) = &arguments.plot {
        PLOT.check_no_mesh(path, [arguments.input.as_path()])?;
        PLOT.check(path, arguments.force)?;
    }
    let mut reading = ReadOptions::default();
    reading.limits = arguments.size.limits();
    let document = Document::open(&arguments.input, reading)?;
    let mut options = CullStatsOptions::default();
    options.eyes = arguments.eyes;
    let report = operations::cull_stats(&document, &options)?;

    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    let wrong = output::note_lines(&report.file, &report.wrong);
    let mut notes = output::note_lines(&report.file, &report.notes);
    notes.extend(wrong.iter().skip(1).cloned());
    arguments.report.notes(&notes)?;
    if let Some(path) = &arguments.plot {
        options.distances = plotted_distances();
        let report = operations::cull_stats(&document, &options)?;
        let written = PendingFile::new(path, svg(&report)).and_then(PendingFile::commit);
        written.with_context(|| path.display().to_string())?;
    }
    match wrong.first() {
        None => Ok(()),
        Some(first) => bail!("{first}. Build tables from the source of the file"),
    }
}

/// The figures of all meshes for each distance, and a line for each of several meshes.
fn text(report: &CullStatsReport) -> String {
    let file = report.file.display();
    if report.meshes.is_empty() && !report.wrong.is_empty() {
        return format!("{file}: no culling table can be used");
    }
    if report.meshes.is_empty() {
        return format!("{file}: no mesh has a culling table (make one with cull build)");
    }
    let total = &report.total;
    let mut text = format!(
        "{file}: {} with {} faces in {} clusters, {} without a table\n",
        counted(report.meshes.len(), "mesh", "meshes"),
        total.faces,
        total.clusters,
        report.without,
    );
    let head = [
        "distance",
        "drawn",
        "back faces not drawn",
        "draws",
        "misses per face",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (number, &distance) in report.options.distances.iter().enumerate() {
        let name = match distance.is_finite() {
            true => format!("{distance} r"),
            false => "orthographic".to_owned(),
        };
        rows.push([vec![name], row(total, number)].concat());
    }
    let whole = format!("{:.4}", total.whole_misses_per_face());
    rows.push(
        ["whole mesh", "100.0 %", "0.0 %", "", &whole]
            .map(str::to_owned)
            .to_vec(),
    );
    text += &columns(&rows);
    if report.meshes.len() > 1 {
        for mesh in &report.meshes {
            text += &format!(
                "\n{}: {} faces in {} clusters",
                mesh.name, mesh.faces, mesh.clusters
            );
        }
    }
    text
}

/// What was counted at one distance.
fn row(figures: &CullingFigures, distance: usize) -> Vec<String> {
    let view = &figures.views[distance];
    vec![
        format!("{:.1} %", 100.0 * view.drawn_share()),
        format!("{:.1} %", 100.0 * view.back_rejected_share()),
        format!("{:.1}", figures.draws(distance)),
        format!("{:.4}", view.misses_per_face()),
    ]
}

/// 1.05 to 100 radii.
fn plotted_distances() -> Vec<f64> {
    let step = (100.0_f64 / 1.05).powf(1.0 / (PLOTTED - 1) as f64);
    let power = |number: usize| 1.05 * step.powf(number as f64);
    (0..PLOTTED).map(power).collect()
}

/// All meshes together, over the distance.
fn svg(report: &CullStatsReport) -> String {
    let total = &report.total;
    let curve = |name: &str, figure: &dyn Fn(&ViewSums) -> f64| {
        let points = report.options.distances.iter().zip(&total.views);
        let points = points.map(|(&distance, view)| [distance, figure(view)]);
        Curve::new(name.to_owned(), points.collect())
    };
    let whole = total.whole_misses_per_face();
    let curves = [
        curve("faces drawn", &ViewSums::drawn_share),
        curve("back faces not drawn", &ViewSums::back_rejected_share),
        curve("misses per face, fifo:16", &ViewSums::misses_per_face),
        curve("the same, whole mesh", &|_| whole),
    ];
    let axes = [
        Axis::of_decades("distance of the eye in radii", &curves, 0),
        Axis::of_shares("share; misses per face of the mesh", &curves),
    ];
    plot::svg(
        "Shares and Misses per face over the distance",
        &axes,
        &curves,
    )
}
