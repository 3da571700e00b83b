//! `compress`: positions, faces and polygons in few bytes.

use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use meshweft::connectivity::FirstVertex;
use meshweft::files::{Document, ReadOptions};
use meshweft::operations::{
    self, CompressOptions, CompressReport, KeepOrder, PolygonCounts, PositionPrecision, Tier,
};

use crate::run::arguments::Size;
use crate::run::output::{self, Report};
use crate::run::side_file::{ARCHIVE, PendingFile};
use crate::usage::Usage;

#[derive(Debug, Args)]
pub(crate) struct Compress {
    /// A .gltf, .glb, .vrm, .obj, .ply, .off, .stl or .wrl file, optionally followed by .gz
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where to write: a .mwz file
    #[arg(
        short,
        long,
        value_name = "OUT.mwz",
        required_unless_present = "dry_run"
    )]
    output: Option<PathBuf>,
    /// Do everything but write
    #[arg(long)]
    dry_run: bool,
    /// What is paid for a smaller file
    #[arg(
        long,
        value_name = "TIER",
        default_value = "default",
        display_order = 1
    )]
    tier: TierName,
    /// lossless, or 1 to 30: the largest extent of the file is two to the power of this, minus one, steps long
    #[arg(
        long,
        value_name = "BITS",
        default_value = "lossless",
        display_order = 1
    )]
    position_bits: PositionBits,
    /// Round positions to multiples of a power of two, in their units: files with one step keep meeting
    #[arg(
        long,
        value_name = "STEP",
        display_order = 1,
        conflicts_with = "position_bits"
    )]
    position_step: Option<f64>,
    /// Where each mesh begins: min-buffer (each vertex is sent once to the smallest buffer), min-bits, or a
    /// number of a vertex; 0 gives what decompress --order stored wrote the same bytes again
    #[arg(
        long,
        value_name = "ROOT",
        default_value = "min-buffer",
        display_order = 2
    )]
    root: Root,
    /// Store the order of the file too, for decompress to give back: faces (and which corner is first), vertices, or
    /// both
    #[arg(long, value_name = "WHAT", display_order = 2)]
    keep_order: Option<Kept>,
    /// Leave out whatever is not the name of a mesh, a position or a face; a file that has more is refused without it,
    /// and the message names what: normals, texture coordinates, colors, materials, groups, lines, nodes that are moved
    /// or drawn twice, animations, elements of other names. Comments, header text and how numbers are written are not
    /// kept and do not count
    #[arg(long, display_order = 2)]
    drop_attributes: bool,
    /// Store polygons as the triangles that they are drawn as, and leave out faces of fewer than three corners
    #[arg(long, display_order = 2)]
    triangles: bool,
    /// Replace the output, whatever it is
    #[arg(long, display_order = 99)]
    force: bool,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    report: Report,
}

/// A tier as it is given.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum TierName {
    /// The fastest to decode
    Fast,
    /// Fewer bytes: how vertices lie says what faces are likely
    Default,
}

/// What of the order is stored, as it is given.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kept {
    Faces,
    Vertices,
    Both,
}

/// Bits such as `14`, or `lossless`.
#[derive(Debug, Clone, Copy)]
struct PositionBits(Option<u32>);

impl FromStr for PositionBits {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse()) {
            ("lossless", _) => Ok(Self(None)),
            (_, Ok(bits @ 1..=30)) => Ok(Self(Some(bits))),
            _ => Err("lossless, or 1 to 30".into()),
        }
    }
}

/// A way to choose the first vertex, or a vertex.
#[derive(Debug, Clone, Copy)]
struct Root(FirstVertex);

impl FromStr for Root {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse()) {
            ("min-buffer", _) => Ok(Self(FirstVertex::MinBuffer)),
            ("min-bits", _) => Ok(Self(FirstVertex::MinBits)),
            (_, Ok(vertex)) => Ok(Self(FirstVertex::Given(vertex))),
            _ => Err("min-buffer, min-bits, or the number of a vertex, from 0".into()),
        }
    }
}

