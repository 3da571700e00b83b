//! All meshes at hand.

use std::path::{Path, PathBuf};

use meshweft::files::Format;

/// The files in the folder of meshes that have a format of the library, by name.
pub(crate) fn mesh_files(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<_> = std::fs::read_dir(folder.join("meshes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| Format::of_path(path).is_some())
        .collect();
    paths.sort();
    paths
}
