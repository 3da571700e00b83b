//! Where the eye goes, as it is given.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use meshweft::Limits;
use meshweft::operations::{self, Camera, CameraPath};

use crate::usage::Usage;

/// A path by its name, or the cameras of a file with the file's name.
pub(super) fn path(
    name: &str,
    size: [u32; 2],
    limits: Limits,
) -> Result<(CameraPath, Option<PathBuf>)> {
    let shape = CameraPath::SHAPES.into_iter().find(|it| it.name() == name);
    if let Some(shape) = shape {
        return Ok((shape, None));
    }
    let file = Path::new(name);
    let is_named_json = file
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("json"));
    if !is_named_json && !file.exists() {
        let names = CameraPath::SHAPES.map(|it| it.name()).join(", ");
        let told = format!("--path {name}: give {names}, or a file of cameras (.json)");
        return Err(Usage(told).into());
    }

    let cameras = of_file(file, size, limits)?;
    Ok((CameraPath::Given(cameras.into()), Some(file.to_owned())))
}

/// The cameras of a file.
pub(super) fn of_file(file: &Path, size: [u32; 2], limits: Limits) -> Result<Vec<Camera>> {
    let limit = limits.file_bytes;
    let mut bytes = Vec::new();
    let read = fs::File::open(file);
    let read = read.and_then(|opened| opened.take(limit.saturating_add(1)).read_to_end(&mut bytes));
    read.with_context(|| file.display().to_string())?;
    if bytes.len() as u64 > limit {
        bail!(
            "{}: more bytes than the limit of {limit}. Give fewer cameras, or allow more with --max-bytes",
            file.display()
        );
    }
    Ok(operations::cameras_from_json(file, &bytes, size)?)
}

/// What a path is called: given cameras are those of their file.
pub(super) fn told(path: &CameraPath, file: Option<&Path>) -> String {
    match file {
        Some(file) => file.display().to_string(),
        None => path.name().to_owned(),
    }
}

/// A width and a height, such as `800x600`.
pub(super) fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(width, height)| [width, height]);
    let side = |text: &str| text.parse().ok().filter(|it| (1..=65535).contains(it));
    let sides = sides.and_then(|[width, height]| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "give 1 to 65535 pixels for width and height, such as 800x600".to_owned())
}

#[cfg(test)]
mod tests {
    use super::picture_size;

    #[test]
    fn pictures_have_two_sides() {
        assert_eq!(picture_size("800x600"), Ok([800, 600]));
        for text in [
            "",
            "800",
            "800x",
            "x",
            "800x-1",
            "8x6x4",
            "99999999999x1",
            "0x5",
            "65536x5",
        ] {
            assert!(picture_size(text).is_err(), "{text}");
        }
    }
}
