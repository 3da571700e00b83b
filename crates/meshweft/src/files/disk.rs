//! The disk: files are read within limits, and written under a temporary name that is then renamed.
//!
//! A name that ends in `.gz` stands for a compressed file, on the way in and on the way out.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;

use super::content::OutputFile;
use super::error::FileErrorKind;
use crate::limits::Limits;

/// Whether a file of this name is compressed: it ends in `.gz`.
#[must_use]
pub fn is_gzip(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

/// What a file holds, on the disk or in memory.
pub(super) struct Stored {
    /// Its bytes, decompressed.
    pub(super) bytes: Vec<u8>,
    /// Its size where it stands.
    pub(super) size: u64,
}

/// The bytes of a file, or what they decompress to if its name ends in `.gz`; and its size on the
/// disk.
fn source(path: &Path) -> io::Result<(Box<dyn Read>, u64)> {
    let file = fs::File::open(path)?;
    let size = file.metadata()?.len();
    Ok(match is_gzip(path) {
        true => (
            Box::new(MultiGzDecoder::new(io::BufReader::new(file))),
            size,
        ),
        false => (Box::new(file), size),
    })
}

/// The start of a file, up to the length that `length` finds in its first bytes.
pub(super) fn read_start(
    path: &Path,
    limits: &Limits,
    length: impl Fn(&[u8]) -> u64,
) -> Result<Vec<u8>, FileErrorKind> {
    const FIRST: u64 = 64;
    let (mut source, _) = source(path).map_err(FileErrorKind::Io)?;
    let mut bytes = Vec::new();
    let mut read = |bytes: &mut Vec<u8>, limit: u64| {
        let left = limit.saturating_sub(bytes.len() as u64);
        source.by_ref().take(left).read_to_end(bytes)
    };
    read(&mut bytes, FIRST).map_err(FileErrorKind::Io)?;
    let limit = length(&bytes).min(limits.file_bytes);
    read(&mut bytes, limit).map_err(FileErrorKind::Io)?;
    Ok(bytes)
}

/// What a file holds, decompressed if its name ends in `.gz`.
pub(super) fn read_limited(path: &Path, limits: &Limits) -> Result<Stored, FileErrorKind> {
    let (mut source, size) = source(path).map_err(FileErrorKind::Io)?;
    let limit = limits.file_bytes;

    // Room for the whole file at once, and for the look whether anything follows; how much comes
    // out of a compressed one is not known.
    let expected = if is_gzip(path) { 0 } else { size };
    let room = usize::try_from(expected.min(limit)).unwrap_or(0);
    let mut bytes = Vec::with_capacity(room + 1);

    let read = source
        .by_ref()
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes);
    let found = read.map_err(
        |error| match is_gzip(path) && error.raw_os_error().is_none() {
            // Not the system but the decompressor.
            true => FileErrorKind::malformed(format!(
                "the compressed data is damaged after {} bytes of content ({error})",
                bytes.len()
            )),
            false => FileErrorKind::Io(error),
        },
    )? as u64;

    match found > limit {
        true => Err(FileErrorKind::OverLimit {
            what: "bytes or more",
            found,
            limit,
        }),
        false => Ok(Stored { bytes, size }),
    }
}

/// What the names of temporary files end with.
const TEMPORARY: &str = ".meshweft-tmp";

/// Removes temporary files in `folder` whose writer has died; those that are being written stay.
///
/// Nothing is reported: what cannot be removed does no harm.
pub fn remove_abandoned(folder: &Path) {
    for entry in fs::read_dir(spelled_out(folder))
        .into_iter()
        .flatten()
        .flatten()
    {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if !name.starts_with(b".") || !name.ends_with(TEMPORARY.as_bytes()) {
            continue;
        }
        let path = entry.path();
        // Its writer holds a lock as long as it lives.
        let is_abandoned = fs::File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if is_abandoned {
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether these are one folder, through links too where they are there.
pub(super) fn is_same_folder(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let path = spelled_out(path);
        path.canonicalize().unwrap_or_else(|_| path.to_owned())
    };
    folder(a) == folder(b)
}

/// A folder by a name that is not empty.
fn spelled_out(folder: &Path) -> &Path {
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
}

/// Writes files one after the other, with the folders that those beside `main` need; how many bytes
/// they take on the disk.
///
/// # Errors
/// What the system says, and of which file or folder.
pub(super) fn write_files(
    files: &[OutputFile<'_>],
    main: &Path,
) -> Result<u64, (PathBuf, io::Error)> {
    let mut size = 0;
    for file in files {
        // Buffers of a glTF may stand in folders below that of the main file.
        if let Some(folder) = file.path.parent().filter(|_| file.path != main) {
            fs::create_dir_all(folder).map_err(|error| (folder.to_owned(), error))?;
        }
        size += write_renamed(file).map_err(|error| (file.path.clone(), error))?;
    }
    Ok(size)
}

/// Writes to a temporary file in the same folder and renames it over `path`; how many bytes it
/// takes on the disk.
///
/// A link is followed, and a file that is replaced keeps its permissions.
fn write_renamed(output: &OutputFile<'_>) -> io::Result<u64> {
    // Two threads may write one buffer that two files share.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let path = &fs::canonicalize(&output.path).unwrap_or_else(|_| output.path.clone());
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{number}{TEMPORARY}", std::process::id()));
    let temporary = path.with_file_name(name);

    let write = || -> io::Result<u64> {
        let mut file = fs::File::create(&temporary)?;
        // Not every file system has locks; without one nobody clears up after a dead writer.
        let _ = file.lock();

        if is_gzip(path) {
            // No time stamp in the header: the same bytes in give the same bytes out.
            let mut encoder = GzEncoder::new(&mut file, Compression::default());
            (output.write)(&mut encoder)?;
            encoder.finish()?;
        } else {
            (output.write)(&mut file)?;
        }
        let size = file.metadata()?.len();

        if let Ok(replaced) = fs::metadata(path) {
            file.set_permissions(replaced.permissions())?;
            // The old bytes must not be gone before the new ones are on the disk.
            file.sync_all()?;
        }
        fs::rename(&temporary, path)?;
        Ok(size)
    };
    write().inspect_err(|_| {
        // The half-written file is of no use; the error that led here is the one to report.
        let _ = fs::remove_file(&temporary);
    })
}
