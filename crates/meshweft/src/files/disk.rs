//! The disk: files are read within limits, and written under a temporary name that is then renamed.
//!
//! A name that ends in `.gz` stands for a compressed file, on the way in and on the way out. A main file
//! is compressed if its first bytes say so.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;

use super::content::{OutputFile, OutputPlace};
use super::error::FileErrorKind;
use super::links::{Stamp, check_link, dangling, real_path, spelled_out};
use crate::limits::Limits;

/// Whether a file of this name is compressed: it ends in `.gz`.
#[must_use]
pub fn is_gzip(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

/// Opens a file, and nothing else: a pipe would be waited for, and a device may never end.
fn opened(path: &Path) -> io::Result<fs::File> {
    match fs::metadata(path)?.is_file() {
        true => fs::File::open(path),
        false => Err(io::Error::other(
            "it is not a file, but a folder, pipe or device: name a file",
        )),
    }
}

/// Whether a file holds gzip data, whatever it is called.
pub(super) fn holds_gzip(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    opened(path)?.take(2).read_to_end(&mut start)?;
    Ok(start == b"\x1f\x8b")
}

/// What a file holds, on the disk or in memory.
pub(super) struct Stored {
    /// Its bytes, decompressed.
    pub(super) bytes: Vec<u8>,
    /// Its size where it stands.
    pub(super) size: u64,
    /// Whether more of it follows, which was not asked for.
    pub(super) is_cut: bool,
    /// What tells that it has not changed since.
    pub(super) stamp: Option<Stamp>,
}

/// The bytes of a file, or what they decompress to; and its size on the disk.
fn source(path: &Path, is_gzip: bool) -> io::Result<(Box<dyn Read>, u64)> {
    let file = opened(path)?;
    let size = file.metadata()?.len();
    Ok(match is_gzip {
        true => (
            Box::new(MultiGzDecoder::new(io::BufReader::new(file))),
            size,
        ),
        false => (Box::new(file), size),
    })
}

/// What compresses files. No time stamp is in the header: the same bytes in give the same bytes out.
pub(super) fn gzip_encoder<W: io::Write>(sink: W) -> GzEncoder<W> {
    GzEncoder::new(sink, Compression::default())
}

/// The start of a file, decompressed if its name ends in `.gz`, up to the length that `length` finds in its
/// first bytes.
pub(super) fn read_start(
    path: &Path,
    limits: &Limits,
    length: impl Fn(&[u8]) -> u64,
) -> Result<Vec<u8>, FileErrorKind> {
    read_start_as(path, is_gzip(path), limits, length)
}

/// As [`read_start`], decompressed if it is `is_gzip`.
pub(super) fn read_start_as(
    path: &Path,
    is_gzip: bool,
    limits: &Limits,
    length: impl Fn(&[u8]) -> u64,
) -> Result<Vec<u8>, FileErrorKind> {
    const FIRST: u64 = 64;
    let (mut source, _) = source(path, is_gzip).map_err(FileErrorKind::Io)?;
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
    read_as(path, is_gzip(path), limits)
}

/// What a file holds, decompressed if it is `is_gzip`.
pub(super) fn read_as(
    path: &Path,
    is_gzip: bool,
    limits: &Limits,
) -> Result<Stored, FileErrorKind> {
    let stamp = Stamp::of(path);
    let (mut source, size) = source(path, is_gzip).map_err(FileErrorKind::Io)?;
    let limit = limits.file_bytes;

    // Room for the whole file at once, and for the look whether anything follows; how much comes
    // out of a compressed one is not known.
    let expected = if is_gzip { 0 } else { size };
    let room = usize::try_from(expected.min(limit)).unwrap_or(0);
    let mut bytes = Vec::with_capacity(room + 1);

    let read = source
        .by_ref()
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes);
    let found = read.map_err(|error| match is_gzip && error.raw_os_error().is_none() {
        // Not the system but the decompressor.
        true => FileErrorKind::malformed(format!(
            "the compressed data is damaged after {} bytes of content ({error})",
            bytes.len()
        )),
        false => FileErrorKind::Io(error),
    })? as u64;

    match found > limit {
        true => Err(FileErrorKind::OverLimit {
            what: "bytes or more",
            found,
            limit,
        }),
        false => Ok(Stored {
            bytes,
            size,
            is_cut: false,
            stamp,
        }),
    }
}

