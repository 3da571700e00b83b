//! `terrain build`: heights with all levels of detail as a file.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use meshweft::operations::{self, TerrainBuildReport, TerrainHeights};

use super::heights::{self, Heights};
use crate::run::arguments::Size;
use crate::run::output::Report;
use crate::run::side_file::{PendingFile, TERRAIN};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(super) struct Build {
    /// Height maps: .hgt, .dem, .tif, .png or .pgm files, several lie beside each other; or points: mesh files, of which all vertices count, or .ply, .obj and .off files without faces. Each optionally followed by .gz
    #[arg(value_name = "IN", required = true)]
    inputs: Vec<PathBuf>,
    /// Where to write: a .mwt file
    #[arg(
        short,
        long,
        value_name = "OUT.mwt",
        required_unless_present = "dry_run"
    )]
    output: Option<PathBuf>,
    /// Do everything but write
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    heights: Heights,
    /// Replace an output that is not a .mwt file
    #[arg(long, display_order = 99)]
    force: bool,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

/// Builds a file.
pub(super) fn run(arguments: &Build) -> Result<()> {
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let output = arguments.output.as_deref();

    // What cannot be written is reported before a file is read.
    if let Some(output) = output {
        let ending = output.extension();
        if ending.is_none_or(|it| !it.eq_ignore_ascii_case("mwt")) {
            let text = format!("{}: give the output the ending .mwt", output.display());
            return Err(Usage(text).into());
        }
        TERRAIN.check_no_mesh(output, arguments.inputs.iter().map(PathBuf::as_path))?;
        TERRAIN.check(output, arguments.force)?;
    }
    let output = output.filter(|_| !arguments.dry_run);

    // The work.
    let options = arguments.heights.options(&arguments.limits);
    let heights = TerrainHeights::open(&arguments.inputs, &options)?;
    let read_seconds = clock();
    let mut built = operations::terrain_build(heights, &clock)?;
    match output {
        Some(output) => {
            let written = PendingFile::filled(output, |mut file| Ok(built.write(&mut file)?))?;
            let named = written.commit();
            named.with_context(|| output.display().to_string())?;
            built.report.output = Some(output.to_owned());
        }
        None => built.write(&mut Cursor::new(Vec::new()))?,
    }
    let mut report = built.report;
    report.read_seconds = Some(read_seconds);
    report.seconds = Some(clock());

    // What was done.
    arguments
        .report
        .notes(&heights::note_lines(&report.notes))?;
    let inputs = told(&arguments.inputs);
    arguments.report.text(&text(&report, &inputs))?;
    Ok(arguments.report.json_line(&report.to_json())?)
}

/// The first file, and how many more there are.
fn told(inputs: &[PathBuf]) -> String {
    let first = inputs.first().map(|it| Path::new(it).display().to_string());
    let first = first.unwrap_or_default();
    match inputs.len() {
        0 | 1 => first,
        count => format!("{first} and {} more", count - 1),
    }
}

/// The report for people.
fn text(report: &TerrainBuildReport, inputs: &str) -> String {
    let mut text = format!("{inputs}: {}", heights::told(&report.terrain));
    if report.voids > 0 {
        let holes = match report.filled {
            0 => "which are holes (--fill closes them)".to_owned(),
            filled => format!("filled: {filled}"),
        };
        text += &format!("\nplaces without a height: {}, {holes}", report.voids);
    }
    if let Some(counts) = &report.points {
        text += &format!(
            "\npoints {}; at the place of another one: {}, not finite: {}; vertices that are no points: {}",
            counts.points, counts.duplicates, counts.not_finite, counts.steiner
        );
        if counts.left_out > 0 {
            text += &format!(
                "\npoints left out, too near to others for 32-bit positions: {}, by {} m at most from the surface at full detail",
                counts.left_out, counts.largest_left_out
            );
        }
    }
    if report.disagreeing > 0 {
        text += &format!(
            "\nplaces at which two heights disagree: {}, by {} m at most; the first one is taken",
            report.disagreeing, report.largest_disagreement
        );
    }
    text += &format!(
        "\n{} -> {} bytes in {:.1} s (reading {:.1}, hierarchy {:.1}); read back and compared",
        report.bytes_before,
        report.bytes_after.unwrap_or_default(),
        report.seconds.unwrap_or_default(),
        report.read_seconds.unwrap_or_default(),
        report.build_seconds,
    );
    text
}
