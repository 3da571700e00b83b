//! Rivals of meshweft, run against it: [`rivals`] calls them, [`oracle`] reads meshes without
//! meshweft's own readers.
//!
//! `cargo run --release --bin speed` times them, `--bin quality` counts their misses.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use meshweft::files::Document;
use meshweft::order::{KCacheReorder, baselines, vertex_fetch};
use meshweft::{CacheModel, Limits, Mesh, cache};

pub mod clusters;
#[cfg(feature = "draco")]
pub mod codecs;
pub mod counting;
pub mod eviction;
pub mod oracle;
pub mod process;
pub mod rivals;
pub mod timing;

/// The folder of real meshes: `MESHWEFT_DATA`, else `shared/data` beside the repository.
///
/// `None` where there is no such folder, or a panic if `MESHWEFT_REQUIRE_DATA` is set: a check that
/// needs real meshes must not pass by being skipped.
///
/// # Panics
/// If the folder is missing and `MESHWEFT_REQUIRE_DATA` is set.
#[must_use]
pub fn data_folder() -> Option<PathBuf> {
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or_else(beside, PathBuf::from);
    let found = folder.join("index.tsv").is_file();
    assert!(
        found || std::env::var_os("MESHWEFT_REQUIRE_DATA").is_none(),
        "no test data in {}",
        folder.display()
    );
    found.then_some(folder)
}

/// All files in the folder of real meshes, sorted by name.
///
/// # Panics
/// If the folder cannot be listed.
#[must_use]
pub fn mesh_files(data: &Path) -> Vec<PathBuf> {
    let folder = data.join("meshes");
    let entries = std::fs::read_dir(&folder).expect("the folder of meshes can be listed");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry of the folder of meshes").path())
        .collect();
    files.sort();
    files
}

/// The five meshes of the tables where no files are named.
#[must_use]
pub fn default_mesh_files(data: &Path) -> Vec<PathBuf> {
    let names = [
        "fandisk.off.gz",
        "bunny.ply.gz",
        "horse.obj.gz",
        "nefertiti.obj.gz",
        "dragon.ply.gz",
    ];
    named_mesh_files(data, &names)
}

/// The files of these names in the folder of real meshes.
#[must_use]
pub fn named_mesh_files(data: &Path, names: &[&str]) -> Vec<PathBuf> {
    let folder = data.join("meshes");
    names.iter().map(|name| folder.join(name)).collect()
}

/// Whether it is a VRML file, which [`oracle`] does not read.
#[must_use]
pub fn is_vrml(file: &Path) -> bool {
    file.to_string_lossy().contains(".wrl")
}

/// Runs `check` on the name and the mesh of every file in the folder of real meshes, and reports past
/// the test harness how many there were, and which were skipped.
///
/// # Panics
/// As [`data_folder`], and if a mesh cannot be read.
pub fn for_each_mesh(what: &str, mut check: impl FnMut(&str, &Mesh)) {
    let (mut ran, mut skipped) = (0, Vec::new());
    if let Some(data) = data_folder() {
        for file in mesh_files(&data) {
            let name = mesh_name(&file);
            if is_vrml(&file) {
                skipped.push(name);
                continue;
            }
            let mesh = oracle::read(&file).unwrap_or_else(|error| panic!("{error}"));
            check(&name, &mesh);
            ran += 1;
        }
    }
    say(&match ran {
        0 => format!("{what}: no test data, skipped all meshes"),
        _ => format!(
            "{what}: {ran} meshes, skipped {} (VRML is not read here): {skipped:?}",
            skipped.len()
        ),
    });
}

