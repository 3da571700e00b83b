//! How well a rendering sequence follows a mesh that gets coarser: misses per face of every sequence
//! update over those of a new order of the level, as Markdown.
//!
//! ```text
//! cargo run --release --bin updates -- [--cache K] [mesh files]
//! ```
//!
//! At 80, 50, 20 and 10 % of the faces, by half-edge collapses at effort `fast`, for a FIFO cache of 12
//! vertices by default. The full mesh and each level's new order are by K-Cache-Reorder for that cache. *In
//! place* is the library's own walk. The dragon of the test data by default.

use std::path::PathBuf;
use std::process::ExitCode;

use meshweft::operations::SequenceUpdate;
use meshweft::progressive::{Collapses, ProgressiveMesh, Walk};
use meshweft::{CacheModel, FaceOrder, Mesh, cache};

/// Percent of the faces.
const LEVELS: [usize; 4] = [80, 50, 20, 10];

type Figures = [f64; LEVELS.len()];

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut size, mut files) = (12, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--cache" => {
                let value = arguments.next().ok_or("--cache needs a value")?;
                let read = value.parse().ok().filter(|size| (3..=1024).contains(size));
                size = read.ok_or(format!("--cache {value}: not a number from 3 to 1024"))?;
            }
            flag if flag.starts_with("--") => return Err(format!("{flag} is not a flag")),
            _ => files.push(PathBuf::from(argument)),
        }
    }
    let dragon = |data: &_| compare::named_mesh_files(data, &["dragon.ply.gz"]);
    for file in compare::files_or(files, dragon)? {
        let mesh = compare::in_greedy_order(&compare::read_as_one(&file)?, size);
        let name = compare::mesh_name(&file);
        table(&name, &mesh, size).map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}

/// The table of a mesh: a row an update.
fn table(name: &str, mesh: &Mesh, size: u32) -> Result<(), meshweft::MeshError> {
    let settings = Collapses {
        faces: mesh.face_count() * LEVELS[LEVELS.len() - 1] / 100,
        ..Collapses::default()
    };
    let progressive = settings.build(mesh, &[])?;
    let history = progressive.history()?;
    let levels = LEVELS.map(|percent| {
        let count = mesh.face_count() * percent / 100;
        progressive.level_of_faces(count)
    });

    println!("### {name}, {} faces, K = {size}\n", mesh.face_count());
    println!("| | 80 % | 50 % | 20 % | 10 % |\n|---|--:|--:|--:|--:|");
    let [new, in_place] = ours(&progressive, levels, size);
    for update in SequenceUpdate::SHOWN {
        let mut figures = Vec::new();
        let order = FaceOrder::identity(mesh.face_count());
        update.at_levels(&history, &order, levels, |faces| {
            figures.push(acmr(faces, size));
        })?;
        print_row(update.name(), |at| figures[at] / new[at]);
    }
    print_row("in place", |at| in_place[at] / new[at]);
    print_row("new order, misses per face", |at| new[at]);
    println!();
    Ok(())
}

/// Misses per face of each level in a new order, and edited in place.
fn ours(progressive: &ProgressiveMesh, levels: [usize; LEVELS.len()], size: u32) -> [Figures; 2] {
    let mut walk = Walk::new(progressive);
    let mut figures = [[0.0; LEVELS.len()]; 2];
    let mut faces = Vec::new();
    for (at, level) in levels.into_iter().enumerate() {
        walk.go_to(level);
        walk.emit(&mut faces);
        let order = compare::greedy(size).face_order(&faces);
        figures[0][at] = acmr(&order.apply(&faces), size);
        figures[1][at] = acmr(&faces, size);
    }
    figures
}

fn acmr(faces: &[[u32; 3]], size: u32) -> f64 {
    cache::acmr(faces, CacheModel::fifo(size))
}

fn print_row(name: &str, figure: impl Fn(usize) -> f64) {
    let cells = (0..LEVELS.len()).map(|at| format!(" {:.3} |", figure(at)));
    println!("| {name} |{}", cells.collect::<String>());
}
