//! `lod build`: a mesh with all its levels of detail as a file.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use meshweft::files::{Document, ReadOptions};
use meshweft::operations::{self, LodBuildOptions, LodBuildReport};

use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::side_file::{HIERARCHY, PendingFile};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(super) struct Build {
    /// A .gltf, .glb, .vrm, .obj, .ply, .off, .stl or .wrl file, optionally followed by .gz
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where to write: a .mwl file
    #[arg(
        short,
        long,
        value_name = "OUT.mwl",
        required_unless_present = "dry_run"
    )]
    output: Option<PathBuf>,
    /// Do everything but write
    #[arg(long)]
    dry_run: bool,
    /// Leave out what a .mwl file cannot hold. Without it such a file is refused, and the message says what it has:
    /// attributes of corners and faces, or of the vertices of some meshes only, materials, groups, polygons, the borders and
    /// names of several meshes, lines, nodes that are moved or drawn twice, animations, elements of other names
    #[arg(long, display_order = 2)]
    drop_attributes: bool,
    /// Leave out normals, texture coordinates, colors and all else of vertices too: positions and faces alone
    #[arg(long, display_order = 2)]
    positions_only: bool,
    /// Replace an output that is not a .mwl file
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
    let output = arguments.output.as_deref();

    // What cannot be written is reported before a file is read.
    if let Some(output) = output {
        let ending = output.extension();
        if ending.is_none_or(|it| !it.eq_ignore_ascii_case("mwl")) {
            let text = format!("{}: give the output the ending .mwl", output.display());
            return Err(Usage(text).into());
        }
        HIERARCHY.check_no_mesh(output, [arguments.input.as_path()])?;
        HIERARCHY.check(output, arguments.force)?;
    }
    let output = output.filter(|_| !arguments.dry_run);

    // The work.
    let mut reading = ReadOptions::default();
    reading.limits = arguments.limits.limits();
    let document = Document::open(&arguments.input, reading)?;
    let mut options = LodBuildOptions::default();
    options.drop_attributes = arguments.drop_attributes;
    options.positions_only = arguments.positions_only;
    let (bytes, mut report) = operations::lod_build(&document, &options)?;
    drop(document);
    if let Some(output) = output {
        let written = PendingFile::new(output, bytes).and_then(PendingFile::commit);
        written.with_context(|| output.display().to_string())?;
        report.output = Some(output.to_owned());
    }
    report.seconds = Some(start.elapsed().as_secs_f64());

    // What was done.
    let notes = output::note_lines(&report.file, &report.notes);
    arguments.report.notes(&notes)?;
    arguments.report.text(&text(&report))?;
    Ok(arguments.report.json_line(&report.to_json())?)
}

/// The report for people.
fn text(report: &LodBuildReport) -> String {
    let mut text = format!(
        "{}: vertices {}, faces {}; coarsest with vertices {}, depth {}",
        report.file.display(),
        report.vertices,
        report.faces,
        report.roots,
        report.depth,
    );
    let asides = [
        (
            report.cut_points,
            "points where the surface is not a manifold, which stay",
        ),
        (
            report.flat_faces,
            "faces with two corners at one place, left out",
        ),
        (
            report.unused_vertices,
            "vertices that no face uses, left out",
        ),
    ];
    for (count, what) in asides.into_iter().filter(|&(count, _)| count > 0) {
        text += &format!("\n{what}: {count}");
    }
    if !report.attributes.is_empty() {
        let names = report.attributes.iter().map(|it| it.semantic.to_string());
        let names: Vec<String> = names.collect();
        text += &format!("\nwith each vertex: {}", names.join(", "));
    }
    text += &format!(
        "\n{} -> {} bytes in {:.1} s; read back and compared",
        report.bytes_before,
        report.bytes_after,
        report.seconds.unwrap_or_default(),
    );
    text
}
