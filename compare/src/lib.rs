//! Rivals of meshweft, run against it: [`rivals`] calls them, [`oracle`] reads meshes without
//! meshweft's own readers.
//!
//! `cargo run --release --bin speed` times them, `--bin quality` counts their misses.

use std::path::PathBuf;

pub mod oracle;
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
pub fn mesh_files(data: &std::path::Path) -> Vec<PathBuf> {
    let folder = data.join("meshes");
    let entries = std::fs::read_dir(&folder).expect("the folder of meshes can be listed");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry of the folder of meshes").path())
        .collect();
    files.sort();
    files
}

/// A mesh's name for a row: the file name without its endings.
#[must_use]
pub fn mesh_name(file: &std::path::Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}