/// Writes a line that the test harness does not capture.
pub fn say(line: &str) {
    // If stderr is closed there is nowhere to report it.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A mesh's name for a row: the file name without its endings.
#[must_use]
pub fn mesh_name(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// The folder of real meshes, or advice where there is none.
///
/// # Errors
/// If there is no such folder.
///
/// # Panics
/// As [`data_folder`].
pub fn needed_data_folder() -> Result<PathBuf, String> {
    let advice = "name mesh files, or set MESHWEFT_DATA to the folder of test data";
    data_folder().ok_or_else(|| advice.to_owned())
}

/// The files that a user named, or where there are none those that `default` finds in the folder of
/// test data.
///
/// # Errors
/// If none is named and there is no such folder.
///
/// # Panics
/// As [`data_folder`].
pub fn files_or(
    named: Vec<PathBuf>,
    default: impl FnOnce(&Path) -> Vec<PathBuf>,
) -> Result<Vec<PathBuf>, String> {
    match named.is_empty() {
        true => Ok(default(&needed_data_folder()?)),
        false => Ok(named),
    }
}

/// Each of these files read as a mesh, with its name.
///
/// # Errors
/// If one cannot be read.
pub fn read_meshes(files: &[PathBuf]) -> Result<Vec<(String, Mesh)>, String> {
    let read = |file: &PathBuf| {
        let mesh = oracle::read(file).map_err(|error| error.to_string())?;
        Ok((mesh_name(file), mesh))
    };
    files.iter().map(read).collect()
}

/// All meshes of a file as one, with its positions, by the library's own reader.
///
/// # Errors
/// If the file cannot be read, or a mesh in it has no positions.
pub fn read_as_one(file: &Path) -> Result<Mesh, String> {
    let in_file = |what: &str| format!("{}: {what}", file.display());
    let document = Document::open(file, Limits::default()).map_err(|error| error.to_string())?;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for (number, entry) in document.meshes().iter().enumerate() {
        let read = document.positions(number);
        let read = read.map_err(|error| error.to_string())?;
        let read = read.ok_or_else(|| in_file("a mesh has no positions"))?;
        let before = u32::try_from(positions.len()).map_err(|_| in_file("too many vertices"))?;
        let of_mesh = entry.mesh.faces().iter();
        faces.extend(of_mesh.map(|face| face.map(|vertex| vertex + before)));
        positions.extend(read);
    }
    Mesh::new(positions, faces).map_err(|error| in_file(&error.to_string()))
}

/// The order of the library's greedy, fast mode, for a FIFO cache.
#[must_use]
pub fn greedy(size: u32) -> KCacheReorder {
    KCacheReorder {
        cache: CacheModel::fifo(size),
        ..KCacheReorder::default()
    }
}

/// A mesh with its faces in the greedy's order, and its vertices by first use.
#[must_use]
pub fn in_greedy_order(mesh: &Mesh, size: u32) -> Mesh {
    let mesh = mesh.with_face_order(&greedy(size).face_order(mesh));
    mesh.with_vertex_order(&vertex_fetch(&mesh))
}

/// The figure that a cache is judged by: misses per vertex of a GPU, misses per face of any other.
#[must_use]
pub fn figure(faces: &[[u32; 3]], model: CacheModel) -> f64 {
    match model.is_gpu() {
        true => cache::atvr(faces, model),
        false => cache::acmr(faces, model),
    }
}

/// Prints what went wrong, if anything did.
#[must_use]
pub fn exit_code(result: Result<(), String>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

/// Runs everything from here on with one thread, as rivals do.
///
/// # Panics
/// If threads are at work already.
pub fn one_thread() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build_global().expect("no thread is at work yet");
}

/// `side` × `side` quads, each cut along a random diagonal, as a scanner might deliver them: blocks
/// of 32 × 32 quads row by row, the faces inside a block shuffled, the vertices by first use.
///
/// # Panics
/// If there are more vertices than 32 bits count.
#[must_use]
pub fn irregular_grid(side: u32) -> Mesh {
    const BLOCK: u32 = 32;
    let quad_count = side as usize * side as usize;
    // The parity of a random number: a random bit a quad.
    let random = baselines::random(quad_count, 3);
    let mut faces = Vec::with_capacity(2 * quad_count);
    let blocks = side.div_ceil(BLOCK);
    for block in 0..blocks * blocks {
        let (left, top) = (block % blocks * BLOCK, block / blocks * BLOCK);
        let mut in_block = Vec::new();
        for y in top..(top + BLOCK).min(side) {
            for x in left..(left + BLOCK).min(side) {
                let at = y * (side + 1) + x;
                let [a, b, c, d] = [at, at + 1, at + side + 1, at + side + 2];
                let flipped = random.new_to_old()[(y * side + x) as usize].is_multiple_of(2);
                in_block.extend(match flipped {
                    true => [[a, b, d], [a, d, c]],
                    false => [[a, b, c], [c, b, d]],
                });
            }
        }
        let order = baselines::random(in_block.len(), u64::from(block));
        faces.extend(order.apply(&in_block));
    }
    let vertex_count = (side as usize + 1) * (side as usize + 1);
    let in_blocks = meshweft::Faces::new(&faces, vertex_count).expect("a grid is in range");
    let by_use = meshweft::order::vertex_fetch(in_blocks);
    Mesh::connectivity_only(vertex_count, by_use.renumber(&faces)).expect("a grid is in range")
}
