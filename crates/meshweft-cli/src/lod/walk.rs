//! `lod walk`: what each frame of a path costs.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use meshweft::files::ReadOptions;
use meshweft::operations::{
    self, CameraPath, EvictionPolicy, LodSource, LodWalkOptions, LodWalkReport, WalkFrame,
    WalkQuantity,
};

use crate::columns::columns;
use crate::plot::{self, Axis, Curve};
use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::side_file::{PLOT, PendingFile};
use crate::run::watch::Watch;
use crate::usage::Usage;
use crate::walks::cameras;

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

/// A policy as it is given.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Policy {
    /// Of all open slots, the one with the finest detail
    Finest,
    /// The slot that was used least recently
    Lru,
    /// The finest detail of the oldest slots: a tenth of all at most, open for 30 frames
    Queue,
    /// The first slot that was used neither in this frame nor in the last
    First,
    /// No slots: all active vertices are sent in every frame
    None,
}

impl Policy {
    fn eviction(self) -> EvictionPolicy {
        match self {
            Self::Finest => EvictionPolicy::FinestFirst,
            Self::Lru => EvictionPolicy::OldestFirst,
            Self::Queue => EvictionPolicy::queued_by_error(10, 30),
            Self::First => EvictionPolicy::FirstAvailable,
            Self::None => EvictionPolicy::Nothing,
        }
    }
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
        PLOT.check_no_mesh(path, [arguments.input.as_path()])?;
        if let Some(cameras) = &options.camera_file {
            PLOT.check_other(path, cameras, "--path")?;
        }
        PLOT.check(path, arguments.force)?;
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
        let written = PendingFile::new(path, svg(&report)).and_then(PendingFile::commit);
        written.with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// What is shown of a quantity, and its digits after the point.
const ROWS: [(WalkQuantity, &str, usize); 13] = [
    (WalkQuantity::Vertices, "active vertices", 0),
    (WalkQuantity::Faces, "faces", 0),
    (WalkQuantity::Added, "vertices added", 0),
    (WalkQuantity::Removed, "vertices removed", 0),
    (WalkQuantity::Inserts, "inserts", 0),
    (WalkQuantity::VertexRanges, "vertex ranges", 0),
    (WalkQuantity::VertexBytes, "vertex bytes", 0),
    (WalkQuantity::PatchedFaces, "faces patched", 0),
    (WalkQuantity::IndexRanges, "index ranges", 0),
    (WalkQuantity::IndexBytes, "index bytes", 0),
    (WalkQuantity::UpdateMilliseconds, "ms, level of detail", 3),
    (WalkQuantity::CacheMilliseconds, "ms, slots", 3),
    (WalkQuantity::IndexMilliseconds, "ms, indices", 3),
];

/// What was walked around, a table, and a line for each thing beside it.
fn text(report: &LodWalkReport) -> String {
    let (options, mesh) = (&report.options, &report.mesh);
    let [width, height] = options.size;
    let mut text = format!(
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
    let head = ["a frame", "first", "mean", "median", "worst", "all frames"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let read = report
        .file_bytes
        .map(|_| (WalkQuantity::ReadBytes, "file bytes read", 0));
    for (quantity, name, digits) in ROWS.into_iter().chain(read) {
        let it = report.summary(quantity);
        let [count, part] = [digits, digits.max(1)];
        let later = [(it.mean, part), (it.median, part), (it.worst, count)];
        let later = later.map(|(value, digits)| match report.frames.len() {
            1 => "-".to_owned(),
            _ => format!("{value:.digits$}"),
        });
        let [first, all] = [it.first, it.total].map(|value| format!("{value:.count$}"));
        rows.push([&[name.to_owned(), first], &later[..], &[all]].concat());
    }
    text += &columns(&rows);

    if let Some(length) = report.file_bytes {
        let read = report.summary(WalkQuantity::ReadBytes).total;
        let percent = 100.0 * read / length as f64;
        text += &format!("\nbytes of the file: {length}; read: {read}, {percent:.2} %");
    }
    let [streamed, in_passes] = report.overfull_frames();
    if streamed > 0 && options.policy != EvictionPolicy::Nothing {
        text += &format!(
            "\nframes of more vertices than slots: {streamed}, streamed (--passes or more --slots send less)"
        );
    }
    if in_passes > 0 {
        let passes = report.summary(WalkQuantity::Passes).total;
        text +=
            &format!("\nframes of more vertices than slots: {in_passes}, all in {passes} passes");
    }
    if let Some(optimum) = report.optimum {
        let inserts = report.summary(WalkQuantity::Inserts).total;
        let (distinct, fewest) = optimum.times(inserts);
        let vertices = optimum.distinct_vertices;
        text +=
            &format!("\nvertices active at some time: {vertices}; inserts: {distinct:.3} times");
        text += &match optimum.fewest_inserts.zip(fewest) {
            Some((fewest, times)) => {
                format!(" that, {times:.3} times the fewest possible, {fewest}")
            }
            None => {
                " that; the fewest possible is not known, as a frame has more vertices than there are slots".to_owned()
            }
        };
    }
    text
}

/// Points of a curve at most.
const PLOTTED: usize = 500;

/// Counts of the frames above, times below; the first frame left out, means where there are many frames.
fn svg(report: &LodWalkReport) -> String {
    let later = report.frames.get(1..).unwrap_or_default();
    let together = later.len().div_ceil(PLOTTED).max(1);
    let curve = |quantity: WalkQuantity, name: &str| {
        let point = |(number, frames): (usize, &[WalkFrame])| {
            let sum: f64 = frames.iter().map(|frame| quantity.of(frame)).sum();
            [(1 + number * together) as f64, sum / frames.len() as f64]
        };
        let points = later.chunks(together).enumerate().map(point);
        Curve::new(name.to_owned(), points.collect())
    };
    let picture = |title: &str, unit: &'static str, quantities: &[(WalkQuantity, &str)]| {
        let curves = quantities
            .iter()
            .map(|&(quantity, name)| curve(quantity, name));
        let curves: Vec<Curve> = curves.collect();
        let frames = report.frames.len();
        let axes = [
            Axis::of_numbers("frame", frames),
            Axis::of_decades(unit, &curves, 1),
        ];
        plot::svg(title, &axes, &curves)
    };

    let counts = [
        (WalkQuantity::Vertices, "active vertices"),
        (WalkQuantity::Faces, "faces"),
        (WalkQuantity::Inserts, "inserts"),
        (WalkQuantity::PatchedFaces, "faces patched"),
    ];
    let times = [
        (WalkQuantity::UpdateMilliseconds, "level of detail"),
        (WalkQuantity::CacheMilliseconds, "slots"),
        (WalkQuantity::IndexMilliseconds, "indices"),
    ];
    plot::stacked(
        &picture("Frames of a walk", "number", &counts),
        &picture("Times of these frames", "milliseconds", &times),
    )
}
