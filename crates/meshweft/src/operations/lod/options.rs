//! The options of a walk, and the errors of all work with levels of detail.

use std::fmt;
use std::path::PathBuf;

use super::paths::CameraPath;
use crate::attribute::AttributeInfo;
use crate::error::MeshError;
use crate::files::FileError;
use crate::geometry::Ball;
use crate::lod::HierarchyError;
use crate::lod::geometry_cache::{EvictionPolicy, GeometryCacheError};
use crate::lod::{CameraView, ViewError};
use crate::operations::losses;
use crate::operations::walks::{WalkNumbers, WalkOptionError};

/// How a mesh is walked around.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LodWalkOptions {
    /// Where the eye goes.
    pub path: CameraPath,
    /// The file that the cameras of a given path are from, for the report.
    pub camera_file: Option<PathBuf>,
    /// How many frames: 1000, or all cameras that are given, if not said.
    pub frames: Option<usize>,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// How many pixels the surface may be off.
    pub tolerance: f64,
    /// A vertex stays until its error is this part of the tolerance: above 0, and 1 for never longer than needed.
    pub hysteresis: f64,
    /// How many slots the vertex buffer has.
    pub slots: usize,
    /// Which slot the next vertex takes.
    pub policy: EvictionPolicy,
    /// Draw a frame of more vertices than slots in passes; it is streamed otherwise.
    pub passes: bool,
    /// How many bytes a vertex has.
    pub vertex_size: usize,
    /// Find the fewest inserts that any policy needs.
    pub optimum: bool,
}

impl Default for LodWalkOptions {
    /// As in the paper: a picture of 800 by 800, 1.5 pixels, 65,536 slots, 36 bytes a vertex. No hysteresis; the finest detail
    /// leaves first.
    fn default() -> Self {
        Self {
            path: CameraPath::default(),
            camera_file: None,
            frames: None,
            size: [800, 800],
            tolerance: 1.5,
            hysteresis: 1.0,
            slots: 65_536,
            policy: EvictionPolicy::default(),
            passes: false,
            vertex_size: 36,
            optimum: false,
        }
    }
}

impl LodWalkOptions {
    /// What the camera of a frame of `count` sees; `ball` has the mesh in it.
    pub(super) fn view(
        &self,
        ball: Ball,
        number: usize,
        count: usize,
    ) -> Result<CameraView, LodError> {
        let camera = self.path.camera(ball, number, count, self.size);
        let view = camera.view(self.tolerance);
        view.map_err(|error| LodError::View {
            frame: number,
            error,
        })
    }

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let cameras = match &self.path {
            CameraPath::Given(cameras) => Some(cameras.len()),
            _ => None,
        };
        let numbers = WalkNumbers {
            frames: self.frames,
            cameras,
            size: self.size,
            tolerance: self.tolerance,
            slots: self.slots,
            policy: self.policy,
            passes: self.passes,
            vertex_size: self.vertex_size,
        };
        numbers.check()?;
        match self.hysteresis > 0.0 && self.hysteresis <= 1.0 {
            true => Ok(()),
            false => Err(WalkOptionError {
                option: "hysteresis",
                found: self.hysteresis.to_string(),
                allowed: "a part of the tolerance, above 0 and at most 1".to_owned(),
            }),
        }
    }
}

