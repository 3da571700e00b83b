//! `terrain walk`: what each frame of a path costs.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;
use meshweft::operations::{
    self, EvictionPolicy, TerrainPath, TerrainSource, TerrainWalkOptions, TerrainWalkReport,
};

use super::heights::{self, Heights};
use crate::run::arguments::Size;
use crate::run::output::Report;
use crate::run::watch::Watch;
use crate::usage::Usage;
use crate::walks::cameras;
use crate::walks::frames::WalkedFrames;
use crate::walks::plot;
use crate::walks::policy::Policy;

#[derive(Debug, Args)]
pub(super) struct Walk {
    /// A .mwt file that terrain build wrote, or height maps as for terrain build
    #[arg(value_name = "FILE", required = true)]
    inputs: Vec<PathBuf>,
    /// circle: around the middle; rotate: around itself; straight: from west to east; fly: to and fro, turning; or a file of cameras
    #[arg(long, value_name = "PATH", default_value = "circle")]
    path: String,
    /// How many frames, at most all of a file of cameras [default: 3000, or all of a file of cameras]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// How many slots the vertex buffer has
    #[arg(long, value_name = "N", default_value_t = TerrainWalkOptions::default().slots)]
    slots: usize,
    /// The eviction policy: which slot the next vertex takes
    #[arg(long, value_name = "POLICY", default_value = "finest")]
    policy: Policy,
    /// How many pixels the surface may be off
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", default_value_t = TerrainWalkOptions::default().tolerance)]
    tolerance: f64,
    /// How many vertices a frame may have: what is seen worst is drawn exactly first, and the tolerance is not kept where it needs more
    #[arg(long, value_name = "VERTICES")]
    limit: Option<usize>,
    /// The picture, in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = cameras::picture_size)]
    size: [u32; 2],
    /// How many bytes a vertex has
    #[arg(long, value_name = "BYTES", default_value_t = TerrainWalkOptions::default().vertex_size)]
    vertex_size: usize,
    /// Draw a frame of more vertices than slots in passes; without it all its vertices are streamed
    #[arg(long)]
    passes: bool,
    /// Find the fewest inserts that any policy needs on this path
    #[arg(long)]
    optimum: bool,
    /// Plot vertices, faces, inserts and times over the frames
    #[arg(long, value_name = "OUT.svg")]
    plot: Option<PathBuf>,
    /// Let --plot replace a file that another program wrote
    #[arg(long, requires = "plot")]
    force: bool,
    #[command(flatten)]
    heights: Heights,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints what a walk costs.
pub(super) fn run(arguments: &Walk) -> Result<()> {
    let mut options = TerrainWalkOptions::default();
    options.frames = arguments.frames;
    options.slots = arguments.slots;
    options.policy = arguments.policy.eviction();
    options.tolerance = arguments.tolerance;
    options.limit = arguments.limit;
    options.size = arguments.size;
    options.vertex_size = arguments.vertex_size;
    options.passes = arguments.passes;
    options.optimum = arguments.optimum;

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
    if let Some(path) = &arguments.plot {
        let inputs = arguments.inputs.iter().map(PathBuf::as_path);
        plot::check(
            path,
            inputs,
            options.camera_file.as_deref(),
            arguments.force,
        )?;
    }

    let reading = arguments.heights.options(&arguments.limits);
    let source = TerrainSource::open(&arguments.inputs, &reading)?;
    let watch = Watch::new(None, arguments.report.shows_progress());
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let report = operations::terrain_walk(source, &options, &clock, &watch)?;
    watch.finish();

    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    arguments
        .report
        .notes(&heights::note_lines(&report.notes))?;
    if let Some(path) = &arguments.plot {
        plot::write(path, &frames_of(&report))?;
    }
    Ok(())
}

/// What was walked over, a table, and a line for each thing beside it.
fn text(report: &TerrainWalkReport) -> String {
    let options = &report.options;
    let [width, height] = options.size;
    let [vertices, faces] = report.distinct;
    let limit = match options.limit {
        Some(limit) => format!(", at most {limit} vertices"),
        None => String::new(),
    };
    let head = format!(
        "{}: {}\n{}, frames {} of {width} x {height}, tolerance {} px{limit}; slots {}, {}\n",
        report.file.display(),
        heights::told(&report.terrain),
        cameras::told(options.path.name(), options.camera_file.as_deref()),
        report.frames.len(),
        options.tolerance,
        options.slots,
        options.policy,
    );
    let drawn = format!("\ndrawn at some time: vertices {vertices}, faces {faces}");
    head + &frames_of(report).text() + &drawn
}

/// What is shown of it as of every walk.
fn frames_of(report: &TerrainWalkReport) -> WalkedFrames<'_> {
    WalkedFrames {
        frames: &report.frames,
        file_bytes: report.file_bytes,
        overfull: report.overfull_frames(),
        is_caching: report.options.policy != EvictionPolicy::Nothing,
        optimum: report.optimum,
    }
}
