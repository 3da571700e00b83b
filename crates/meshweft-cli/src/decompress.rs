//! `decompress`: a compressed file as a mesh file.

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use meshweft::files::{self, NewMesh};
use meshweft::operations::{self, DecodedOrder, DecompressOptions};
use serde_json::json;

use crate::run::arguments::Size;
use crate::run::output::Report;

#[derive(Debug, Args)]
pub(crate) struct Decompress {
    /// A file that compress wrote
    #[arg(value_name = "IN.mwz")]
    input: PathBuf,
    /// Where to write: a .glb, .gltf, .obj, .ply, .off or .stl file; the last three hold one mesh
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
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
        .map(|(name, mesh)| NewMesh::plain(name, mesh.positions(), mesh.faces()))
        .collect();
    let written = files::create(&arguments.output, &new, arguments.force)?;

    // What was done.
    let vertices: usize = meshes.iter().map(|(_, mesh)| mesh.vertex_count()).sum();
    let faces: usize = meshes.iter().map(|(_, mesh)| mesh.face_count()).sum();
    let output = arguments.output.display().to_string();
    arguments.report.text(&format!(
        "{} -> {output}: {} {}, {vertices} vertices, {faces} faces",
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
    });
    Ok(arguments.report.json("decompress", &members)?)
}
