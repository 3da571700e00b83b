//! `terrain verify`: how far a terrain is really off.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use meshweft::operations::{
    self, PixelErrors, TerrainHeights, TerrainPath, TerrainSource, TerrainVerifyOptions,
    TerrainVerifyReport,
};

use super::heights::{self, Heights};
use crate::columns::columns;
use crate::run::arguments::Size;
use crate::run::output::Report;
use crate::run::watch::Watch;
use crate::usage::Usage;
use crate::walks::cameras;

#[derive(Debug, Args)]
pub(super) struct Verify {
    /// A .mwt file that terrain build wrote, or a height map, or points of a mesh file
    #[arg(value_name = "FILE")]
    input: PathBuf,
    /// The height maps or points to compare with: those that the file was built of. Without them, the terrain is compared with its own heights
    #[arg(value_name = "SOURCE")]
    sources: Vec<PathBuf>,
    /// Measure the surface of this error, in metres, instead of frames
    #[arg(long, allow_negative_numbers = true, value_name = "M", conflicts_with_all = ["path", "frames", "tolerance", "size"])]
    error: Option<f64>,
    /// Where the eye goes: a path of terrain walk
    #[arg(long, value_name = "PATH", default_value = "circle")]
    path: String,
    /// How many frames, evenly on the path [default: 40, or all of a file of cameras if they are fewer]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// How many pixels the surface may be off
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", default_value_t = TerrainVerifyOptions::default().tolerance)]
    tolerance: f64,
    /// The picture, in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = cameras::picture_size)]
    size: [u32; 2],
    #[command(flatten)]
    heights: Heights,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints how far a terrain is off.
pub(super) fn run(arguments: &Verify) -> Result<()> {
    let mut options = TerrainVerifyOptions::default();
    options.error = arguments.error;
    options.frames = arguments.frames;
    options.tolerance = arguments.tolerance;
    options.size = arguments.size;

    // All that can be wrong without the terrain.
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;
    let limits = arguments.limits.limits();
    let shapes = TerrainPath::SHAPES.map(|it| (it.name(), it));
    (options.path, options.camera_file) = cameras::path(
        &arguments.path,
        shapes,
        TerrainPath::Given,
        options.size,
        limits,
    )?;

    let reading = arguments.heights.options(&arguments.limits);
    let source = TerrainSource::open(std::slice::from_ref(&arguments.input), &reading)?;
    let compared = match arguments.sources.is_empty() {
        true => None,
        false => Some(TerrainHeights::open(&arguments.sources, &reading)?),
    };
    let watch = Watch::new(None, arguments.report.shows_progress());
    let report = operations::terrain_verify(source, compared, &options, &watch)?;
    watch.finish();

    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    arguments
        .report
        .notes(&heights::note_lines(&report.notes))?;
    let failures = report.failures();
    if !failures.is_empty() {
        bail!("{}: {}", report.file.display(), failures.join("; "));
    }
    Ok(())
}

/// What was looked at, and a line for each surface and for all.
fn text(report: &TerrainVerifyReport) -> String {
    let options = &report.options;
    let [width, height] = options.size;
    let looked_at = match options.error {
        Some(length) => {
            format!("the surface of an error of {length} m, all heights; errors in parts of that")
        }
        None => format!(
            "{}, frames {} of {width} x {height}, tolerance {} px, all heights in the picture; errors in tolerances",
            cameras::told(options.path.name(), options.camera_file.as_deref()),
            report.surfaces.len(),
            options.tolerance,
        ),
    };
    let head = [
        "frame",
        "faces",
        "heights",
        "within, %",
        "99.9 % below",
        "worst",
        "worst, m",
        "uncovered",
        "cracks",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut add = |name: String, counts: [usize; 3], errors: &PixelErrors, metres: f64| {
        let [faces, uncovered, cracks] = counts;
        let row = [
            name,
            faces.to_string(),
            errors.seen.to_string(),
            format!("{:.4}", errors.share()),
            format!("{:.3}", errors.p999),
            format!("{:.3}", errors.worst),
            format!("{metres:.3}"),
            uncovered.to_string(),
            cracks.to_string(),
        ];
        rows.push(row.to_vec());
    };
    let mut sums = [0; 3];
    for surface in &report.surfaces {
        let uncovered = surface.uncovered + surface.covered_voids + surface.overlaps;
        let cracks = surface.cracks + surface.turned;
        let counts = [surface.faces, uncovered, cracks];
        sums = [0, 1, 2].map(|i| sums[i] + counts[i]);
        let number = surface.number.to_string();
        add(number, counts, &surface.errors, surface.worst_metres);
    }
    add(
        "all".to_owned(),
        sums,
        &report.errors,
        report.worst_metres(),
    );
    format!(
        "{}: {}\n{}\n{looked_at}\n{}",
        report.file.display(),
        heights::told(&report.terrain),
        compared(report),
        columns(&rows)
    )
}

/// What it was compared with.
fn compared(report: &TerrainVerifyReport) -> String {
    let count = report.heights;
    if !report.is_own {
        let files = report.compared.iter().map(|it| it.display().to_string());
        let files: Vec<String> = files.collect();
        return format!("compared with {count} heights of {}", files.join(", "));
    }
    match report.terrain.grid_size {
        Some(_) => format!("compared with its own {count} heights: no others were given"),
        None => {
            format!("compared with its own {count} vertices that are points: no others were given")
        }
    }
}
