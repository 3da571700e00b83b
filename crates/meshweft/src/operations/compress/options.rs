//! What a compression is asked for, and why it cannot be done.

use std::fmt;
use std::path::PathBuf;

use crate::attribute::AttributeInfo;
use crate::compression::{CodeError, KeepOrder, Tier};
use crate::connectivity::FirstVertex;
use crate::error::MeshError;
use crate::files::FileError;
use crate::operations::losses;

/// How a document is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct CompressOptions {
    /// What is paid for a smaller stream.
    pub tier: Tier,
    /// How exact positions are.
    pub positions: PositionPrecision,
    /// The vertex with which each mesh begins.
    pub first_vertex: FirstVertex,
    /// What of the order of the file is stored.
    pub keep_order: KeepOrder,
    /// Leave out whatever is not the name of a mesh, a position or a face: attributes, materials, groups, lines, nodes.
    pub drop_attributes: bool,
    /// Store polygons as the triangles that they are drawn as.
    pub triangles: bool,
}

/// How exact positions are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum PositionPrecision {
    /// Every bit.
    #[default]
    Lossless,
    /// The largest extent of the document along any axis is two to the power of this number minus one steps
    /// long.
    Bits(u32),
    /// The step, in units of the positions.
    Step(f64),
}

/// Why a document cannot be compressed.
#[derive(Debug)]
#[non_exhaustive]
pub enum CompressError {
    /// The file holds what cannot be compressed yet.
    Attributes {
        /// The file.
        file: PathBuf,
        /// What meshes store, by mesh.
        attributes: Vec<(String, Vec<AttributeInfo>)>,
        /// What else there is, in the words of the format.
        others: Vec<String>,
    },
    /// A mesh has faces of fewer than three corners, which have no triangles.
    Lines {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// A mesh has faces that were not read.
    UnreadFaces {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// The file has no mesh.
    NoMesh {
        /// The file.
        file: PathBuf,
    },
    /// Positions have more bits than are stored.
    WidePositions {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
    /// The number of bits, or the step, is out of range.
    Precision(PositionPrecision),
    /// A mesh cannot be compressed so.
    Mesh {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
        /// Why.
        error: CodeError,
    },
    /// The first vertex is not there.
    FirstVertex(MeshError),
    /// The file cannot be read.
    File(FileError),
    /// What was compressed does not decode to what it was: a fault of this library.
    NotVerified {
        /// The file.
        file: PathBuf,
        /// The mesh.
        mesh: String,
    },
}

impl fmt::Display for CompressError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Attributes {
                file,
                attributes,
                others,
            } => write!(
                f,
                "{}: positions and faces are compressed, and {}. Leave them out with drop_attributes",
                file.display(),
                losses::told(attributes, others)
            ),
            Self::Lines { file, mesh } => write!(
                f,
                "{}: {mesh} has faces of fewer than three corners, which cannot be compressed. Leave them out, and store \
                 the triangles that polygons are drawn as, with triangles",
                file.display()
            ),
            Self::UnreadFaces { file, mesh } => losses::write_unread(f, file, mesh, "compressed"),
            Self::NoMesh { file } => {
                write!(f, "{}: there is no mesh to compress", file.display())
            }
            Self::WidePositions { file, mesh } => write!(
                f,
                "{}: the positions of {mesh} have more bits than a 32-bit float. Round them with a position step or a \
                 number of position bits",
                file.display()
            ),
            Self::Precision(PositionPrecision::Bits(bits)) => {
                write!(f, "{bits} position bits: give 1 to 30")
            }
            Self::Precision(PositionPrecision::Step(step)) => {
                write!(
                    f,
                    "position step {step}: give a power of two, such as 0.0009765625 (2^-10)"
                )
            }
            Self::Precision(PositionPrecision::Lossless) => Ok(()),
            Self::Mesh { file, mesh, error } => {
                write!(f, "{}: {mesh}: {error}", file.display())
            }
            Self::FirstVertex(error) => error.fmt(f),
            Self::File(error) => error.fmt(f),
            Self::NotVerified { file, mesh } => write!(
                f,
                "{}: {mesh} did not decode to what it was, so nothing is written. This is a fault of meshweft: please \
                 report it with the file",
                file.display()
            ),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for CompressError {}

impl From<FileError> for CompressError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}
