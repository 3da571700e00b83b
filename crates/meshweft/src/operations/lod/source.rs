//! What has levels of detail: meshes, of which they are made, or a `.mwl` file, which has them.

use std::fmt;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};

use super::options::LodError;
use crate::files::{Document, ReadOptions};
use crate::limits::Limits;
use crate::lod::fast_mesh::{StreamedFront, VertexHierarchy};
use crate::operations::walks::{BlockSource, is_stored, open_stored};

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
        if !is_stored(path, "mwl", VertexHierarchy::begins_bytes) {
            let kind = SourceKind::Opened(Box::new(Document::open(path, options.clone())?));
            return Ok(Self { kind });
        }
        let file = open_stored(path, options.limits)?;
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
