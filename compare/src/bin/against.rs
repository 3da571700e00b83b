//! What files cost in two builds of the program: processor time and memory, in turn.
//!
//!   cargo run --release --bin against -- OLD NEW [ROUNDS [FILE …]]
//!
//! `compare/files-against REVISION` builds both and runs this.
//!
//! A run is the process `meshweft optimize FILE -o OUTPUT --cache fifo:12` on one thread: it reads the
//! file, orders it for the target that takes the least time, moves the records and writes a new file.
//! What it costs is the processor time of the process, the system's for it included, and the most memory
//! that it had resident. The order is a third of the time at most, and the start of the process a few
//! milliseconds.
//!
//! Each file is run by OLD and NEW, ROUNDS times in turn (default 7), first one first and then the other.
//! Without files these are the meshes and scenes of the test data, unpacked, five of them gzipped, and
//! the STL files, which are all binary, as text too.
//!
//! For each format and for all, a row has: the time of OLD over that of NEW, which is how fast NEW is
//! beside OLD, for all files in a round and of these the median; the sum of the medians of peak memory,
//! NEW over OLD; and the file whose peak grew most. A process that does nothing has some megabytes,
//! its own code among them.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use compare::process;
use compare::timing::median;
use flate2::read::MultiGzDecoder;
use meshweft::files::Format;

const USAGE: &str = "usage: against OLD NEW [ROUNDS [FILE …]]";

fn main() -> ExitCode {
    let folder = std::env::temp_dir().join(format!("meshweft-against-{}", std::process::id()));
    let done = std::fs::create_dir_all(&folder)
        .map_err(|error| error.to_string())
        .and_then(|()| measure(&folder));
    // A measurement that failed is what to report, not the folder it leaves.
    let _ = std::fs::remove_dir_all(&folder);
    compare::exit_code(done)
}

fn measure(folder: &Path) -> Result<(), String> {
    let mut words = std::env::args_os().skip(1);
    let programs = [words.next(), words.next()].map(|word| word.map(PathBuf::from));
    let [Some(old), Some(new)] = programs else {
        return Err(USAGE.into());
    };
    let rounds = match words.next() {
        Some(word) => word.to_str().and_then(|word| word.parse().ok()),
        None => Some(7),
    };
    let rounds: usize = rounds.filter(|&rounds| rounds > 0).ok_or(USAGE)?;
    let mut files: Vec<PathBuf> = words.map(PathBuf::from).collect();
    if files.is_empty() {
        files = files_of_test_data(folder)?;
    }

    let mut formats: BTreeMap<String, Vec<Measured>> = BTreeMap::new();
    let mut refused = 0;
    for file in files {
        match measured([&old, &new], &file, rounds, folder)? {
            Some(it) => formats.entry(format_name(&file)?).or_default().push(it),
            None => refused += 1,
        }
    }

    println!("| format | files | MB | s, old | speed, new / old | peak, new / old | most |");
    println!("|---|--:|--:|--:|--:|--:|---|");
    for (format, measured) in &formats {
        print_row(format, measured.iter(), rounds);
    }
    print_row("all", formats.values().flatten(), rounds);
    println!("\n{rounds} rounds; {refused} files left out that both builds refuse.");
    Ok(())
}

/// Meshes and scenes, small to large: gzipped ones unpacked into the folder, and five as they are.
fn files_of_test_data(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let data = compare::needed_data_folder()?;
    let mut files = Vec::new();
    list(&data.join("gltf"), &mut files).map_err(|error| error.to_string())?;
    for file in compare::mesh_files(&data) {
        files.push(unpacked(&file, folder).map_err(|error| error.to_string())?);
    }
    files.sort();
    files.retain(|file| Format::of_path(file).is_some());
    for at in 0..files.len() {
        if files[at].extension().is_some_and(|ending| ending == "stl") {
            files.push(stl_as_text(&files[at], folder).map_err(|error| error.to_string())?);
        }
    }
    files.extend(compare::default_mesh_files(&data));
    Ok(files)
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        match path.is_dir() {
            true => list(&path, files)?,
            false => files.push(path),
        }
    }
    Ok(())
}

/// The file itself, or what a gzipped one holds, in a file of its own.
fn unpacked(file: &Path, folder: &Path) -> io::Result<PathBuf> {
    if !is_gzipped(file) {
        return Ok(file.into());
    }
    let path = folder.join(file.file_stem().unwrap_or_default());
    let mut content = MultiGzDecoder::new(BufReader::new(File::open(file)?));
    // Piece by piece: the peak of a child starts with that of this process.
    io::copy(&mut content, &mut File::create(&path)?)?;
    Ok(path)
}

fn is_gzipped(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending == "gz")
}

