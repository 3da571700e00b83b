//! What is drawn of a terrain: of heights, of which a hierarchy is made, or of a `.mwt` file, which has one.

use std::fmt;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::TerrainError;
use super::heights::{TerrainHeights, TerrainReadOptions};
use crate::files::Note;
use crate::limits::Limits;
use crate::lod::CameraView;
use crate::lod::quad_tin::{QuadTin, StreamedTin, TinLimit, TinSurface};
use crate::operations::walks::{BlockSource, is_stored, open_stored};

/// A terrain to look at from anywhere: made of height maps, or a `.mwt` file, of which only what is needed is read.
pub struct TerrainSource {
    pub(super) file: PathBuf,
    pub(super) name: String,
    pub(super) notes: Vec<(PathBuf, Note)>,
    kind: TerrainKind,
}

/// Where the hierarchy is.
enum TerrainKind {
    Whole(Box<QuadTin>),
    Stored(Box<StreamedTin<Box<dyn BlockSource>>>),
}

/// What a terrain is at full detail.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TerrainFacts {
    /// Columns and rows; `None` if it is not over a grid.
    pub grid_size: Option<[u32; 2]>,
    /// How far they are apart, in metres.
    pub grid_spacing: Option<[f64; 2]>,
    /// From west to east, in metres.
    pub width: f64,
    /// The lowest and the highest height, in metres.
    pub heights: [f32; 2],
    /// Vertices, void ones counted.
    pub vertices: usize,
    /// Faces.
    pub faces: u64,
}

impl TerrainFacts {
    pub(super) fn of(tin: &QuadTin) -> Self {
        let [west, east] = tin.horizontal_range()[0].map(f64::from);
        let grid = tin.grid_size().zip(tin.grid_spacing());
        let width = grid.map(|(size, spacing)| f64::from(size[0] - 1) * spacing[0]);
        Self {
            grid_size: tin.grid_size(),
            grid_spacing: tin.grid_spacing(),
            width: width.unwrap_or(east - west),
            heights: tin.height_range(),
            vertices: tin.vertex_count(),
            faces: tin.face_count(),
        }
    }

    pub(super) fn json(self) -> Value {
        json!({
            "columns": self.grid_size.map(|it| it[0]),
            "rows": self.grid_size.map(|it| it[1]),
            "spacing": self.grid_spacing,
            "width": self.width,
            "heights": self.heights,
            "vertices": self.vertices,
            "faces": self.faces,
        })
    }
}

impl fmt::Debug for TerrainSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TerrainSource")
            .field("file", &self.file)
            .finish_non_exhaustive()
    }
}

impl TerrainSource {
    /// A `.mwt` file, or height maps, of which the hierarchy is made. What begins as a `.mwt` file does is one, whatever its name; the
    /// options are for height maps.
    ///
    /// # Errors
    /// [`TerrainError`]: a file cannot be read, is over a limit, is not a terrain or not sound, or the files do not fit together.
    pub fn open(paths: &[PathBuf], options: &TerrainReadOptions) -> Result<Self, TerrainError> {
        match paths {
            [path] if is_stored(path, "mwt", QuadTin::begins_bytes) => {
                let limits = options.maps.limits;
                Self::stored(path, open_stored(path, limits)?, limits)
            }
            _ => Self::of_heights(TerrainHeights::open(paths, options)?),
        }
    }

    /// The hierarchy of heights.
    ///
    /// # Errors
    /// [`TerrainError`] if there are none, too many, or points on a line.
    pub fn of_heights(heights: TerrainHeights) -> Result<Self, TerrainError> {
        let file = heights.file();
        let (tin, _) = heights.tin()?;
        Ok(Self {
            file,
            name: heights.name,
            notes: heights.notes,
            kind: TerrainKind::Whole(Box::new(tin)),
        })
    }

    /// A `.mwt` file from anywhere; `path` is named in errors and in reports.
    ///
    /// # Errors
    /// [`TerrainError::Stored`] if it cannot be read, or is not sound.
    pub fn stored(
        path: &Path,
        source: impl Read + Seek + Send + Sync + 'static,
        limits: Limits,
    ) -> Result<Self, TerrainError> {
        let source: Box<dyn BlockSource> = Box::new(source);
        let tin = StreamedTin::open(source, limits).map_err(|error| TerrainError::Stored {
            file: path.to_owned(),
            frame: None,
            error,
        })?;
        Ok(Self {
            file: path.to_owned(),
            name: tin.name().to_owned(),
            notes: Vec::new(),
            kind: TerrainKind::Stored(Box::new(tin)),
        })
    }

    /// What there is of it so far.
    pub(super) fn tin(&self) -> &QuadTin {
        match &self.kind {
            TerrainKind::Whole(tin) => tin,
            TerrainKind::Stored(stored) => stored.tin(),
        }
    }

    /// How many bytes the file has, and how many were read; `None` if the hierarchy was not read from one.
    pub(super) fn bytes(&self) -> Option<[u64; 2]> {
        match &self.kind {
            TerrainKind::Whole(_) => None,
            TerrainKind::Stored(stored) => Some(stored.bytes()),
        }
    }

    /// The surface that a view needs, of limited size if that is asked for.
    pub(super) fn draw(
        &mut self,
        view: &CameraView,
        limit: Option<TinLimit>,
        frame: Option<usize>,
        surface: &mut TinSurface,
    ) -> Result<(), TerrainError> {
        let drawn = match (&mut self.kind, limit) {
            (TerrainKind::Whole(tin), None) => {
                tin.draw(view, surface);
                Ok(())
            }
            (TerrainKind::Whole(tin), Some(limit)) => {
                tin.draw_within(limit, view, surface);
                Ok(())
            }
            (TerrainKind::Stored(stored), None) => stored.draw(view, surface),
            (TerrainKind::Stored(stored), Some(limit)) => stored.draw_within(limit, view, surface),
        };
        drawn.map_err(|error| TerrainError::Stored {
            file: self.file.clone(),
            frame,
            error,
        })
    }

    /// Reads all that was not read yet.
    pub(super) fn read_fully(self) -> Result<Self, TerrainError> {
        let TerrainKind::Stored(stored) = self.kind else {
            return Ok(self);
        };
        let tin = stored.into_tin().map_err(|error| TerrainError::Stored {
            file: self.file.clone(),
            frame: None,
            error,
        })?;
        Ok(Self {
            kind: TerrainKind::Whole(Box::new(tin)),
            ..self
        })
    }
}
