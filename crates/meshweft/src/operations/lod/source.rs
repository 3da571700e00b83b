//! What has levels of detail: meshes, of which they are made, or a `.mwl` file, which has them.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

use super::options::LodError;
use crate::files::{Document, FileError, FileErrorKind, Place, ReadOptions};
use crate::limits::Limits;
use crate::lod::fast_mesh::{StreamedFront, VertexHierarchy};

/// A mesh to look at from anywhere: a document, or a `.mwl` file, of which only what is needed is read.
///
/// [`LodSource::open`] tells one from the other; a `&Document` is one by `into`.
#[derive(Debug)]
pub struct LodSource<'a> {
    pub(super) kind: SourceKind<'a>,
}

/// Where the levels of detail come from.
#[derive(Debug)]
pub(super) enum SourceKind<'a> {
    Document(&'a Document),
    Opened(Box<Document>),
    Stored(Box<StoredFile>),
}

/// A `.mwl` file of which the head and the roots are read.
pub(super) struct StoredFile {
    pub(super) path: PathBuf,
    pub(super) front: StreamedFront<Box<dyn BlockSource>>,
}

/// Bytes of which any part can be read.
pub(super) trait BlockSource: Read + Seek + Send + Sync {}

impl<S: Read + Seek + Send + Sync> BlockSource for S {}

impl fmt::Debug for StoredFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StoredFile")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl LodSource<'static> {
    /// A file of either kind. What begins as a `.mwl` file does is one, whatever its name.
    ///
    /// # Errors
    /// [`LodError::File`] if it cannot be read or is over a limit, [`LodError::Stored`] if it is a `.mwl` file, or named as one, and not
    /// sound.
    pub fn open(path: &Path, options: &ReadOptions) -> Result<Self, LodError> {
        let is_named = path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("mwl"));
        if !is_named && !begins_as_stored(path) {
            let kind = SourceKind::Opened(Box::new(Document::open(path, options.clone())?));
            return Ok(Self { kind });
        }

        let in_file =
            |kind: FileErrorKind| -> FileError { kind.at(Place::File).in_file(path, None) };
        let file = File::open(path).map_err(|error| in_file(FileErrorKind::Io(error)))?;
        let length = file.metadata();
        let length = length.map_err(|error| in_file(FileErrorKind::Io(error)))?;
        if !length.is_file() {
            let what = "this is a folder, a pipe or a device: name a file";
            return Err(in_file(FileErrorKind::Io(io::Error::other(what))).into());
        }
        let limit = options.limits.file_bytes;
        if length.len() > limit {
            let (what, found) = ("bytes", length.len());
            return Err(in_file(FileErrorKind::OverLimit { what, found, limit }).into());
        }
        Self::stored(path, file, options.limits)
    }

    /// A `.mwl` file from anywhere; `path` is named in errors and in reports.
    ///
    /// # Errors
    /// [`LodError::Stored`] if it cannot be read, or is not sound.
    pub fn stored(
        path: &Path,
        source: impl Read + Seek + Send + Sync + 'static,
        limits: Limits,
    ) -> Result<Self, LodError> {
        let source: Box<dyn BlockSource> = Box::new(source);
        let front = StreamedFront::open(source, limits).map_err(|error| LodError::Stored {
            file: path.to_owned(),
            frame: None,
            error,
        })?;
        let path = path.to_owned();
        let kind = SourceKind::Stored(Box::new(StoredFile { path, front }));
        Ok(Self { kind })
    }
}

impl<'a> From<&'a Document> for LodSource<'a> {
    fn from(document: &'a Document) -> Self {
        let kind = SourceKind::Document(document);
        Self { kind }
    }
}

/// Whether a file begins as a `.mwl` file does. Of a pipe nothing is read, as nobody else could read it then.
fn begins_as_stored(path: &Path) -> bool {
    let mut start = Vec::new();
    let is_file = fs::metadata(path).is_ok_and(|it| it.is_file());
    let read = || File::open(path)?.take(16).read_to_end(&mut start);
    is_file && { read }().is_ok() && VertexHierarchy::begins_bytes(&start)
}