/// A text file with the facets of a binary STL file.
fn stl_as_text(file: &Path, folder: &Path) -> io::Result<PathBuf> {
    let mut path = folder.join(file.file_stem().unwrap_or_default());
    path.as_mut_os_string().push("_text.stl");
    let mut text = BufWriter::new(File::create(&path)?);
    let mut binary = BufReader::new(File::open(file)?);
    binary.read_exact(&mut [0; 84])?;
    writeln!(text, "solid")?;
    let mut facet = [0; 50];
    while binary.read_exact(&mut facet).is_ok() {
        let (numbers, _) = facet.as_chunks();
        let numbers: Vec<f32> = numbers.iter().map(|&n| f32::from_le_bytes(n)).collect();
        let vector = |at: usize| format!("{} {} {}", numbers[at], numbers[at + 1], numbers[at + 2]);
        writeln!(text, "facet normal {}\nouter loop", vector(0))?;
        for corner in 1..4 {
            writeln!(text, "vertex {}", vector(3 * corner))?;
        }
        writeln!(text, "endloop\nendfacet")?;
    }
    writeln!(text, "endsolid")?;
    text.flush()?;
    Ok(path)
}

/// The format for a row: text and binary files of one ending differ in their cost.
fn format_name(file: &Path) -> Result<String, String> {
    if is_gzipped(file) {
        return Ok("gzipped".into());
    }
    let ending = file.extension().unwrap_or_default().to_string_lossy();
    let ending = ending.to_lowercase();
    if !matches!(ending.as_str(), "ply" | "stl") {
        return Ok(ending);
    }
    let mut start = Vec::new();
    let opened = File::open(file).and_then(|file| file.take(1024).read_to_end(&mut start));
    opened.map_err(|error| format!("{}: {error}", file.display()))?;
    // A binary STL may start with the word of a text, but its numbers are not text.
    let is_text = match ending.as_str() {
        "ply" => start.windows(12).any(|words| words == b"format ascii"),
        _ => start.starts_with(b"solid") && start.is_ascii() && !start.contains(&0),
    };
    Ok(format!(
        "{ending}, {}",
        if is_text { "text" } else { "binary" }
    ))
}

/// What one file cost, for OLD and NEW.
struct Measured {
    name: String,
    bytes: u64,
    /// Seconds of each round.
    seconds: [Vec<f64>; 2],
    /// Median of the peaks, in kilobytes.
    peak: [f64; 2],
}

/// Runs both programs on the file in turn. `None` if both refuse it.
fn measured(
    programs: [&Path; 2],
    file: &Path,
    rounds: usize,
    folder: &Path,
) -> Result<Option<Measured>, String> {
    let fault = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
    let output = folder.join("output");
    let mut seconds = [const { Vec::new() }; 2];
    let mut peaks = [const { Vec::new() }; 2];
    let mut refused = [0; 2];
    for round in 0..rounds {
        for side in [round % 2, 1 - round % 2] {
            std::fs::create_dir(&output).map_err(|error| fault(&error))?;
            let path = output.join(file.file_name().unwrap_or_default());
            let cost = run(programs[side], file, &path).map_err(|error| fault(&error))?;
            // A file that is replaced would be waited for until it is on the disk.
            std::fs::remove_dir_all(&output).map_err(|error| fault(&error))?;
            match cost {
                Some((time, peak)) => {
                    seconds[side].push(time);
                    peaks[side].push(peak);
                }
                None => refused[side] += 1,
            }
        }
        match refused {
            [0, 0] => {}
            [1, 1] => return Ok(None),
            _ => return Err(fault(&"one of the builds refuses it")),
        }
    }
    Ok(Some(Measured {
        name: file.file_name().unwrap_or_default().display().to_string(),
        bytes: file.metadata().map_err(|error| fault(&error))?.len(),
        seconds,
        peak: peaks.map(median),
    }))
}

/// Processor seconds and peak kilobytes of one run; `None` if it does not end well.
fn run(program: &Path, input: &Path, output: &Path) -> io::Result<Option<(f64, f64)>> {
    let mut command = Command::new(program);
    command.arg("optimize").arg(input).arg("-o").arg(output);
    command.args("--cache fifo:12 --jobs 1 --threads 1 --quiet".split(' '));
    let cost = process::run(&mut command)?;
    Ok(cost.map(|cost| (cost.user + cost.system, cost.peak)))
}

fn print_row<'a>(format: &str, files: impl Iterator<Item = &'a Measured> + Clone, rounds: usize) {
    let sum = |figure: &dyn Fn(&Measured) -> f64| files.clone().map(figure).sum::<f64>();
    let of_round = |side: usize, round: usize| sum(&|it| it.seconds[side][round]);
    let old = median((0..rounds).map(|round| of_round(0, round)).collect());
    let speeds = (0..rounds).map(|round| of_round(0, round) / of_round(1, round));
    let peak = sum(&|it| it.peak[1]) / sum(&|it| it.peak[0]);
    let growth = |it: &Measured| it.peak[1] / it.peak[0];
    let most = files.clone().max_by(|a, b| growth(a).total_cmp(&growth(b)));
    println!(
        "| {format} | {} | {:.1} | {old:.3} | {:.3} | {peak:.3} | {} |",
        files.clone().count(),
        sum(&|it| it.bytes as f64) / 1e6,
        median(speeds.collect()),
        most.map_or_else(String::new, |it| {
            let [old, new] = it.peak.map(|kilobytes| kilobytes / 1e3);
            format!("{:.3}, {old:.1} to {new:.1} MB, {}", growth(it), it.name)
        }),
    );
}
