//! What terrain refuses.

use std::fmt;
use std::path::PathBuf;

use crate::files::FileError;
use crate::lod::geometry_cache::GeometryCacheError;
use crate::lod::quad_tin::{PointsError, QuadTinError};
use crate::lod::{HierarchyError, ViewError};
use crate::operations::walks::WalkOptionError;

/// Why a terrain cannot be built, written, drawn or measured.
#[derive(Debug)]
#[non_exhaustive]
pub enum TerrainError {
    /// An option is out of its range.
    Option(WalkOptionError),
    /// A height map cannot be read, or several do not fit together.
    File(FileError),
    /// There is no surface over the points of a file.
    Points {
        /// The file.
        file: PathBuf,
        /// Why.
        error: PointsError,
    },
    /// A file of points is given together with height maps.
    Mixed {
        /// The file.
        file: PathBuf,
    },
    /// A file is neither a height map, nor has it points, nor is it a `.mwt` file.
    NoTerrain {
        /// The file.
        file: PathBuf,
    },
    /// A file without a mesh, and without points that are read.
    NoPoints {
        /// The file.
        file: PathBuf,
    },
    /// A `.mwt` file is one of several, or is to be built again.
    Built {
        /// The file.
        file: PathBuf,
    },
    /// There is nothing to draw, or too much.
    Heights {
        /// The file.
        file: PathBuf,
        /// Why.
        error: QuadTinError,
    },
    /// A `.mwt` file cannot be read, or is not sound.
    Stored {
        /// The file.
        file: PathBuf,
        /// The frame that needed what cannot be read; `None` outside of a walk.
        frame: Option<usize>,
        /// What is wrong, and at which byte.
        error: HierarchyError,
    },
    /// The coarsest surface has more faces than are asked for.
    TooFewFaces {
        /// The file.
        file: PathBuf,
        /// How many are asked for.
        asked: usize,
        /// How many the coarsest has.
        least: usize,
    },
    /// A camera sees nothing.
    View {
        /// The frame.
        frame: usize,
        /// Why.
        error: ViewError,
    },
    /// The heights to compare with are of a grid, and the terrain is over points, or the other way round.
    OtherKind {
        /// The terrain.
        file: PathBuf,
        /// Whether that is over a grid.
        is_over_grid: bool,
    },
    /// The heights to compare with are on another grid.
    OtherGrid {
        /// The terrain.
        file: PathBuf,
        /// Its columns and rows.
        size: [u32; 2],
        /// How far they are apart.
        spacing: [f64; 2],
        /// Those of the heights.
        found: ([u32; 2], [f64; 2]),
    },
    /// What was written does not give the heights back: a fault of this library, or of the disk.
    NotVerified {
        /// What was built.
        file: PathBuf,
    },
    /// The slots cannot take these vertices.
    Cache(GeometryCacheError),
}

impl fmt::Display for TerrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Option(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
            Self::NoTerrain { file } => write!(
                f,
                "{}: this is neither a height map, nor points or a mesh, nor a .mwt file: give a .hgt, .dem, .tif, .png or .pgm \
                 file, a mesh file such as .ply or .obj, or a file that `meshweft terrain build` wrote",
                file.display()
            ),
            Self::NoPoints { file } => write!(
                f,
                "{}: this file has no faces, and points without faces are read from .ply, .obj and .off files: convert it to one of these",
                file.display()
            ),
            Self::Points { file, error } => write!(f, "{}: {error}", file.display()),
            Self::Mixed { file } => write!(
                f,
                "{}: this file has points, and another one is a height map: build one terrain of height maps and another one of points",
                file.display()
            ),
            Self::Built { file } => write!(
                f,
                "{}: this is a terrain that was built already: give it alone, and not to build it again",
                file.display()
            ),
            Self::Heights { file, error } => write!(f, "{}: {error}", file.display()),
            Self::Stored { file, frame, error } => {
                write!(f, "{}: ", file.display())?;
                if let Some(frame) = frame {
                    write!(f, "frame {frame}: ")?;
                }
                error.fmt(f)
            }
            Self::TooFewFaces { file, asked, least } => write!(
                f,
                "{}: there is no surface of {asked} faces or fewer: the coarsest, with its borders and holes, has {least}, so give \
                 {least} or more",
                file.display()
            ),
            Self::View { frame, error } => write!(f, "frame {frame}: {error}"),
            Self::OtherKind { file, is_over_grid } => {
                let [own, other, give] = match is_over_grid {
                    true => ["over a grid", "points", "height maps"],
                    false => ["over points", "height maps", "points or meshes"],
                };
                write!(
                    f,
                    "{}: this terrain is {own}, and the heights to compare with are {other}: give the {give} that it was built of",
                    file.display()
                )
            }
            Self::OtherGrid {
                file,
                size: [columns, rows],
                spacing: [x, z],
                found: ([other_columns, other_rows], [other_x, other_z]),
            } => write!(
                f,
                "{}: it has {columns} by {rows} places, {x} by {z} metres apart, and the heights to compare with {other_columns} by \
                 {other_rows}, {other_x} by {other_z} metres apart: give the height maps that it was built of, with the same options",
                file.display()
            ),
            Self::NotVerified { file } => write!(
                f,
                "{}: the terrain that was written does not give its heights back, so nothing is kept. The disk may be at fault; \
                 otherwise this is a fault of meshweft: please report it with the file",
                file.display()
            ),
            Self::Cache(error) => error.fmt(f),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for TerrainError {}

impl From<WalkOptionError> for TerrainError {
    fn from(error: WalkOptionError) -> Self {
        Self::Option(error)
    }
}

impl From<FileError> for TerrainError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<GeometryCacheError> for TerrainError {
    fn from(error: GeometryCacheError) -> Self {
        Self::Cache(error)
    }
}
