//! `terrain extract`: one surface of those that a terrain has.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use clap::{ArgGroup, Args};
use meshweft::files::{self, NewMesh};
use meshweft::operations::{
    self, ExtractedTerrain, TerrainDetail, TerrainExtractOptions, TerrainExtractReport,
    TerrainSource,
};

use super::heights::{self, Heights};
use crate::run::arguments::Size;
use crate::run::output::Report;
use crate::run::side_file::TERRAIN;
use crate::usage::Usage;
use crate::walks::cameras;

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("detail").required(true))]
pub(super) struct Extract {
    /// A .mwt file that terrain build wrote, or height maps as for terrain build
    #[arg(value_name = "FILE", required = true)]
    inputs: Vec<PathBuf>,
    /// Where to write: a .glb, .gltf, .ply, .obj, .off or .stl file, optionally followed by .gz
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// No height is farther from the surface than this, vertically, in metres: 0 for all of them
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "M",
        group = "detail",
        display_order = 1
    )]
    error: Option<f64>,
    /// At most this many faces: the largest errors are cut first
    #[arg(long, value_name = "N", group = "detail", display_order = 1)]
    faces: Option<usize>,
    /// What a camera of this file needs; the file is as for lod walk --path
    #[arg(long, value_name = "CAMERAS.json", group = "detail", display_order = 1)]
    camera: Option<PathBuf>,
    /// Which camera of the file, from 0 [default: 0]
    #[arg(long, value_name = "K", conflicts_with_all = ["error", "faces"], display_order = 2)]
    frame: Option<usize>,
    /// How many pixels the surface may be off [default: 1]
    #[arg(long, allow_negative_numbers = true, value_name = "PIXELS", conflicts_with_all = ["error", "faces"], display_order = 2)]
    tolerance: Option<f64>,
    /// The picture, in pixels [default: 1024x768]
    #[arg(long, value_name = "WxH", conflicts_with_all = ["error", "faces"], value_parser = cameras::picture_size, display_order = 2)]
    size: Option<[u32; 2]>,
    #[command(flatten)]
    heights: Heights,
    /// Replace the output
    #[arg(long, display_order = 99)]
    force: bool,
    #[command(flatten)]
    limits: Size,
    #[command(flatten)]
    report: Report,
}

impl Extract {
    /// Which surface is asked for.
    fn detail(&self) -> Result<TerrainDetail> {
        if let Some(length) = self.error {
            return Ok(TerrainDetail::Error(length));
        }
        let Some(path) = &self.camera else {
            return Ok(TerrainDetail::Faces(self.faces.unwrap_or_default()));
        };
        let size = self.size.unwrap_or([1024, 768]);
        let frame = self.frame.unwrap_or_default();
        let camera = cameras::of_frame(path, frame, size, self.limits.limits())?;
        let tolerance = self.tolerance.unwrap_or(1.0);
        Ok(TerrainDetail::Camera { camera, tolerance })
    }
}

/// Extracts a surface.
pub(super) fn run(arguments: &Extract) -> Result<()> {
    let start = Instant::now();
    let options = TerrainExtractOptions::new(arguments.detail()?);
    options
        .check()
        .map_err(|error| Usage(format!("--{error}")))?;

    // What cannot be written is reported before a file is read.
    let inputs = arguments.inputs.iter().map(PathBuf::as_path);
    TERRAIN.check_no_mesh(&arguments.output, inputs)?;
    if let Some(cameras) = &arguments.camera {
        TERRAIN.check_other(&arguments.output, cameras, "--camera")?;
    }
    files::check_new(&arguments.output, arguments.force)?;

    // The work.
    let reading = arguments.heights.options(&arguments.limits);
    let source = TerrainSource::open(&arguments.inputs, &reading)?;
    let extracted = operations::terrain_extract(source, &options)?;
    let ExtractedTerrain {
        name,
        mesh,
        mut report,
        ..
    } = extracted;
    let new = NewMesh::plain(&name, mesh.positions(), mesh.faces());
    let written = files::create(&arguments.output, &[new], arguments.force)?;
    report.output = Some(arguments.output.clone());
    report.bytes_written = Some(written.bytes);
    report.seconds = Some(start.elapsed().as_secs_f64());

    // What was done.
    arguments
        .report
        .notes(&heights::note_lines(&report.notes))?;
    arguments.report.text(&text(&report, &arguments.output))?;
    Ok(arguments.report.json_line(&report.to_json())?)
}

/// The report for people.
fn text(report: &TerrainExtractReport, output: &Path) -> String {
    let mut text = format!(
        "{} -> {}: vertices {}, faces {} of {}; no height farther than {} m, vertically; strip: {:.3} vertices a face",
        report.file.display(),
        output.display(),
        report.vertices,
        report.faces,
        report.terrain.faces,
        report.error,
        report.strip_per_face(),
    );
    if let Some([length, read]) = report.bytes {
        text += &format!("\nread {read} of {length} bytes");
    }
    text
}
