//! View-dependent detail against its rivals: faces at equal error, bytes that are sent, eviction policies, times, and how
//! good the mesh of a budget is; as Markdown.
//!
//! ```text
//! cargo run --release --bin detail -- [--table faces|bytes|policies|times|budget]... [--all] [mesh files]
//! ```
//!
//! Three meshes of the test data by default, with `--all` all of at least 50 thousand faces. Paths are those of
//! `meshweft lod walk`, in pictures of 800 by 800: A circle, B small turns, C in and out, D flight. Errors are true ones:
//! of each vertex of the full mesh that is in the picture and whose normal faces the eye, how far it is from the drawn
//! surface, in pixels at its distance.

mod budget;
mod bytes;
mod faces;
mod pixel_error;
mod policies;
mod scene;
mod times;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use compare::counting::Counting;
use meshweft::operations::CameraPath;
use scene::Scene;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const MESHES: [&str; 3] = ["bunny.ply.gz", "armadillo.obj.gz", "dragon.ply.gz"];
/// With `--all`, meshes of at least as many faces.
const LEAST_FACES: usize = 50_000;

/// The paths with the letters that they have in tables.
const PATHS: [(&str, CameraPath); 4] = [
    ("A", CameraPath::Circle),
    ("B", CameraPath::Rotate),
    ("C", CameraPath::Zoom),
    ("D", CameraPath::Fly),
];
/// Of the picture, in pixels.
const SIZE: [u32; 2] = [800, 800];
/// Frames of a path that is walked.
const FRAMES: usize = 1000;

/// A table of some scenes.
type PrintTable = fn(&[Scene]) -> Result<(), String>;

const TABLES: [(&str, PrintTable); 5] = [
    ("faces", faces::print),
    ("bytes", bytes::print),
    ("policies", policies::print),
    ("times", times::print),
    ("budget", budget::print),
];

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut tables, mut files, mut takes_all) = (Vec::new(), Vec::new(), false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--table" => {
                let name = arguments.next().ok_or("--table needs a name")?;
                let table = TABLES.iter().find(|table| table.0 == name);
                let names = || TABLES.map(|(name, _)| name).join(", ");
                tables.push(table.ok_or_else(|| format!("--table {name}: give {}", names()))?);
            }
            "--all" => takes_all = true,
            flag if flag.starts_with("--") => return Err(format!("{flag} is not a flag")),
            _ => files.push(PathBuf::from(argument)),
        }
    }
    if tables.is_empty() {
        tables.extend(&TABLES);
    }
    let by_default = |data: &Path| match takes_all {
        true => compare::mesh_files(data),
        false => compare::named_mesh_files(data, &MESHES),
    };
    let files = compare::files_or(files, by_default)?;

    // Times are those of one thread; errors take all.
    let mut scenes = Vec::new();
    for file in &files {
        scenes.extend(Scene::open(file, if takes_all { LEAST_FACES } else { 0 })?);
    }
    for (name, print) in tables {
        println!("\n## {name}\n");
        print(&scenes)?;
    }
    Ok(())
}

/// The arithmetic mean, 0 of nothing.
fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for value in values {
        sum += value;
        count += 1.0;
    }
    sum / count.max(1.0)
}

/// The largest, 0 of nothing.
fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}
