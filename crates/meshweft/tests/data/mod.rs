//! Real meshes, where they are at hand.

use std::path::{Path, PathBuf};

use meshweft::files::Document;
use meshweft::{Limits, Mesh};

/// The folder of real meshes, or `None` with a loud word.
pub(crate) fn meshes() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or(beside, PathBuf::from);
    let folder = folder.join("meshes");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
    assert!(!required, "no meshes in {}", folder.display());
    eprintln!("SKIPPED: no meshes in {}", folder.display());
    None
}

/// The first mesh of a file.
pub(crate) fn open(folder: &Path, name: &str) -> Mesh {
    let path = folder.join(name);
    let document = Document::open(&path, Limits::default()).unwrap();
    document.meshes()[0].mesh.clone()
}
