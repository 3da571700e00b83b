//! Every file cut off and changed: no panic, no hang, no more memory than promised.
//!
//!   cargo run --release --bin damage -- [--cuts N] [--changes N] [--largest BYTES] [--shard I/N]
//!       [--messages] [FILE…]
//!
//! Takes each file (default: all real meshes, glTF scenes and broken files), whole, cut off at N
//! places (default 50), and with one byte changed N times (default 200), the places and bytes by a
//! fixed generator. Each is read, ordered and written as `optimize` does. A panic, more than 64 MiB
//! and 20 times the input in use at once, or more than 10 seconds is a failure; so is an error
//! without a place. `--messages` prints each kind of error message once.

use std::collections::BTreeMap;
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use compare::counting::{Counting, with_peak};
use meshweft::files::{Document, Edit, FileError, FileErrorKind, Format, Place, Surroundings};
use meshweft::order::{KCacheReorder, vertex_fetch};
use meshweft::{CacheModel, Limits, cache};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const MOST_SECONDS: f64 = 10.0;
const SPARE_BYTES: usize = 64 << 20;
const MOST_TIMES: usize = 20;

struct Options {
    cuts: usize,
    changes: usize,
    largest: usize,
    shard: (usize, usize),
    messages: bool,
    files: Vec<PathBuf>,
}

fn options() -> Option<Options> {
    let mut options = Options {
        cuts: 50,
        changes: 200,
        largest: usize::MAX,
        shard: (1, 1),
        messages: false,
        files: Vec::new(),
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--cuts" => options.cuts = arguments.next()?.parse().ok()?,
            "--changes" => options.changes = arguments.next()?.parse().ok()?,
            "--largest" => options.largest = arguments.next()?.parse().ok()?,
            "--shard" => {
                let text = arguments.next()?;
                let (index, count) = text.split_once('/')?;
                options.shard = (index.parse().ok()?, count.parse().ok()?);
            }
            "--messages" => options.messages = true,
            file if !file.starts_with('-') => options.files.push(file.into()),
            _ => return None,
        }
    }
    Some(options)
}

fn main() -> ExitCode {
    let Some(mut options) = options() else {
        eprintln!("usage: see the head of compare/src/bin/damage.rs");
        return ExitCode::from(2);
    };
    let named = std::mem::take(&mut options.files);
    options.files = match compare::files_or(named, files_of_test_data) {
        Ok(files) => files,
        Err(error) => return compare::exit_code(Err(error)),
    };
    // The text of a panic is printed with the file that caused it.
    std::panic::set_hook(Box::new(|_| {}));
    let mut tally = Tally::default();
    let (index, count) = options.shard;
    for file in options.files.iter().skip(index - 1).step_by(count) {
        damage(file, &options, &mut tally);
    }
    println!(
        "{} files, {} inputs: {} read, {} refused; {} files above {} bytes left out; most memory \
         {:.1} times the input beyond 64 MiB, longest {:.1} s",
        tally.files,
        tally.inputs,
        tally.inputs - tally.refused,
        tally.refused,
        tally.left_out,
        options.largest,
        tally.most_times,
        tally.longest
    );
    if options.messages {
        for (message, example) in &tally.messages {
            println!("{message}\n    {example}");
        }
    }
    match tally.failures {
        0 => ExitCode::SUCCESS,
        failures => {
            println!("{failures} failures");
            ExitCode::FAILURE
        }
    }
}

/// All meshes and scenes, sorted by path.
fn files_of_test_data(data: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in ["meshes", "gltf", "malformed"] {
        files_below(&data.join(folder), &mut files);
    }
    files.sort();
    files
}

fn files_below(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files_below(&path, files);
        } else if Format::of_path(&path).is_some() {
            files.push(path);
        }
    }
}

#[derive(Default)]
struct Tally {
    files: usize,
    left_out: usize,
    inputs: usize,
    refused: usize,
    failures: usize,
    most_times: f64,
    longest: f64,
    /// Each error message without its numbers, and the first with them.
    messages: BTreeMap<String, String>,
}

fn damage(file: &Path, options: &Options, tally: &mut Tally) {
    let Some(bytes) = unpacked(file) else {
        println!("{}: cannot be read", file.display());
        tally.failures += 1;
        return;
    };
    if bytes.len() > options.largest {
        tally.left_out += 1;
        return;
    }
    tally.files += 1;
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    tally.check(file, &bytes, "whole");
    for cut in 0..options.cuts {
        // Half of them near the start, where headers are.
        let bound = if cut % 2 == 0 {
            bytes.len()
        } else {
            bytes.len().min(600)
        };
        let length = random.below(bound.max(1));
        tally.check(file, &bytes[..length], &format!("cut at {length}"));
    }
    let mut changed = bytes.clone();
    for change in 0..options.changes.min(bytes.len() * 255) {
        let bound = if change % 2 == 0 {
            bytes.len()
        } else {
            bytes.len().min(600)
        };
        let place = random.below(bound);
        let byte = u8::try_from(random.below(256)).unwrap_or(0);
        changed[place] = if byte == bytes[place] { !byte } else { byte };
        let what = format!("byte {place} made {:#x}", changed[place]);
        tally.check(file, &changed, &what);
        changed[place] = bytes[place];
    }
}