/// What a file in a folder or below holds, of a longer one the first `most` bytes.
///
/// # Errors
/// As [`read_limited`]; it is not a file, but for example a pipe, or a link that leads out of the folder.
pub(super) fn read_below(
    folder: &Path,
    relative: &Path,
    most: u64,
    limits: &Limits,
) -> Result<Stored, FileErrorKind> {
    let path = folder.join(relative);
    check_link(&path, folder).map_err(FileErrorKind::Io)?;
    let data = fs::metadata(&path).map_err(FileErrorKind::Io)?;
    if !data.is_file() {
        return Err(FileErrorKind::Io(io::Error::other("it is not a file")));
    }

    // How long a compressed one is, is known when it is read.
    if most < limits.file_bytes && (is_gzip(&path) || data.len() > most) {
        let start = Limits {
            file_bytes: most + 1,
            ..*limits
        };
        let mut bytes = read_start(&path, &start, |_| u64::MAX)?;
        if bytes.len() as u64 > most {
            bytes.pop();
            return Ok(Stored {
                bytes,
                size: data.len(),
                is_cut: true,
                stamp: None,
            });
        }
    }
    read_limited(&path, limits)
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
        // Its writer holds a lock as long as it lives, or is about to take it and then looks again.
        if let Ok(file) = opened(&path)
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(path);
        }
    }
}

/// Removes abandoned files where these will stand, in folders below that of `main`.
pub(super) fn remove_abandoned_below(files: impl Iterator<Item = PathBuf>, main: &Path) {
    let folder = real_path(main.parent().unwrap_or(Path::new("")));
    let folders = files.filter_map(|file| file.parent().map(real_path));
    let below = folders.filter(|below| *below != folder && below.starts_with(&folder));
    let below: BTreeSet<PathBuf> = below.collect();
    below.iter().for_each(|below| remove_abandoned(below));
}

/// The folders in a folder, sorted; links to folders are not followed.
pub(super) fn folders_of(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(spelled_out(folder)).into_iter().flatten();
    let folders = entries.flatten().filter(|entry| {
        let kind = entry.file_type();
        kind.is_ok_and(|kind| kind.is_dir())
    });
    let mut folders: Vec<PathBuf> = folders
        .map(|entry| folder.join(entry.file_name()))
        .collect();
    folders.sort();
    folders
}

/// The files of a folder, as paths that start as the folder is spelled.
pub(super) fn files_of(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(spelled_out(folder))
        .into_iter()
        .flatten()
        .flatten();
    entries
        .map(|entry| folder.join(entry.file_name()))
        .collect()
}

/// Whether a file has these bytes, decompressed if its name ends in `.gz`.
pub(super) fn holds(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    if dangling(path).is_some() {
        return Err(io::Error::other("it is a link to nothing"));
    }
    // A pipe would be waited for.
    if !fs::metadata(path)?.is_file() {
        return Ok(false);
    }
    let (mut source, size) = source(path, is_gzip(path))?;
    if !is_gzip(path) && size != bytes.len() as u64 {
        return Ok(false);
    }
    let mut piece = vec![0; 1 << 16];
    let mut rest = bytes;
    loop {
        let count = source.read(&mut piece)?;
        if count == 0 {
            return Ok(rest.is_empty());
        }
        match rest.strip_prefix(&piece[..count]) {
            Some(after) => rest = after,
            None => return Ok(false),
        }
    }
}

