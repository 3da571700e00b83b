//! The buffers of a glTF: the binary chunk, `data:` URIs and files beside it.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};

use super::json::Value;
use super::object::{Object, malformed};
use super::uri::{decode_data, relative_path, starts_with_ignoring_case};
use crate::files::disk::Stored;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::links::{Stamp, real_path};
use crate::files::surroundings::Surroundings;
use crate::limits::Limits;

/// Bytes that one or more buffers of the JSON stand for.
pub(super) struct Storage {
    pub(super) source: Source,
    pub(super) bytes: Vec<u8>,
    /// Whether a permutation has moved records in it.
    pub(super) is_changed: bool,
    /// Whether its file goes on after these bytes.
    pub(super) is_cut: bool,
    /// Which file they were read from.
    pub(super) stamp: Option<Stamp>,
    /// Why nothing in it may be moved.
    pub(super) fixed: Option<&'static str>,
}

/// Where the bytes of a storage came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Source {
    /// The binary chunk of a GLB.
    Binary,
    /// A `data:` URI of this buffer.
    Data {
        /// The number of the buffer.
        buffer: usize,
        /// The URI up to and with the comma.
        prefix: String,
    },
    /// A file, by its path relative to the glTF.
    External(PathBuf),
}

/// Why a buffer has no bytes; a problem only if something needs them.
#[derive(Debug, Clone)]
enum Missing {
    NoUri,
    BadUri(String),
    Unreadable(io::ErrorKind, String),
    OverLimit {
        what: &'static str,
        found: u64,
        limit: u64,
    },
}

/// Why data of a file that goes on may not change.
const CUT: &str = "its buffer is far longer than its byteLength: cut that file to what is used";
/// How much longer than it says a file may be, beside twice as long.
const PADDING: u64 = 1 << 16;

/// Why data of a GLB may not change.
pub(super) const OUTSIDE_OF_GLB: &str = "its data is not in the binary chunk of the GLB";

/// All buffers of a file.
#[derive(Default)]
pub(super) struct Buffers {
    pub(super) storages: Vec<Storage>,
    /// The storage of each buffer of the JSON that has one.
    of_buffer: BTreeMap<usize, usize>,
    /// Why others have none, if they name something.
    missing: BTreeMap<usize, Missing>,
    /// How many buffers there are.
    count: usize,
    /// The size of all files that were read, where they stand.
    pub(super) read_size: u64,
    /// The files that were not read to their ends, as paths from the folder of the glTF.
    pub(super) unread: Vec<PathBuf>,
}

impl Buffers {
    /// Reads every buffer that can be read.
    pub(super) fn load(
        root: &Object,
        binary: Option<Vec<u8>>,
        surroundings: Surroundings<'_>,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let mut buffers = Self::default();
        let mut external = BTreeMap::new();
        let mut binary = binary;
        let lengths = external_lengths(root)?;
        for (number, buffer) in root.objects("buffers")?.enumerate() {
            let storage = match buffer?.text("uri")?.as_deref() {
                None if number == 0 && binary.is_some() => {
                    Ok(buffers.store(Source::Binary, binary.take().unwrap_or_default()))
                }
                None => Err(Missing::NoUri),
                Some(uri) if starts_with_ignoring_case(uri, "data:") => decode_data(uri)
                    .map_err(Missing::BadUri)
                    .map(|(prefix, bytes)| {
                        let prefix = prefix.to_owned();
                        buffers.store(
                            Source::Data {
                                buffer: number,
                                prefix,
                            },
                            bytes,
                        )
                    }),
                // Two buffers over one file are one storage: their bytes are the same bytes.
                Some(uri) => relative_path(uri)
                    .map_err(Missing::BadUri)
                    .and_then(|relative| {
                        external
                            .entry(relative.clone())
                            .or_insert_with(|| {
                                // What follows the bytes that are named is of no use here, and
                                // may be of any length.
                                let length = lengths.get(&relative).copied().flatten();
                                let most =
                                    length.map(|l| l.saturating_mul(2).saturating_add(PADDING));
                                let stored = read_beside(surroundings, &relative, most, limits)
                                    .inspect_err(|missing| {
                                        if matches!(missing, Missing::OverLimit { .. }) {
                                            buffers.unread.push(relative.clone());
                                        }
                                    })?;
                                if stored.is_cut {
                                    buffers.unread.push(relative.clone());
                                }
                                buffers.read_size += stored.size;
                                let storage =
                                    buffers.store(Source::External(relative), stored.bytes);
                                buffers.storages[storage].is_cut = stored.is_cut;
                                buffers.storages[storage].stamp = stored.stamp;
                                Ok(storage)
                            })
                            .clone()
                    }),
            };

            buffers.count += 1;
            match storage {
                Ok(storage) => drop(buffers.of_buffer.insert(number, storage)),
                // Nothing to remember: there may be very many of these.
                Err(Missing::NoUri) => {}
                Err(missing) => drop(buffers.missing.insert(number, missing)),
            }
        }

        // A binary chunk that no buffer names is kept as it is.
        if let Some(bytes) = binary {
            buffers.store(Source::Binary, bytes);
        }
        Ok(buffers)
    }

