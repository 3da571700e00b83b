//! Compression of meshes against Draco's and meshoptimizer's, as Markdown: size, time, and the order in which faces
//! come out.
//!
//! ```text
//! cargo run --release --features draco --bin compress -- [--repetitions N] [--only TEXT]... [mesh files]
//! ```
//!
//! Without files it takes every file of the test data that the library reads with more than 1,000 faces. `--only`
//! leaves out the codecs whose name has none of the texts. Every mesh is decoded and compared with what was
//! encoded; where a codec that should be exact is not, the run fails. One thread.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use compare::codecs::{self, Input, POSITION_BITS};

mod measure;
mod summary;

use summary::Summary;

/// Below, Draco does not use the coder of faces that its level names.
const FEWEST_FACES: usize = 1000;

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

/// What the user asked for.
struct Arguments {
    repetitions: Option<usize>,
    only: Vec<String>,
    files: Vec<PathBuf>,
}

fn run() -> Result<(), String> {
    let arguments = arguments()?;
    let mut codecs = codecs::all();
    if !arguments.only.is_empty() {
        codecs.retain(|codec| {
            arguments
                .only
                .iter()
                .any(|text| codec.name().contains(text))
        });
    }
    println!(
        "Draco {}, positions of {POSITION_BITS} bits.\n",
        codecs::draco::version()
    );
    measure::print_head();

    // The rows.
    let mut summary = Summary::default();
    let is_named = !arguments.files.is_empty();
    let root = if is_named {
        PathBuf::new()
    } else {
        compare::needed_data_folder()?
    };
    let files = if is_named {
        arguments.files
    } else {
        files_below(&root)?
    };
    let (mut unreadable, mut small) = (0, 0);
    for file in &files {
        let input = match Input::read(file) {
            Ok(input) => input,
            Err(error) if is_named => return Err(error),
            Err(_) => {
                unreadable += 1;
                continue;
            }
        };
        if !is_named && input.faces.len() <= FEWEST_FACES {
            small += 1;
            continue;
        }
        let name = name_of(file, &root);
        let rows = measure::rows(&name, &input, &codecs, arguments.repetitions)?;
        measure::print_rows(&name, &input, &rows);
        summary.add(&name, &input, rows);
    }
    if !is_named {
        println!(
            "\nLeft out: {small} files of up to {FEWEST_FACES} faces, {unreadable} that are not read as meshes with positions."
        );
    }

    // What they say together.
    measure::print_legend();
    summary.print();
    summary.checked()
}

fn arguments() -> Result<Arguments, String> {
    let mut parsed = Arguments {
        repetitions: None,
        only: Vec::new(),
        files: Vec::new(),
    };
    let mut rest = std::env::args().skip(1);
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--repetitions" => {
                let number = rest.next().and_then(|text| text.parse().ok());
                parsed.repetitions = Some(number.ok_or("--repetitions needs a number")?);
            }
            "--only" => parsed.only.push(rest.next().ok_or("--only needs a text")?),
            _ => parsed.files.push(PathBuf::from(argument)),
        }
    }
    Ok(parsed)
}

/// All files of a folder and the folders in it, sorted.
fn files_below(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let in_folder = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(in_folder)? {
        paths.push(entry.map_err(in_folder)?.path());
    }
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        match path.is_dir() {
            true => files.extend(files_below(&path)?),
            false => files.push(path),
        }
    }
    Ok(files)
}

/// A mesh's name for a row: with its folder if that is not the usual one.
fn name_of(file: &Path, root: &Path) -> String {
    let name = compare::mesh_name(file);
    let folder = file.strip_prefix(root).ok().and_then(Path::parent);
    match folder {
        Some(folder) if folder != Path::new("meshes") && !root.as_os_str().is_empty() => {
            folder.join(name).display().to_string()
        }
        _ => name,
    }
}