/// Writes the files of a document so that, whenever this ends, the main file and those that it names are
/// whole, all old or all new: all of them are written and on the disk before the first has its name, and
/// the main file, the last in the list, has it last. Where no main file was, the disk may take its time.
///
/// Folders that they need are made. How many bytes each takes on the disk.
///
/// # Errors
/// What the system says, and of which file or folder; of kind [`io::ErrorKind::AlreadyExists`] if
/// something now has a name that was free. What was there is whole then.
pub(super) fn write_files(files: &[OutputFile<'_>]) -> Result<Vec<u64>, (PathBuf, io::Error)> {
    let (Some(main), of) = (files.last(), |error, path: &Path| (path.to_owned(), error)) else {
        return Ok(Vec::new());
    };
    let is_synced = main.path.exists();

    // Links lead nowhere else.
    let folder = main.path.parent().unwrap_or(Path::new(""));
    for file in files {
        check_link(&file.path, folder).map_err(|error| of(error, &file.path))?;
    }

    // All bytes, under temporary names.
    let mut written = Vec::new();
    let mut sizes = Vec::new();
    for file in files {
        if file.place == OutputPlace::Occupied {
            sizes.push(fs::metadata(&file.path).map_or(0, |data| data.len()));
            continue;
        }
        if let Some(folder) = file.path.parent() {
            fs::create_dir_all(spelled_out(folder)).map_err(|error| of(error, folder))?;
        }
        let new = Temporary::new(file, is_synced).map_err(|error| of(error, &file.path))?;
        sizes.push(new.size);
        written.push((file, new));
    }

    // Their names.
    for (file, new) in written {
        // What the main file names must have its name before.
        if is_synced && std::ptr::eq(file, main) {
            sync_folders(files);
        }
        let named = new.rename(file.place == OutputPlace::Free);
        named.map_err(|error| of(error, &file.path))?;
    }
    if is_synced {
        sync_folders(&files[files.len() - 1..]);
    }
    Ok(sizes)
}

/// Copies a file as it is, so that whenever this ends, `to` is all old or all new; its size. With `is_free`,
/// nothing is replaced.
///
/// # Errors
/// What the system says.
pub(super) fn copy_file(from: &Path, to: &Path, is_free: bool) -> io::Result<u64> {
    check_link(to, to.parent().unwrap_or(Path::new("")))?;
    let new = Temporary::copy(from, to)?;
    let size = new.size;
    new.rename(is_free)?;
    Ok(size)
}

/// What became of a file that was to take a free name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Claim {
    Done,
    /// Something has that name.
    Taken,
}

/// Copies a file as it is to a name that nothing has, in a folder that is made.
///
/// # Errors
/// What the system says.
pub(super) fn copy_new(from: &Path, to: &Path) -> io::Result<Claim> {
    match Temporary::copy(from, to)?.rename(true) {
        Ok(()) => Ok(Claim::Done),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(Claim::Taken),
        Err(error) => Err(error),
    }
}

/// Whether two files have the same bytes, as they stand there.
pub(super) fn is_same_content(a: &Path, b: &Path) -> io::Result<bool> {
    let (data_a, data_b) = (fs::metadata(a)?, fs::metadata(b)?);
    if !data_a.is_file() || !data_b.is_file() || data_a.len() != data_b.len() {
        return Ok(false);
    }
    let open = |path: &Path| Ok::<_, io::Error>(io::BufReader::new(fs::File::open(path)?));
    let (mut a, mut b) = (open(a)?, open(b)?);
    loop {
        let (left, right) = (a.fill_buf()?, b.fill_buf()?);
        let count = left.len().min(right.len());
        if count == 0 || left[..count] != right[..count] {
            return Ok(left.is_empty() && right.is_empty());
        }
        a.consume(count);
        b.consume(count);
    }
}

