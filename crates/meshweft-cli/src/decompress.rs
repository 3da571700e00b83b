//! `decompress`: a compressed file as a mesh file.

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use meshweft::files::{self, Format, NewMesh};
use meshweft::operations::{self, DecodedOrder, DecompressOptions, DecompressedMesh};
use serde_json::json;

use crate::run::arguments::Size;
use crate::run::output::Report;

#[derive(Debug, Args)]
pub(crate) struct Decompress {
    /// A file that compress wrote
    #[arg(value_name = "IN.mwz")]
    input: PathBuf,
    /// Where to write: a .glb, .gltf, .obj, .ply, .off or .stl file; the last three hold one mesh; .obj, .ply and .off have
    /// polygons, if they were compressed
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Write the triangles that polygons are drawn as
    #[arg(long, display_order = 2)]
    triangles: bool,
    /// The order of faces and vertices
    #[arg(
        long,
        value_name = "ORDER",
        default_value = "source",
        display_order = 1
    )]
    order: Order,
    /// Replace the output
    #[arg(long, display_order = 99)]
    force: bool,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    report: Report,
}

/// An order as it is given.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Order {
    /// As in the source, if compress was given --keep-order; what was not kept, as by window
    Source,
    /// Good to draw for small caches and batches of a card; vertices in the order of their first use
    Window,
    /// As it is stored: compressed again with --root 0, the same bytes
    Stored,
}

impl Decompress {
    /// The flags for the library.
    fn options(&self) -> DecompressOptions {
        let mut options = DecompressOptions::default();
        options.limits = self.size.limits();
        let has_polygons = matches!(
            Format::of_path(&self.output),
            Some(Format::Obj | Format::Ply | Format::Off)
        );
        options.triangles = self.triangles || !has_polygons;
        options.order = match self.order {
            Order::Source => DecodedOrder::Source,
            Order::Window => DecodedOrder::Window,
            Order::Stored => DecodedOrder::Stored,
        };
        options
    }
}

/// Decompresses a file.
pub(crate) fn run(arguments: &Decompress) -> Result<()> {
    let start = Instant::now();
    let name = || arguments.input.display().to_string();
    let options = arguments.options();
    let limits = options.limits;

    // What is read, not more than is allowed.
    let mut bytes = Vec::new();
    let file = fs::File::open(&arguments.input).with_context(name)?;
    let most = limits.file_bytes.saturating_add(1);
    file.take(most).read_to_end(&mut bytes).with_context(name)?;
    if bytes.len() as u64 > limits.file_bytes {
        bail!(
            "{}: more than {} bytes: allow more with --max-bytes",
            name(),
            limits.file_bytes
        );
    }
    let meshes = operations::decompress(&bytes, &options).with_context(name)?;

    // What is written.
    let new = meshes.iter();
    let new: Vec<NewMesh<'_>> = new
        .map(
            |DecompressedMesh {
                 name,
                 mesh,
                 polygons,
                 ..
             }| {
                let new = NewMesh::plain(name, mesh.positions(), mesh.faces());
                match polygons {
                    Some(starts) => new.with_polygons(starts),
                    None => new,
                }
            },
        )
        .collect();
    let written = files::create(&arguments.output, &new, arguments.force)?;

    // What was done.
    let vertices: usize = meshes.iter().map(|it| it.mesh.vertex_count()).sum();
    let faces: usize = meshes.iter().map(|it| it.mesh.face_count()).sum();
    let starts = || meshes.iter().filter_map(|it| it.polygons.as_deref());
    let polygons: usize = starts()
        .map(|starts| {
            starts
                .windows(2)
                .filter(|ends| ends[1] - ends[0] > 1)
                .count()
        })
        .sum();
    let and_polygons = match polygons {
        0 => String::new(),
        1 => ", 1 polygon".to_owned(),
        _ => format!(", {polygons} polygons"),
    };
    let output = arguments.output.display().to_string();
    arguments.report.text(&format!(
        "{} -> {output}: {} {}, {vertices} vertices, {faces} faces{and_polygons}",
        name(),
        meshes.len(),
        if meshes.len() == 1 { "mesh" } else { "meshes" },
    ))?;
    let members = json!({
        "file": name(),
        "output": output,
        "bytes": {"before": bytes.len(), "after": written.bytes},
        "seconds": start.elapsed().as_secs_f64(),
        "meshes": meshes.len(),
        "vertices": vertices,
        "faces": faces,
        "polygons": polygons,
    });
    Ok(arguments.report.json("decompress", &members)?)
}