/// Why a mesh cannot be made into a `.mwl` file, taken from one, walked around or measured.
#[derive(Debug)]
#[non_exhaustive]
pub enum LodError {
    /// An option is out of its range.
    Option(WalkOptionError),
    /// The document has no faces with three different corners.
    NoFaces {
        /// The file.
        file: PathBuf,
    },
    /// A mesh has no positions of three numbers, or not for all vertices.
    NoPositions {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// A face is at a position that is not finite.
    NotFinite {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// All meshes together are too large, or not sound.
    Mesh {
        /// The file.
        file: PathBuf,
        /// Why.
        error: MeshError,
    },
    /// A camera sees nothing.
    View {
        /// The frame.
        frame: usize,
        /// Why.
        error: ViewError,
    },
    /// The file holds what a `.mwl` file cannot.
    Losses {
        /// The file.
        file: PathBuf,
        /// What meshes store, by mesh.
        attributes: Vec<(String, Vec<AttributeInfo>)>,
        /// What else there is, in the words of the format.
        others: Vec<String>,
    },
    /// A mesh has faces that were not read.
    UnreadFaces {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// A file is longer than is allowed.
    TooLong {
        /// The file.
        file: PathBuf,
        /// Its length.
        bytes: u64,
        /// What is allowed.
        limit: u64,
    },
    /// The coarsest mesh of a file has more vertices than are asked for.
    TooFewVertices {
        /// The file.
        file: PathBuf,
        /// How many are asked for.
        asked: usize,
        /// How many the coarsest mesh has.
        least: usize,
    },
    /// What was made does not give the mesh back: a fault of this library.
    NotVerified {
        /// The file.
        file: PathBuf,
    },
    /// The slots cannot take these vertices.
    Cache(GeometryCacheError),
    /// The document cannot be read.
    File(FileError),
    /// A `.mwl` file cannot be read, or is not sound.
    Stored {
        /// The file.
        file: PathBuf,
        /// The frame that needed what cannot be read; `None` before the first one.
        frame: Option<usize>,
        /// What is wrong, and at which byte.
        error: HierarchyError,
    },
}

impl fmt::Display for LodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Option(error) => error.fmt(f),
            Self::NoFaces { file } => write!(
                f,
                "{}: no face has three different corners: name a file with a mesh",
                file.display()
            ),
            Self::NoPositions { file, mesh } => write!(
                f,
                "{}: {mesh} has no positions of three numbers for all its vertices: re-export the file with them",
                file.display()
            ),
            Self::NotFinite { file, mesh } => write!(
                f,
                "{}: {mesh} has a face at a position that is not finite: fix it there, or re-export the file",
                file.display()
            ),
            Self::Mesh { file, error } => write!(f, "{}: {error}", file.display()),
            Self::View { frame, error } => write!(f, "frame {frame}: {error}"),
            Self::Losses {
                file,
                attributes,
                others,
            } => write!(
                f,
                "{}: a .mwl file has positions, faces and attributes that all vertices have, and {}. Leave them out with \
                 drop_attributes",
                file.display(),
                losses::told(attributes, others)
            ),
            Self::UnreadFaces { file, mesh } => losses::write_unread(f, file, mesh, "built"),
            Self::TooLong { file, bytes, limit } => write!(
                f,
                "{}: {bytes} bytes, more than the limit of {limit}: raise limits.file_bytes",
                file.display()
            ),
            Self::TooFewVertices { file, asked, least } => write!(
                f,
                "{}: there is no mesh of {asked} vertices or fewer: the coarsest has {least}, so give {least} or more",
                file.display()
            ),
            Self::NotVerified { file } => write!(
                f,
                "{}: the file that was made does not give the mesh back, so nothing is written. This is a fault of meshweft: \
                 please report it with the file",
                file.display()
            ),
            Self::Cache(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
            Self::Stored { file, frame, error } => {
                write!(f, "{}: ", file.display())?;
                if let Some(frame) = frame {
                    write!(f, "frame {frame}: ")?;
                }
                error.fmt(f)
            }
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for LodError {}

impl From<WalkOptionError> for LodError {
    fn from(error: WalkOptionError) -> Self {
        Self::Option(error)
    }
}

impl From<FileError> for LodError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<GeometryCacheError> for LodError {
    fn from(error: GeometryCacheError) -> Self {
        Self::Cache(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_named() {
        let usual = LodWalkOptions::default();
        assert_eq!(usual.check(), Ok(()));
        let cases = [
            (
                LodWalkOptions {
                    frames: Some(0),
                    ..usual.clone()
                },
                "frames 0: give 1 to 1000000",
            ),
            (
                LodWalkOptions {
                    size: [800, 0],
                    ..usual.clone()
                },
                "size 800x0: give 1 to 65535 pixels",
            ),
            (
                LodWalkOptions {
                    tolerance: 0.0,
                    ..usual.clone()
                },
                "tolerance 0: give a number of pixels above 0",
            ),
            (
                LodWalkOptions {
                    tolerance: f64::NAN,
                    ..usual.clone()
                },
                "tolerance NaN",
            ),
            (
                LodWalkOptions {
                    hysteresis: 1.5,
                    ..usual.clone()
                },
                "hysteresis 1.5: give a part",
            ),
            (
                LodWalkOptions {
                    slots: 2,
                    ..usual.clone()
                },
                "slots 2: give 3, which a face needs",
            ),
            (
                LodWalkOptions {
                    passes: true,
                    policy: EvictionPolicy::Nothing,
                    ..usual.clone()
                },
                "passes with the policy none: give a policy that keeps vertices in slots",
            ),
            (
                LodWalkOptions {
                    vertex_size: 0,
                    ..usual.clone()
                },
                "vertex-size 0: give 1 to",
            ),
            (
                LodWalkOptions {
                    path: CameraPath::Given([].into()),
                    ..usual
                },
                "path of 0 cameras",
            ),
        ];
        for (options, expected) in cases {
            let error = options.check().unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
