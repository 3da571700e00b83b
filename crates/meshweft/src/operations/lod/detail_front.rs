//! A front whose hierarchy is all there, or is read as it is needed.

use std::path::PathBuf;

use super::loading::load;
use super::options::LodError;
use super::source::{LodSource, SourceKind, StoredFile};
use crate::bits::DecodeError;
use crate::files::{Document, Note};
use crate::geometry::Ball;
use crate::lod::CameraView;
use crate::lod::HierarchyError;
use crate::lod::fast_mesh::Front;
use crate::lod::geometry_cache::IndexSlotsError;
use crate::progress::{PartOfWork, Progress};

/// A source whose coarsest mesh is there.
pub(super) struct LoadedFront {
    pub(super) file: PathBuf,
    pub(super) detail: DetailFront,
    /// The smallest that has all vertices in it.
    pub(super) ball: Ball,
    /// What the reader of the file leaves as it is.
    pub(super) notes: Vec<Note>,
    /// Which fraction of all work is done.
    pub(super) done: f64,
    /// Whether the caller stopped it.
    pub(super) is_stopped: bool,
}

impl LoadedFront {
    /// The front of a source.
    pub(super) fn new(source: LodSource<'_>, progress: &dyn Progress) -> Result<Self, LodError> {
        match source.kind {
            SourceKind::Document(document) => Self::of_document(document, progress),
            SourceKind::Opened(document) => Self::of_document(&document, progress),
            SourceKind::Stored(stored) => {
                let file = stored.path.clone();
                let hierarchy = stored.front.front().hierarchy();
                let ball = hierarchy.ball().filter(|_| hierarchy.face_count() > 0);
                match ball {
                    Some(ball) => Ok(Self {
                        file,
                        detail: DetailFront::Stored(stored),
                        ball,
                        notes: Vec::new(),
                        done: 0.0,
                        is_stopped: false,
                    }),
                    None => Err(LodError::NoFaces { file }),
                }
            }
        }
    }

    fn of_document(document: &Document, progress: &dyn Progress) -> Result<Self, LodError> {
        let done = 0.5;
        let part = PartOfWork::new(progress, 0.0, done);
        let loaded = load(document, &part)?;
        Ok(Self {
            file: document.path().to_owned(),
            detail: DetailFront::Whole(Box::new(Front::new(loaded.hierarchy))),
            ball: loaded.ball,
            notes: document.notes().to_vec(),
            done,
            is_stopped: part.is_stopped(),
        })
    }
}

/// The front of a walk.
pub(super) enum DetailFront {
    Whole(Box<Front>),
    Stored(Box<StoredFile>),
}

impl DetailFront {
    pub(super) fn front(&self) -> &Front {
        match self {
            Self::Whole(front) => front,
            Self::Stored(file) => file.front.front(),
        }
    }

    /// Whether the errors of vertices are known before these are active.
    pub(super) fn knows_errors(&self) -> bool {
        matches!(self, Self::Whole(_))
    }

    /// How many bytes the file has, and how many were read; `None` if the hierarchy was not read from one.
    pub(super) fn bytes(&self) -> Option<[u64; 2]> {
        match self {
            Self::Whole(_) => None,
            Self::Stored(file) => Some(file.front.bytes()),
        }
    }

    /// Makes the mesh what the view of a frame asks for.
    pub(super) fn update(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        frame: usize,
    ) -> Result<(), LodError> {
        match self {
            Self::Whole(front) => {
                front.update(view, hysteresis);
                Ok(())
            }
            Self::Stored(file) => {
                let done = file.front.update(view, hysteresis).map(|_| ());
                done.map_err(|error| stored_error(file.path.clone(), Some(frame), error))
            }
        }
    }

    /// The error of a file whose faces do not agree with its vertices: someone made it up.
    ///
    /// # Panics
    /// If the hierarchy was not read from a file.
    pub(super) fn damaged(&self, frame: usize, error: IndexSlotsError) -> LodError {
        match self {
            Self::Whole(_) => panic!("corners of faces of a front are active vertices: {error}"),
            Self::Stored(file) => {
                let length = usize::try_from(file.front.bytes()[0]).unwrap_or(usize::MAX);
                let error = HierarchyError::Decode(DecodeError::damaged(length));
                stored_error(file.path.clone(), Some(frame), error)
            }
        }
    }

    /// Makes every vertex active.
    pub(super) fn refine_fully(&mut self) -> Result<(), LodError> {
        match self {
            Self::Whole(front) => {
                front.refine_fully();
                Ok(())
            }
            Self::Stored(file) => {
                let done = file.front.refine_fully().map(|_| ());
                done.map_err(|error| stored_error(file.path.clone(), None, error))
            }
        }
    }
}

fn stored_error(file: PathBuf, frame: Option<usize>, error: HierarchyError) -> LodError {
    LodError::Stored { file, frame, error }
}
