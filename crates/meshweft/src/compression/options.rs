//! How a mesh is compressed, and what prevents it.

use std::fmt;

use crate::geometry::Lattice;

/// What is paid for a smaller stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Tier {
    /// Tables of frequencies by what is around: the fastest to decode.
    #[cfg_attr(not(feature = "default-tier"), default)]
    Fast,
    /// Chances that are mixed from what is around and how it lies: fewer bytes. With the feature `default-tier`, which
    /// is on by default.
    #[cfg(feature = "default-tier")]
    #[default]
    Default,
}

impl Tier {
    /// All tiers, by the number that a stream has for them.
    pub const ALL: &[Self] = &[
        Self::Fast,
        #[cfg(feature = "default-tier")]
        Self::Default,
    ];
}

/// How positions are stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum PositionCoding {
    /// Every bit of every coordinate.
    #[default]
    Lossless,
    /// As multiples of a step.
    OnLattice(Lattice),
}

/// What of the order of the source is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum KeepOrder {
    /// Nothing: faces and vertices come back in the order of the stream.
    #[default]
    Nothing,
    /// The order of the faces, and which corner of each is first.
    Faces,
    /// The order of the vertices.
    Vertices,
    /// Both: the same index buffer comes back.
    Both,
}

impl KeepOrder {
    /// Whether the order of the faces is kept, and that of the vertices.
    pub(super) fn parts(self) -> [bool; 2] {
        match self {
            Self::Nothing => [false, false],
            Self::Faces => [true, false],
            Self::Vertices => [false, true],
            Self::Both => [true, true],
        }
    }
}

/// How a mesh is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CodeOptions {
    /// What is paid for a smaller stream.
    pub tier: Tier,
    /// How positions are stored.
    pub positions: PositionCoding,
    /// The vertex with which the traversal begins; [`FirstVertex`](crate::connectivity::FirstVertex) chooses one that
    /// needs a small buffer. A mesh that was decoded gives the same stream again from vertex 0.
    pub first_vertex: u32,
    /// What of the order of the source is stored: up to some bytes a face and a vertex.
    pub keep_order: KeepOrder,
}

/// Why a mesh cannot be compressed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum CodeError {
    /// It has no positions.
    NoPositions,
    /// The first vertex is not there.
    NoSuchVertex {
        /// The one that was given.
        vertex: u32,
        /// How many there are.
        vertex_count: usize,
    },
    /// The polygons are not all the faces of the mesh.
    PolygonStarts,
    /// A coordinate cannot be a multiple of the step.
    NotOnLattice {
        /// The vertex.
        vertex: usize,
        /// The coordinate.
        coordinate: f32,
        /// The step.
        step: f64,
    },
    /// The mesh is more than two to the power of 31 steps long.
    StepTooSmall {
        /// The step.
        step: f64,
    },
}

impl fmt::Display for CodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPositions => write!(
                f,
                "the mesh has no positions. Compress its faces alone with connectivity::FanCode"
            ),
            Self::NoSuchVertex {
                vertex,
                vertex_count,
            } => write!(
                f,
                "the first vertex is {vertex}, and there are {vertex_count}: give a smaller number"
            ),
            Self::PolygonStarts => write!(
                f,
                "polygons must start at 0, rise, and end at the number of faces"
            ),
            Self::NotOnLattice {
                vertex,
                coordinate,
                step,
            } => write!(
                f,
                "vertex {vertex} has the coordinate {coordinate}, which cannot be rounded to a multiple of {step}. \
                 Compress the mesh lossless, or repair the vertex"
            ),
            Self::StepTooSmall { step } => write!(
                f,
                "the mesh is more than 2^31 steps of {step} long: choose a larger step, or compress it lossless"
            ),
        }
    }
}

impl std::error::Error for CodeError {}