impl Compress {
    /// The flags for the library.
    fn options(&self) -> CompressOptions {
        let mut options = CompressOptions::default();
        options.tier = match self.tier {
            TierName::Fast => Tier::Fast,
            TierName::Default => Tier::Default,
        };
        options.positions = match (self.position_step, self.position_bits.0) {
            (Some(step), _) => PositionPrecision::Step(step),
            (None, Some(bits)) => PositionPrecision::Bits(bits),
            (None, None) => PositionPrecision::Lossless,
        };
        options.first_vertex = self.root.0;
        options.keep_order = match self.keep_order {
            None => KeepOrder::Nothing,
            Some(Kept::Faces) => KeepOrder::Faces,
            Some(Kept::Vertices) => KeepOrder::Vertices,
            Some(Kept::Both) => KeepOrder::Both,
        };
        options.drop_attributes = self.drop_attributes;
        options.triangles = self.triangles;
        options
    }
}

/// Compresses a file.
pub(crate) fn run(arguments: &Compress) -> Result<()> {
    let start = Instant::now();

    // What cannot be written is reported before a file is read.
    if let Some(output) = arguments.output.as_deref().filter(|_| !arguments.dry_run) {
        if output
            .extension()
            .is_none_or(|it| !it.eq_ignore_ascii_case("mwz"))
        {
            let text = format!("{}: give the output the ending .mwz", output.display());
            return Err(Usage(text).into());
        }
        ARCHIVE.check_no_mesh(output, [arguments.input.as_path()])?;
        ARCHIVE.check(output, arguments.force)?;
    }

    // The work.
    let mut reading = ReadOptions::default();
    reading.limits = arguments.size.limits();
    let document = Document::open(&arguments.input, reading)?;
    let (bytes, mut report) = operations::compress(&document, &arguments.options())?;
    if let Some(output) = arguments.output.as_deref().filter(|_| !arguments.dry_run) {
        let written = PendingFile::new(output, bytes).and_then(PendingFile::commit);
        written.with_context(|| output.display().to_string())?;
        report.output = Some(output.to_owned());
    }
    report.seconds = Some(start.elapsed().as_secs_f64());

    // What was done.
    arguments
        .report
        .notes(&output::note_lines(&report.file, &report.notes))?;
    arguments.report.text(&text(&report))?;
    Ok(arguments.report.json_line(&report.to_json())?)
}

/// The report for people: a line a mesh, and the sum.
fn text(report: &CompressReport) -> String {
    let mesh = |mesh: &operations::CompressedMesh| {
        let PolygonCounts { kept, cut } = mesh.polygons;
        let mut polygons = match kept {
            0 => String::new(),
            1 => format!(", 1 polygon in {:.0} bytes", mesh.sizes.polygons),
            _ => format!(
                ", {kept} polygons in {:.0} bytes ({:.2} bits each)",
                mesh.sizes.polygons,
                mesh.polygon_bits()
            ),
        };
        if cut > 0 {
            let text = match cut {
                1 => ", 1 polygon stored as its triangles".to_owned(),
                _ => format!(", {cut} polygons stored as their triangles"),
            };
            polygons += &text;
        }
        let order = match report.options.keep_order {
            KeepOrder::Nothing => String::new(),
            _ => format!(", {:.0} bytes for the order", mesh.sizes.order),
        };
        format!(
            "{}: {} vertices, {} faces: {} bytes ({:.2} bits a face and {:.2} a vertex{order}){polygons}; each vertex sent \
             once to a buffer of {}\n",
            mesh.name,
            mesh.vertices,
            mesh.faces,
            mesh.bytes,
            mesh.connectivity_bits(),
            mesh.position_bits(),
            mesh.buffer_size,
        )
    };
    let meshes: String = report.meshes.iter().map(mesh).collect();
    let rounded = report.step.map_or_else(
        || "every bit of the positions".to_owned(),
        |step| format!("positions rounded to multiples of {step}"),
    );
    let what = match report.options.triangles {
        true => " and faces",
        false => ", faces and polygons",
    };
    format!(
        "{meshes}{}: {} -> {} bytes, {rounded}; decoded and compared. Names, positions{what} are stored, nothing else",
        report.file.display(),
        report.bytes_before,
        report.bytes_after,
    )
}
