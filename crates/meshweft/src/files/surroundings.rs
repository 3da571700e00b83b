//! Where the files beside a document come from: a folder of the disk, or memory.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fmt, io};

use super::disk::{Stored, read_below};
use super::error::FileErrorKind;
use crate::limits::Limits;

/// Where the files beside a document come from, such as the buffers of a `.gltf`.
///
/// Such a file is asked for by the path that the document names it with: relative to the folder of the
/// document, percent-decoded, without `.` and never with `..`. [`ReadOptions::limits`] hold for each.
///
/// [`ReadOptions::limits`]: super::ReadOptions::limits
///
/// ```
/// use std::{collections::BTreeMap, path::{Path, PathBuf}};
/// use meshweft::files::{Document, Format, Surroundings};
/// use meshweft::{Limits, operations};
///
/// # let json = br#"{ "asset": { "version": "2.0" },
/// #     "buffers": [{ "uri": "./data/my%20strip.bin", "byteLength": 708 }],
/// #     "bufferViews": [{ "buffer": 0, "byteLength": 480 },
/// #         { "buffer": 0, "byteOffset": 480, "byteLength": 228 }],
/// #     "accessors": [
/// #         { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 40 },
/// #         { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 114 }],
/// #     "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }] }"#.to_vec();
/// # let corners = (0..38_u16).map(|i| i * 7 % 38).flat_map(|face| [face, face + 1, face + 2]);
/// # let strip = [vec![0; 480], corners.flat_map(u16::to_le_bytes).collect()].concat();
/// // The URI in the text is "./data/my%20strip.bin".
/// let files = BTreeMap::from([(PathBuf::from("data/my strip.bin"), strip)]);
/// let (name, beside) = (Path::new("scene.gltf"), Surroundings::Memory(&files));
/// # let text = json.clone();
/// let mut scene = Document::from_bytes_in(json, Format::Gltf, name, beside, Limits::default())?;
/// operations::optimize(&mut scene, &operations::Options::default(), &())?;
/// let ordered: BTreeMap<PathBuf, Vec<u8>> = scene.to_bytes(name)?.into_iter().collect();
/// assert_eq!(ordered.len(), 2);
/// assert_ne!(ordered[Path::new("data/my strip.bin")], files[Path::new("data/my strip.bin")]);
/// # assert_eq!(ordered[name], text);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Default)]
#[non_exhaustive]
pub enum Surroundings<'a> {
    /// There is nothing beside the document.
    #[default]
    Nothing,
    /// A folder of the disk, the one that the document stands in. A name that ends in `.gz` is
    /// decompressed. Links are followed within the folder only, and nothing but files is read.
    Folder(&'a Path),
    /// Files in memory, by their paths from the folder of the document. They are taken as they are,
    /// whatever their names end with. Nothing is looked for on a disk.
    Memory(&'a BTreeMap<PathBuf, Vec<u8>>),
}

impl<'a> Surroundings<'a> {
    /// The folder of the disk.
    pub(super) fn folder(self) -> Option<&'a Path> {
        match self {
            Self::Folder(folder) => Some(folder),
            Self::Nothing | Self::Memory(_) => None,
        }
    }

    /// Whether there is a file at this relative path.
    pub(super) fn has(self, relative: &Path) -> bool {
        match self {
            Self::Nothing => false,
            Self::Folder(folder) => folder.join(relative).is_file(),
            Self::Memory(files) => files.contains_key(relative),
        }
    }

    /// What the file at this relative path holds.
    pub(super) fn read(self, relative: &Path, limits: &Limits) -> Result<Stored, FileErrorKind> {
        self.read_start(relative, u64::MAX, limits)
    }

    /// The same; of a longer file of a disk, the first `most` bytes.
    pub(super) fn read_start(
        self,
        relative: &Path,
        most: u64,
        limits: &Limits,
    ) -> Result<Stored, FileErrorKind> {
        let absent = |text| {
            Err(FileErrorKind::Io(io::Error::new(
                io::ErrorKind::NotFound,
                text,
            )))
        };
        match self {
            Self::Nothing => absent("the document was given without surroundings"),
            Self::Folder(folder) => read_below(folder, relative, most, limits),
            Self::Memory(files) => {
                let Some(bytes) = files.get(relative) else {
                    return absent("it is not among the files in memory");
                };
                let size = check_size(bytes, limits)?;
                let bytes = bytes.clone();
                Ok(Stored {
                    bytes,
                    size,
                    is_cut: false,
                    stamp: None,
                })
            }
        }
    }
}

/// How many bytes these are, if a file may have that many.
pub(super) fn check_size(bytes: &[u8], limits: &Limits) -> Result<u64, FileErrorKind> {
    let (found, limit) = (bytes.len() as u64, limits.file_bytes);
    match found > limit {
        true => Err(FileErrorKind::OverLimit {
            what: "bytes",
            found,
            limit,
        }),
        false => Ok(found),
    }
}

/// Files are listed by name and size.
impl fmt::Debug for Surroundings<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("Nothing"),
            Self::Folder(folder) => f.debug_tuple("Folder").field(folder).finish(),
            Self::Memory(files) => {
                let sizes = files.iter().map(|(path, bytes)| (path, bytes.len()));
                f.write_str("Memory ")?;
                f.debug_map().entries(sizes).finish()
            }
        }
    }
}
