//! The buffers of a glTF: the binary chunk, `data:` URIs and files beside it.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use super::object::{Object, malformed};
use super::uri::{decode_data, relative_path, starts_with_ignoring_case};
use crate::files::disk::Stored;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::surroundings::Surroundings;
use crate::limits::Limits;

/// Bytes that one or more buffers of the JSON stand for.
pub(super) struct Storage {
    pub(super) source: Source,
    pub(super) bytes: Vec<u8>,
    /// Whether a permutation has moved records in it.
    pub(super) is_changed: bool,
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
                                let stored = read_beside(surroundings, &relative, limits)?;
                                buffers.read_size += stored.size;
                                Ok(buffers.store(Source::External(relative), stored.bytes))
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
    pub(super) fn fix(&mut self, name: &Path, is_glb: bool, keep: &[PathBuf]) {
        for storage in &mut self.storages {
            if is_glb && storage.source != Source::Binary {
                storage.fixed = Some(OUTSIDE_OF_GLB);
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

fn read_beside(
    surroundings: Surroundings<'_>,
    relative: &Path,
    limits: &Limits,
) -> Result<Stored, Missing> {
    let read = surroundings.read(relative, limits);
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
