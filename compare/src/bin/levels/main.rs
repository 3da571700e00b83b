//! How good the rendering sequences of a progressive mesh's levels are, what of an index buffer changes, and
//! how long it takes, as Markdown.
//!
//! ```text
//! cargo run --release --bin levels -- [--times] [--walks N] [mesh files]
//! ```
//!
//! Four meshes of the test data by default. For caches of 12 and 16 vertices, orders stored at checkpoints (effort
//! `best`, ratio .8) and made as it goes (K-Cache-Reorder, ratio .9) are edited in place and compared with a fresh
//! K-Cache-Reorder at 59 levels, each of 95 % of the faces of the one before. `--times` prints times instead, of
//! one thread, `--walks` checks walks between random levels instead.

mod quality;
mod ranges;
mod times;
mod walks;

use std::path::PathBuf;
use std::process::ExitCode;

use compare::counting::Counting;
use meshweft::order::{Effort, Optimizer, vertex_fetch};
use meshweft::progressive::{Collapses, ProgressiveMesh};
use meshweft::{CacheModel, Mesh};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const MESHES: [&str; 4] = [
    "cow.off.gz",
    "mannequin.off.gz",
    "bunny.ply.gz",
    "dragon.ply.gz",
];
/// Cache sizes.
const SIZES: [u32; 2] = [12, 16];

/// A way to get orders for levels.
struct Way {
    name: &'static str,
    effort: Effort,
    ratio: f64,
}

const STORED: Way = Way {
    name: "stored",
    effort: Effort::Best,
    ratio: 0.8,
};
const MADE: Way = Way {
    name: "made",
    effort: Effort::Fast,
    ratio: 0.9,
};

impl Way {
    fn optimizer(&self, size: u32) -> Optimizer {
        Optimizer {
            effort: self.effort,
            ..Optimizer::for_cache(CacheModel::fifo(size))
        }
    }

    /// All levels down to a hundredth of the faces. The full mesh is ordered for a vertex less, as its sequence is
    /// edited too.
    fn progressive(&self, mesh: &Mesh, size: u32) -> Result<ProgressiveMesh, String> {
        let mesh = mesh.with_face_order(&self.optimizer(size - 1).face_order(mesh));
        let mesh = mesh.with_vertex_order(&vertex_fetch(&mesh));
        let settings = Collapses {
            faces: mesh.face_count() / 100,
            drop_parts: true,
            ..Collapses::default()
        };
        settings
            .build(&mesh, &[])
            .map_err(|error| error.to_string())
    }
}

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut is_timed, mut walks) = (false, None);
    let mut files = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--times" => is_timed = true,
            "--walks" => {
                let text = arguments.next().ok_or("--walks needs a number")?;
                let number: Result<u64, _> = text.parse();
                walks = Some(number.map_err(|_| format!("--walks {text}: not a number"))?);
            }
            flag if flag.starts_with("--") => return Err(format!("{flag} is not a flag")),
            _ => files.push(PathBuf::from(argument)),
        }
    }
    let files = compare::files_or(files, |data| compare::named_mesh_files(data, &MESHES))?;
    let meshes: Result<Vec<_>, String> = files
        .iter()
        .map(|file| Ok((compare::mesh_name(file), compare::read_as_one(file)?)))
        .collect();
    let meshes = meshes?;

    compare::one_thread();
    match (walks, is_timed) {
        (Some(count), _) => walks::print(&meshes, count),
        (None, true) => times::print(&meshes),
        (None, false) => {
            quality::print(&meshes)?;
            ranges::print(&meshes)
        }
    }
}
