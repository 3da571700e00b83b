//! The papers' meshes among the user's files.

use std::path::{Path, PathBuf};

use anyhow::{Error, Result, anyhow};
use meshweft::files::Document;
use meshweft::{Limits, Mesh};

/// Meshes above this many faces are large: they are left out where each takes many runs.
pub(super) const LARGE: usize = 200_000;

/// The first file with one of these names, there or in a folder `meshes`.
pub(super) fn find(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    let folders = [folder.to_owned(), folder.join("meshes")];
    let names = names.iter().flat_map(|name| {
        let endings = ["off", "ply", "obj", "glb", "gltf"].into_iter();
        endings.flat_map(move |e| [format!("{name}.{e}"), format!("{name}.{e}.gz")])
    });
    let mut paths = names.flat_map(|name| folders.each_ref().map(|f| f.join(&name)));
    paths.find(|path| path.is_file())
}

/// The name of a file without endings.
pub(super) fn stem(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// The largest mesh of that file, with its positions if it has any.
pub(super) fn open(folder: &Path, names: &[&str]) -> Result<Option<(PathBuf, Mesh)>> {
    let Some(file) = find(folder, names) else {
        return Ok(None);
    };
    let document = Document::open(&file, Limits::default())?;
    let meshes = document.meshes().iter().enumerate();
    let meshes = meshes.filter(|(_, it)| it.level.is_none());
    let Some((number, largest)) = meshes.max_by_key(|(_, it)| it.mesh.face_count()) else {
        return Ok(None);
    };
    let mesh = match document.positions(number)? {
        Some(positions) => Mesh::new(positions, largest.mesh.faces())?,
        None => largest.mesh.clone(),
    };
    Ok(Some((file, mesh)))
}

/// Says that the folder has none of a paper's meshes, and how they are looked for.
pub(super) fn none_found(folder: &Path) -> Error {
    none_like(folder, "bunny.ply, horse.obj or fandisk.off")
}

/// The same for a paper with other meshes.
pub(super) fn none_like(folder: &Path, examples: &str) -> Error {
    anyhow!(
        "{}: none of the paper's meshes is here. Files are looked for by name, such as {examples}, optionally \
         followed by .gz, and in a folder `meshes`",
        folder.display()
    )
}
