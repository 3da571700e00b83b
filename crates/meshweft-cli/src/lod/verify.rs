//! `lod verify`: how far what is drawn is off.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use meshweft::files::ReadOptions;
use meshweft::operations::{
    self, CameraPath, LodSource, LodVerifyOptions, LodVerifyReport, PixelErrors,
};

use crate::columns::columns;
use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::watch::Watch;
use crate::usage::Usage;
use crate::walks::cameras;

#[derive(Debug, Args)]
pub(super) struct Verify {
    /// A .mwl, .gltf, .glb, .vrm, .obj, .ply, .off, .stl or .wrl file; all but .mwl may be followed by .gz
    #[arg(value_name = "FILE")]
    input: PathBuf,
    /// circle: once around; rotate: small turns to and fro; zoom: in and out; fly: close, turning; or a file of cameras
    #[arg(long, value_name = "PATH", default_value = "circle")]
    path: String,
    /// How many frames, evenly on the path, at most all of a file of cameras [default: 9]
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// How many pixels the surface may be off
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", default_value_t = LodVerifyOptions::default().tolerance)]
    tolerance: f64,
    /// A vertex stays until its error is this part of the tolerance: 1 for never longer than needed
    #[arg(long, allow_negative_numbers = true, value_name = "PART", default_value_t = LodVerifyOptions::default().hysteresis)]
    hysteresis: f64,
    /// The picture, in pixels
    #[arg(long, value_name = "WxH", default_value = "800x800", value_parser = cameras::picture_size)]
    size: [u32; 2],
    /// Exit with 1 if less than this percentage of the measured vertices is within the tolerance, over all frames
    #[arg(long, allow_negative_numbers = true, value_name = "PERCENT")]
    min_share: Option<f64>,
    /// Exit with 1 if a vertex is farther off than this many tolerances
    #[arg(long, allow_negative_numbers = true, value_name = "TIMES")]
    max_error: Option<f64>,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

/// Prints how far a mesh is off.
pub(super) fn run(arguments: &Verify) -> Result<()> {
    let mut options = LodVerifyOptions::default();
    options.frames = arguments.frames;
    options.tolerance = arguments.tolerance;
    options.hysteresis = arguments.hysteresis;
    options.size = arguments.size;
    options.min_share = arguments.min_share;
    options.max_error = arguments.max_error;

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

    let mut reading = ReadOptions::default();
    reading.limits = limits;
    let source = LodSource::open(&arguments.input, &reading)?;
    let watch = Watch::new(None, arguments.report.shows_progress());
    let report = operations::lod_verify(source, &options, &watch)?;
    watch.finish();

    arguments.report.json_line(&report.to_json())?;
    arguments.report.text(&text(&report))?;
    let notes = output::note_lines(&report.file, &report.notes);
    arguments.report.notes(&notes)?;
    let failures = report.failures();
    if !failures.is_empty() {
        bail!("{}: {}", report.file.display(), failures.join("; "));
    }
    Ok(())
}

/// What was looked at, and a line for each frame and for all.
fn text(report: &LodVerifyReport) -> String {
    let (options, mesh) = (&report.options, &report.mesh);
    let [width, height] = options.size;
    let mut text = format!(
        "{}: vertices {}, faces {}; coarsest with vertices {}\n\
         {}, frames {} of {width} x {height}, tolerance {} px; errors in tolerances\n",
        report.file.display(),
        mesh.vertices,
        mesh.faces,
        mesh.roots,
        cameras::told(options.path.name(), options.camera_file.as_deref()),
        report.frames.len(),
        options.tolerance,
    );
    let head = [
        "frame",
        "faces",
        "turned",
        "vertices seen",
        "within, %",
        "99.9 % below",
        "worst",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let mut add = |name: String, [faces, turned]: [usize; 2], errors: &PixelErrors| {
        let row = [
            name,
            faces.to_string(),
            turned.to_string(),
            errors.seen.to_string(),
            format!("{:.4}", errors.share()),
            format!("{:.3}", errors.p999),
            format!("{:.3}", errors.worst),
        ];
        rows.push(row.to_vec());
    };
    for frame in &report.frames {
        let faces = [frame.faces, frame.turned_faces];
        add(frame.number.to_string(), faces, &frame.errors);
    }
    add("all".to_owned(), report.face_counts(), &report.errors);
    text += &columns(&rows);
    text
}
