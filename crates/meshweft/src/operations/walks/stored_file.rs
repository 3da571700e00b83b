//! Files of which only what is needed is read.

use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::Path;

use crate::files::{FileError, FileErrorKind, Place};
use crate::limits::Limits;

/// Bytes of which any part can be read.
pub(in crate::operations) trait BlockSource:
    Read + Seek + Send + Sync
{
}

impl<S: Read + Seek + Send + Sync> BlockSource for S {}

/// Whether a file has an ending, or begins as files of its kind do. Of a pipe nothing is read, as nobody else could read it then.
pub(in crate::operations) fn is_stored(
    path: &Path,
    ending: &str,
    begins: fn(&[u8]) -> bool,
) -> bool {
    let is_named = path
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case(ending));
    let mut start = Vec::new();
    let is_file = || fs::metadata(path).is_ok_and(|it| it.is_file());
    let mut read = || File::open(path)?.take(16).read_to_end(&mut start);
    is_named || is_file() && read().is_ok() && begins(&start)
}

/// Opens a file that is not over the limit.
pub(in crate::operations) fn open_stored(path: &Path, limits: Limits) -> Result<File, FileError> {
    let in_file = |kind: FileErrorKind| -> FileError { kind.at(Place::File).in_file(path, None) };
    let file = File::open(path).map_err(|error| in_file(FileErrorKind::Io(error)))?;
    let length = file.metadata();
    let length = length.map_err(|error| in_file(FileErrorKind::Io(error)))?;
    if !length.is_file() {
        let what = "this is a folder, a pipe or a device: name a file";
        return Err(in_file(FileErrorKind::Io(io::Error::other(what))));
    }
    let limit = limits.file_bytes;
    if length.len() > limit {
        let (what, found) = ("bytes", length.len());
        return Err(in_file(FileErrorKind::OverLimit { what, found, limit }));
    }
    Ok(file)
}
