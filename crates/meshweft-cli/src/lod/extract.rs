//! `lod extract`: one mesh of those that a `.mwl` file has.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{ArgGroup, Args};
use meshweft::files::{self, NewMesh, NewVertices};
use meshweft::operations::{
    self, ExtractedMesh, LodDetail, LodExtractOptions, LodExtractReport, LodWalkOptions,
};

use crate::run::arguments::Size;
use crate::run::output::Report;
use crate::run::side_file::HIERARCHY;
use crate::usage::Usage;
use crate::walks::cameras;

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("detail").required(true))]
pub(super) struct Extract {
    /// A file that lod build wrote
    #[arg(value_name = "FILE.mwl")]
    input: PathBuf,
    /// Where to write: a .glb, .gltf, .ply, .obj, .off or .stl file, optionally followed by .gz; the last three hold
    /// positions and faces alone: give --positions-only with them if vertices have more
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Keep every vertex whose error is above this length, in units of the positions: 0 for the mesh that the file was built of
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "LENGTH",
        group = "detail",
        display_order = 1
    )]
    error: Option<f64>,
    /// At most this many vertices, those of the largest errors
    #[arg(long, value_name = "N", group = "detail", display_order = 1)]
    vertices: Option<usize>,
    /// What a camera of this file needs; the file is as for lod walk --path
    #[arg(long, value_name = "CAMERAS.json", group = "detail", display_order = 1)]
    camera: Option<PathBuf>,
    /// Which camera of the file, from 0 [default: 0]
    #[arg(long, value_name = "K", conflicts_with_all = ["error", "vertices"], display_order = 2)]
    frame: Option<usize>,
    /// How many pixels the surface may be off [default: 1.5]
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", conflicts_with_all = ["error", "vertices"], display_order = 2)]
    tolerance: Option<f64>,
    /// The picture, in pixels [default: 800x800]
    #[arg(long, value_name = "WxH", conflicts_with_all = ["error", "vertices"], value_parser = cameras::picture_size, display_order = 2)]
    size: Option<[u32; 2]>,
    /// Write positions and faces alone
    #[arg(long, display_order = 3)]
    positions_only: bool,
    /// Replace the output
    #[arg(long, display_order = 99)]
    force: bool,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

impl Extract {
    /// Which mesh is asked for.
    fn detail(&self) -> Result<LodDetail> {
        if let Some(length) = self.error {
            return Ok(LodDetail::Error(length));
        }
        let Some(path) = &self.camera else {
            return Ok(LodDetail::Vertices(self.vertices.unwrap_or_default()));
        };
        let usual = LodWalkOptions::default();
        let size = self.size.unwrap_or(usual.size);
        let frame = self.frame.unwrap_or_default();
        let camera = cameras::of_frame(path, frame, size, self.limits.limits())?;
        let tolerance = self.tolerance.unwrap_or(usual.tolerance);
        Ok(LodDetail::Camera { camera, tolerance })
    }
}

/// Extracts a mesh.
pub(super) fn run(arguments: &Extract) -> Result<()> {
    let start = Instant::now();
    let mut options = LodExtractOptions::new(arguments.detail()?);
    options.limits = arguments.limits.limits();
    options.positions_only = arguments.positions_only;
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;

    // What cannot be written is reported before a file is read.
    HIERARCHY.check_no_mesh(&arguments.output, [arguments.input.as_path()])?;
    if let Some(cameras) = &arguments.camera {
        HIERARCHY.check_other(&arguments.output, cameras, "--camera")?;
    }
    files::check_new(&arguments.output, arguments.force)?;

    // The work.
    let name = || arguments.input.display().to_string();
    let source = fs::File::open(&arguments.input).with_context(name)?;
    if !source.metadata().with_context(name)?.is_file() {
        bail!(
            "{}: this is a folder, a pipe or a device: name a file",
            name()
        );
    }
    let extracted = operations::lod_extract(source, &arguments.input, &options)?;
    let ExtractedMesh {
        name,
        mesh,
        attributes,
        mut report,
        ..
    } = extracted;
    let new = NewMesh::new(&name, NewVertices::Stored(&attributes), mesh.faces());
    let written = files::create(&arguments.output, &[new], arguments.force)?;
    report.output = Some(arguments.output.clone());
    report.bytes_written = Some(written.bytes);
    report.seconds = Some(start.elapsed().as_secs_f64());

    // What was done.
    arguments.report.text(&text(&report, &arguments.output))?;
    Ok(arguments.report.json_line(&report.to_json())?)
}

/// The report for people.
fn text(report: &LodExtractReport, output: &Path) -> String {
    let left_out = match report.vertices < report.vertices_of_file {
        true => format!("; largest error of what is left out: {}", report.error),
        false => String::new(),
    };
    format!(
        "{} -> {}: vertices {} of {}, faces {}{left_out}\nread {} of {} bytes",
        report.file.display(),
        output.display(),
        report.vertices,
        report.vertices_of_file,
        report.faces,
        report.bytes_read,
        report.file_bytes,
    )
}