fn unpacked(file: &Path) -> Option<Vec<u8>> {
    let bytes = std::fs::read(file).ok()?;
    if file.extension().is_none_or(|ending| ending != "gz") {
        return Some(bytes);
    }
    let mut unpacked = Vec::new();
    let read = flate2::read::MultiGzDecoder::new(&bytes[..]).read_to_end(&mut unpacked);
    read.ok().map(|_| unpacked)
}

impl Tally {
    fn check(&mut self, file: &Path, bytes: &[u8], what: &str) {
        self.inputs += 1;
        let start = Instant::now();
        let (result, peak) = with_peak(|| {
            let input = bytes.to_vec();
            catch_unwind(AssertUnwindSafe(|| optimize(input, file)))
        });
        let seconds = start.elapsed().as_secs_f64();
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let mut fail = |why: String| {
            self.failures += 1;
            println!("{name}, {what}: {why}");
        };
        // Buffers beside the file are input too.
        let input = bytes.len() + beside(file);
        let times = peak.saturating_sub(SPARE_BYTES) as f64 / input.max(1) as f64;
        if peak > SPARE_BYTES + MOST_TIMES * input {
            fail(format!("{peak} bytes in use for an input of {input}"));
        }
        if seconds > MOST_SECONDS {
            fail(format!("took {seconds:.1} s"));
        }
        match result {
            Err(panic) => {
                let text = panic.downcast_ref::<String>().map(String::as_str);
                let text = text.or(panic.downcast_ref::<&str>().copied());
                fail(format!("panic: {}", text.unwrap_or_default()));
            }
            Ok(Err(error)) => {
                let has_place = error.place != Place::File;
                if !has_place && !is_about_the_whole(&error) {
                    fail(format!("no place: {error}"));
                }
                self.refused += 1;
                let text = error.to_string();
                let message = text.replace(|c: char| c.is_ascii_digit(), "");
                let message = message
                    .split_once(": ")
                    .map_or("", |(_, rest)| rest)
                    .to_owned();
                self.messages.entry(message).or_insert(text);
            }
            Ok(Ok(())) => {}
        }
        self.most_times = self.most_times.max(times);
        self.longest = self.longest.max(seconds);
    }
}

/// Errors that stand for a file as a whole.
fn is_about_the_whole(error: &FileError) -> bool {
    let is_json = |problem: &str| problem.contains(" line ") && problem.contains(" column ");
    match &error.kind {
        FileErrorKind::Io(_) => true,
        // It is of another kind altogether.
        FileErrorKind::UnknownFormat => true,
        FileErrorKind::Unsupported { feature } => feature.starts_with("this is "),
        FileErrorKind::Malformed { problem } => {
            is_json(problem) || problem.starts_with("no line is an OBJ statement")
        }
        _ => false,
    }
}

/// The bytes of other files in the folder of a glTF.
fn beside(file: &Path) -> usize {
    if Format::of_path(file) != Some(Format::Gltf) {
        return 0;
    }
    let entries = file
        .parent()
        .and_then(|folder| std::fs::read_dir(folder).ok());
    let others = entries.into_iter().flatten().flatten();
    let is_buffer = |path: &Path| path.extension().is_some_and(|ending| ending == "bin");
    let others = others.filter(|entry| is_buffer(&entry.path()));
    let sizes = others
        .filter_map(|entry| entry.metadata().ok())
        .map(|data| data.len());
    usize::try_from(sizes.sum::<u64>()).unwrap_or(usize::MAX)
}

/// What `optimize` does, in memory.
fn optimize(bytes: Vec<u8>, file: &Path) -> Result<(), FileError> {
    // The name without `.gz`: these bytes are unpacked.
    let name = file.to_string_lossy();
    let path = PathBuf::from(name.strip_suffix(".gz").unwrap_or(&name));
    let Some(format) = Format::of_path(&path) else {
        return Ok(());
    };
    let beside = Surroundings::Folder(path.parent().unwrap_or(Path::new("")));
    let mut document = Document::from_bytes_in(bytes, format, &path, beside, Limits::default())?;
    let algorithm = KCacheReorder {
        cache: CacheModel::fifo(12),
        ..Default::default()
    };
    for mesh in 0..document.meshes().len() {
        let entry = &document.meshes()[mesh];
        let mut ordered = entry.clone();
        let faces = entry.record_order(|mesh, polygons| match polygons {
            Some(starts) => algorithm.polygon_order(mesh, starts),
            None => algorithm.face_order(mesh),
        });
        ordered.apply_faces(&faces);
        let misses = |entry: &meshweft::files::MeshEntry| {
            cache::misses(entry.mesh.faces(), CacheModel::fifo(12))
        };
        let _ = (misses(entry), misses(&ordered));
        let vertices = entry.vertices_movable.then(|| vertex_fetch(&ordered.mesh));
        drop(ordered);
        document.edit(Edit::order(mesh, &faces, vertices.as_ref()))?;
    }
    document.to_main_bytes()?;
    Ok(())
}

struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap_or(0) % bound
    }
}