/// Makes the names of files last. Systems without a way to do this do it on their own.
fn sync_folders(files: &[OutputFile<'_>]) {
    let folders: BTreeSet<&Path> = files.iter().filter_map(|file| file.path.parent()).collect();
    for folder in folders {
        if let Ok(folder) = fs::File::open(spelled_out(folder)) {
            let _ = folder.sync_all();
        }
    }
}

/// Removes files that nothing needs any more; what cannot be removed does no harm.
pub(super) fn remove(files: &[PathBuf]) {
    for file in files {
        let _ = fs::remove_file(file);
    }
}

/// A file with all its bytes on the disk that does not have its name yet; without it, it goes away.
struct Temporary {
    path: PathBuf,
    target: PathBuf,
    size: u64,
    /// Locked as long as it is needed.
    file: fs::File,
}

/// Most names that are tried for one temporary file.
const MOST_NAMES: u32 = 1 << 10;

/// The name of a file, or where it is long the start of it, so that more can be added to it.
fn start_of_name(target: &Path) -> OsString {
    let name = target.file_name().unwrap_or_default();
    match name.to_str() {
        Some(name) if name.len() > 100 => {
            let end = (0..=100).rev().find(|&end| name.is_char_boundary(end));
            name[..end.unwrap_or(0)].into()
        }
        Some(_) => name.to_owned(),
        None if name.len() > 100 => OsString::from("mesh"),
        None => name.to_owned(),
    }
}

impl Temporary {
    /// Writes a file; with `is_synced`, its bytes are on the disk then.
    fn new(output: &OutputFile<'_>, is_synced: bool) -> io::Result<Self> {
        let mut new = Self::empty(&output.path)?;
        if is_gzip(&new.target) {
            let mut encoder = gzip_encoder(&mut new.file);
            (output.write)(&mut encoder)?;
            encoder.finish()?;
        } else {
            (output.write)(&mut new.file)?;
        }
        new.finish(is_synced)?;
        Ok(new)
    }

    /// A file with the bytes of another.
    fn copy(from: &Path, target: &Path) -> io::Result<Self> {
        if let Some(folder) = target.parent() {
            fs::create_dir_all(spelled_out(folder))?;
        }
        let mut source = fs::File::open(from)?;
        let mut new = Self::empty(target)?;
        io::copy(&mut source, &mut new.file)?;
        new.finish(target.exists())?;
        Ok(new)
    }

    /// A file without bytes in the folder of its target. A link is followed.
    fn empty(target: &Path) -> io::Result<Self> {
        // Two threads may write one file.
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        let mut tries = 0;
        let (path, file) = loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let mut name = OsString::from(".");
            name.push(start_of_name(&target));
            name.push(format!(".{}-{number}{TEMPORARY}", std::process::id()));
            let path = target.with_file_name(name);

            // Two processes may have one number, in containers or on two machines: what is there is of
            // another one.
            let created = fs::OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&path);
            let file = match created {
                Err(error)
                    if error.kind() == io::ErrorKind::AlreadyExists && tries < MOST_NAMES =>
                {
                    tries += 1;
                    continue;
                }
                created => created?,
            };
            // Not every file system has locks; without one nobody clears up after a dead writer.
            let _ = file.lock();
            // Before it was locked, somebody may have taken it for abandoned.
            tries += 1;
            if path.exists() || tries >= MOST_NAMES {
                break (path, file);
            }
        };

        // What others may not read, they may not read on the way either.
        if let Ok(replaced) = fs::metadata(&target)
            && !replaced.permissions().readonly()
        {
            file.set_permissions(replaced.permissions())?;
        }
        Ok(Self {
            path,
            target,
            size: 0,
            file,
        })
    }

    /// All its bytes are written. A file that is replaced keeps its permissions.
    fn finish(&mut self, is_synced: bool) -> io::Result<()> {
        self.size = self.file.metadata()?.len();
        if let Ok(replaced) = fs::metadata(&self.target) {
            self.file.set_permissions(replaced.permissions())?;
        }
        if is_synced {
            self.file.sync_all()?;
        }
        Ok(())
    }

    /// Gives it its name; with `is_free`, only if nothing has it.
    fn rename(self, is_free: bool) -> io::Result<()> {
        if !is_free {
            return fs::rename(&self.path, &self.target);
        }
        // A second name replaces nothing, and appears whole. The first one goes when this is dropped.
        match fs::hard_link(&self.path, &self.target) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {}
            done => return done,
        }
        // Without second names on this file system, it is taken first, and then replaced.
        fs::OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&self.target)?;
        fs::rename(&self.path, &self.target).inspect_err(|_| {
            let _ = fs::remove_file(&self.target);
        })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After the rename there is nothing of this name.
        let _ = fs::remove_file(&self.path);
    }
}