    /// Says which of them may not change in a file of this name, where the buffers at the paths `keep`
    /// must stay.
    pub(super) fn fix(
        &mut self,
        name: &Path,
        is_glb: bool,
        keep: &[PathBuf],
        surroundings: Surroundings<'_>,
    ) {
        // Two names for one file: a change under one would be one under the other.
        let mut named: BTreeMap<PathBuf, usize> = BTreeMap::new();
        let mut twice = BTreeSet::new();
        for (number, storage) in self.storages.iter().enumerate() {
            if let (Source::External(relative), Some(folder)) =
                (&storage.source, surroundings.folder())
                && let Some(other) = named.insert(real_path(&folder.join(relative)), number)
            {
                twice.extend([other, number]);
            }
        }

        for (number, storage) in self.storages.iter_mut().enumerate() {
            if twice.contains(&number) {
                storage.fixed = Some("its buffer is named twice, through a link: name it once");
            }
            if is_glb && storage.source != Source::Binary {
                storage.fixed = Some(OUTSIDE_OF_GLB);
            }
            if storage.is_cut {
                storage.fixed = Some(CUT);
            }
            let Source::External(relative) = &storage.source else {
                continue;
            };
            if keep.contains(&name.with_file_name(relative)) {
                storage.fixed = Some("other files read its buffer too: give this one its own");
            }
        }
    }

    pub(super) fn store(&mut self, source: Source, bytes: Vec<u8>) -> usize {
        self.storages.push(Storage {
            source,
            bytes,
            is_changed: false,
            is_cut: false,
            stamp: None,
            fixed: None,
        });
        self.storages.len() - 1
    }

    /// Adds a buffer after the last that stands for a storage.
    pub(super) fn name(&mut self, buffer: usize, storage: usize) {
        self.of_buffer.insert(buffer, storage);
        self.count += 1;
    }

    /// Undoes [`name`](Self::name).
    pub(super) fn forget_name(&mut self, buffer: usize) {
        self.of_buffer.remove(&buffer);
        self.count -= 1;
    }

    /// The storage of a buffer; `user` is the pointer to what names it.
    pub(super) fn storage_of(&self, buffer: usize, user: String) -> Result<usize, Problem> {
        if let Some(&storage) = self.of_buffer.get(&buffer) {
            return Ok(storage);
        }
        let count = self.count;
        match self.missing.get(&buffer) {
            Some(missing) => Err(missing.problem(buffer)),
            None if buffer < count => Err(Missing::NoUri.problem(buffer)),
            None => Err(malformed(
                user,
                format!("there is no buffer {buffer}: the file has {count}"),
            )),
        }
    }

    /// Whether a buffer names nothing that its bytes would be in, which is legal.
    pub(super) fn has_no_uri(&self, buffer: usize) -> bool {
        buffer < self.count
            && !self.of_buffer.contains_key(&buffer)
            && !self.missing.contains_key(&buffer)
    }

