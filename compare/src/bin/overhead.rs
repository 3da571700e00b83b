//! What the program takes beyond the order itself, in processor time.
//!
//!   cargo run --release --bin overhead -- MESHWEFT FILE [ROUNDS]
//!
//! In turn, ROUNDS times (default 7), each as a process on one thread: `MESHWEFT optimize FILE -o OUT` with
//! the default order; and a caller of the library that reads FILE with `Document`, orders each mesh
//! with `Optimizer`, its vertices with `vertex_fetch`, and writes OUT. The program counts misses
//! before and after, tells whether an order is better, and reports. Printed are the medians of the user
//! time and of the ratio within a round.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, io};

use compare::process;
use compare::timing::median;
use meshweft::Limits;
use meshweft::files::{Document, Edit};
use meshweft::order::{Optimizer, vertex_fetch};

const USAGE: &str = "usage: overhead MESHWEFT FILE [ROUNDS]";
/// The first argument of the process that calls the library.
const LIBRARY: &str = "--library";

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    compare::exit_code(match arguments.as_slice() {
        [first, file, output] if first == Path::new(LIBRARY) => {
            by_library(file, output).map_err(|error| error.to_string())
        }
        [program, file] => measure(program, file, 7),
        [program, file, rounds] => match rounds.to_str().and_then(|text| text.parse().ok()) {
            Some(rounds) if rounds > 0 => measure(program, file, rounds),
            _ => Err(USAGE.into()),
        },
        _ => Err(USAGE.into()),
    })
}

/// Orders a file without counting anything.
fn by_library(file: &Path, output: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut document = Document::open(file, Limits::default())?;
    let optimizer = Optimizer::default();
    for mesh in 0..document.meshes().len() {
        let faces = document.meshes()[mesh].record_order(|mesh, polygons| {
            optimizer.face_order_with(mesh.as_faces(), polygons, &())
        });
        document.edit(Edit::order(mesh, &faces, None))?;
        let entry = &document.meshes()[mesh];
        if entry.vertices_movable {
            let vertices = vertex_fetch(entry.mesh.as_faces());
            document.edit(Edit::order(mesh, None, &vertices))?;
        }
    }
    document.write(output)?;
    Ok(())
}

fn measure(program: &Path, file: &Path, rounds: usize) -> Result<(), String> {
    let folder = env::temp_dir().join(format!("meshweft-overhead-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let output = folder.join(file.file_name().unwrap_or_default());
    let me = env::current_exe().map_err(|error| error.to_string())?;

    let (mut seconds, mut ratios) = ([const { Vec::new() }; 2], Vec::new());
    for _ in 0..rounds {
        let mut by_program = Command::new(program);
        by_program.arg("optimize").arg(file).arg("-o").arg(&output);
        by_program.args("--jobs 1 --threads 1 --quiet".split(' '));
        let mut by_library = Command::new(&me);
        by_library.arg(LIBRARY).arg(file).arg(&output);

        let mut round = [0.0; 2];
        for (side, command) in [by_program, by_library].iter_mut().enumerate() {
            let time = user_time(command).map_err(|error| error.to_string())?;
            // A file that is replaced would be waited for until it is on the disk.
            std::fs::remove_file(&output).map_err(|error| error.to_string())?;
            seconds[side].push(time);
            round[side] = time;
        }
        ratios.push(round[0] / round[1]);
    }
    let _ = std::fs::remove_dir_all(&folder);

    let [of_program, of_library] = seconds.map(median);
    println!(
        "user time of the program {of_program:.2} s, of the library alone {of_library:.2} s, ratio {:.3}; \
         {rounds} rounds",
        median(ratios)
    );
    Ok(())
}

/// The user time of a process in seconds.
fn user_time(command: &mut Command) -> io::Result<f64> {
    match process::run(command.env("RAYON_NUM_THREADS", "1"))? {
        Some(cost) => Ok(cost.user),
        None => Err(io::Error::other(format!("{command:?} has failed"))),
    }
}
