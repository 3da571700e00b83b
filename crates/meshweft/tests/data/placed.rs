//! Meshes with their positions.

use std::path::Path;

use meshweft::files::Document;
use meshweft::{Limits, Mesh};

/// The first mesh of a file in the folder of meshes, with its positions.
pub(crate) fn open(folder: &Path, name: &str) -> Mesh {
    let document = Document::open(&folder.join("meshes").join(name), Limits::default()).unwrap();
    let positions = document.positions(0).unwrap().unwrap();
    Mesh::new(positions, document.meshes()[0].mesh.faces().to_vec()).unwrap()
}
