//! Where the eye goes, as it is given.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use meshweft::Limits;
use meshweft::operations::{self, Camera};

use crate::usage::Usage;

/// A path by its name among these, or the cameras of a file with the file's name.
pub(crate) fn path<P>(
    name: &str,
    shapes: impl IntoIterator<Item = (&'static str, P)>,
    given: impl FnOnce(Arc<[Camera]>) -> P,
    size: [u32; 2],
    limits: Limits,
) -> Result<(P, Option<PathBuf>)> {
    let mut names = Vec::new();
    for (shape_name, shape) in shapes {
        if shape_name == name {
            return Ok((shape, None));
        }
        names.push(shape_name);
    }
    let file = Path::new(name);
    let is_named_json = file
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("json"));
    if !is_named_json && !file.exists() {
        let names = names.join(", ");
        let told = format!("--path {name}: give {names}, or a file of cameras (.json)");
        return Err(Usage(told).into());
    }

    let cameras = of_file(file, size, limits)?;
    Ok((given(cameras.into()), Some(file.to_owned())))
}

/// One camera of a file.
pub(crate) fn of_frame(
    file: &Path,
    frame: usize,
    size: [u32; 2],
    limits: Limits,
) -> Result<Camera> {
    let all = of_file(file, size, limits)?;
    let camera = all.get(frame).ok_or_else(|| {
        let (file, last) = (file.display(), all.len() - 1);
        Usage(format!(
            "--frame {frame}: {file} has the frames 0 to {last}"
        ))
    })?;
    Ok(*camera)
}

/// The cameras of a file.
fn of_file(file: &Path, size: [u32; 2], limits: Limits) -> Result<Vec<Camera>> {
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
pub(crate) fn told(name: &str, file: Option<&Path>) -> String {
    match file {
        Some(file) => file.display().to_string(),
        None => name.to_owned(),
    }
}

/// A width and a height, such as `800x600`.
pub(crate) fn picture_size(text: &str) -> Result<[u32; 2], String> {
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
