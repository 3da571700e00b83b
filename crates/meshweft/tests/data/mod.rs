//! Real meshes, where they are at hand.

mod folder;

use std::path::{Path, PathBuf};

use meshweft::files::Document;
use meshweft::{Limits, Mesh};

/// The folder of meshes.
pub(crate) fn meshes() -> Option<PathBuf> {
    Some(folder::folder()?.join("meshes"))
}

/// The first mesh of a file.
pub(crate) fn open(folder: &Path, name: &str) -> Mesh {
    let path = folder.join(name);
    let document = Document::open(&path, Limits::default()).unwrap();
    document.meshes()[0].mesh.clone()
}
