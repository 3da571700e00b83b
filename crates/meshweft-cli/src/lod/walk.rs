//! `lod walk`: what each frame of a path costs.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;
use meshweft::files::ReadOptions;
use meshweft::operations::{
    self, CameraPath, EvictionPolicy, LodSource, LodWalkOptions, LodWalkReport,
};

use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::watch::Watch;
use crate::usage::Usage;
use crate::walks::cameras;
use crate::walks::frames::WalkedFrames;
use crate::walks::plot;
use crate::walks::policy::Policy;

#[derive(Debug, Args)]
pub(super) struct Walk {
    /// A .mwl, .gltf, .glb, .vrm, .obj, .ply, .off, .stl or .wrl file; all but .mwl may be followed by .gz
    #[arg(value_name = "FILE")]
    input: PathBuf,
    /// circle: once around; rotate: small turns to and fro; zoom: in and out; fly: close, turning; or a file of cameras
    #[arg(long, value_name = "PATH", default_value = "circle")]
    path: String,
    /// How many frames, at most all of a file of cameras [default: 1000, or all of a file of cameras]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// How many slots the vertex buffer has
    #[arg(long, value_name = "N", default_value_t = LodWalkOptions::default().slots)]
    slots: usize,
    /// The eviction policy: which slot the next vertex takes
    #[arg(long, value_name = "POLICY", default_value = "finest")]
    policy: Policy,
    /// How many pixels the surface may be off
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", default_value_t = LodWalkOptions::default().tolerance)]
    tolerance: f64,
    /// A vertex stays until its error is this part of the tolerance: 1 for never longer than needed
    #[arg(long, allow_negative_numbers = true, value_name = "PART", default_value_t = LodWalkOptions::default().hysteresis)]
    hysteresis: f64,
    /// The picture, in pixels
    #[arg(long, value_name = "WxH", default_value = "800x800", value_parser = cameras::picture_size)]
    size: [u32; 2],
    /// How many bytes a vertex has
    #[arg(long, value_name = "BYTES", default_value_t = LodWalkOptions::default().vertex_size)]
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
    limits: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints what a walk costs.
pub(super) fn run(arguments: &Walk) -> Result<()> {
    let mut options = LodWalkOptions::default();
    options.frames = arguments.frames;
    options.slots = arguments.slots;
    options.policy = arguments.policy.eviction();
    options.tolerance = arguments.tolerance;
    options.hysteresis = arguments.hysteresis;
    options.size = arguments.size;
    options.vertex_size = arguments.vertex_size;
    options.passes = arguments.passes;
    options.optimum = arguments.optimum;

    // All that can be wrong without the mesh.
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;
    let limits = arguments.limits.limits();
    let shapes = CameraPath::SHAPES.map(|it| (it.name(), it));
    (options.path, options.camera_file) = cameras::path(
        &arguments.path,
        shapes,
        CameraPath::Given,
        options.size,
        limits,
    )?;
    if let Some(path) = &arguments.plot {
        let inputs = [arguments.input.as_path()];
        plot::check(
            path,
            inputs,
            options.camera_file.as_deref(),
            arguments.force,
        )?;
    }

    let mut reading = ReadOptions::default();
    reading.limits = limits;
    let source = LodSource::open(&arguments.input, &reading)?;
    let watch = Watch::new(None, arguments.report.shows_progress());
    let start = Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    let report = operations::lod_walk(source, &options, &clock, &watch)?;
    watch.finish();

    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    let notes = output::note_lines(&report.file, &report.notes);
    arguments.report.notes(&notes)?;
    if let Some(path) = &arguments.plot {
        plot::write(path, &report_of(&report))?;
    }
    Ok(())
}

/// What was walked around, a table, and a line for each thing beside it.
fn text(report: &LodWalkReport) -> String {
    let (options, mesh) = (&report.options, &report.mesh);
    let [width, height] = options.size;
    let head = format!(
        "{}: vertices {}, faces {}; coarsest with vertices {}\n\
         {}, frames {} of {width} x {height}, tolerance {} px; slots {}, {}\n",
        report.file.display(),
        mesh.vertices,
        mesh.faces,
        mesh.roots,
        cameras::told(options.path.name(), options.camera_file.as_deref()),
        report.frames.len(),
        options.tolerance,
        options.slots,
        options.policy,
    );
    head + &report_of(report).text()
}

/// What is shown of it as of every walk.
fn report_of(report: &LodWalkReport) -> WalkedFrames<'_> {
    WalkedFrames {
        frames: &report.frames,
        file_bytes: report.file_bytes,
        overfull: report.overfull_frames(),
        is_caching: report.options.policy != EvictionPolicy::Nothing,
        optimum: report.optimum,
    }
}