    /// The storage of a buffer, if it has bytes.
    pub(super) fn find(&self, buffer: usize) -> Option<usize> {
        self.of_buffer.get(&buffer).copied()
    }

    /// The external buffers that could not be read, and why.
    pub(super) fn unreadable(&self) -> impl Iterator<Item = (usize, String)> {
        let lost = self.missing.iter();
        lost.map(|(&buffer, missing)| (buffer, missing.problem(buffer).kind.to_string()))
    }

    /// The buffers that stand for this storage.
    pub(super) fn buffers_over(&self, storage: usize) -> impl Iterator<Item = usize> {
        let over = self.of_buffer.iter().filter(move |&(_, &of)| of == storage);
        over.map(|(&buffer, _)| buffer)
    }

    /// The bytes of a storage, for a change.
    pub(super) fn bytes_to_change(&mut self, storage: usize) -> &mut [u8] {
        let storage = &mut self.storages[storage];
        storage.is_changed = true;
        &mut storage.bytes
    }

    /// How many bytes are held in all.
    pub(super) fn byte_count(&self) -> usize {
        self.storages
            .iter()
            .map(|storage| storage.bytes.len())
            .sum()
    }
}

impl Missing {
    fn problem(&self, buffer: usize) -> Problem {
        let pointer = format!("/buffers/{buffer}/uri");
        match self {
            Self::NoUri => malformed(
                format!("/buffers/{buffer}"),
                "the buffer has no uri, and no binary chunk stands for it",
            ),
            Self::BadUri(text) => malformed(pointer, text),
            Self::Unreadable(kind, text) => {
                FileErrorKind::Io(io::Error::new(*kind, text.clone())).at(Place::Json(pointer))
            }
            Self::OverLimit { what, found, limit } => FileErrorKind::OverLimit {
                what,
                found: *found,
                limit: *limit,
            }
            .at(Place::Json(pointer)),
        }
    }
}

/// The files that the buffers of a glTF name, as paths beside it; each that is in order.
pub(super) fn external_paths(root: &Object, path: &Path) -> Result<Vec<PathBuf>, Problem> {
    let mut paths = Vec::new();
    for buffer in root.objects("buffers")? {
        let buffer = buffer?;
        let uri = buffer.text("uri")?;
        let uri = uri.filter(|uri| !starts_with_ignoring_case(uri, "data:"));
        let relative = uri.and_then(|uri| relative_path(&uri).ok());
        paths.extend(relative.map(|relative| path.with_file_name(relative)));
    }
    Ok(paths)
}

/// How many bytes of each file are named by the buffers over it; `None` where one does not say.
fn external_lengths(root: &Object) -> Result<BTreeMap<PathBuf, Option<u64>>, Problem> {
    let mut lengths = BTreeMap::new();
    for buffer in root.objects("buffers")? {
        let buffer = buffer?;
        let length = buffer.value("byteLength").and_then(Value::whole);
        let length = length.and_then(|length| u64::try_from(length).ok());
        // Data in the text may be long, and has no path.
        let uri = buffer.text("uri")?;
        let uri = uri.filter(|uri| !starts_with_ignoring_case(uri, "data:"));
        if let Some(relative) = uri.and_then(|uri| relative_path(&uri).ok()) {
            let longest = lengths.entry(relative).or_insert(Some(0));
            *longest = longest.zip(length).map(|(a, b): (u64, u64)| a.max(b));
        }
    }
    Ok(lengths)
}

fn read_beside(
    surroundings: Surroundings<'_>,
    relative: &Path,
    most: Option<u64>,
    limits: &Limits,
) -> Result<Stored, Missing> {
    let read = match most {
        Some(most) => surroundings.read_start(relative, most, limits),
        None => surroundings.read(relative, limits),
    };
    read.map_err(|kind| match kind {
        FileErrorKind::Io(error) => Missing::Unreadable(
            error.kind(),
            format!(
                "{} cannot be read ({error}). Put it beside the glTF",
                relative.display()
            ),
        ),
        FileErrorKind::OverLimit { what, found, limit } => {
            Missing::OverLimit { what, found, limit }
        }
        other => Missing::BadUri(other.to_string()),
    })
}
