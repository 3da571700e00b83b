//! Primitives that may move and primitives that stay, as they were read.

use std::borrow::Cow;

use super::accessors::Accessor;
use super::culling::Culling;
use super::obstacles::VertexObstacle;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;

/// Which primitive of a file: the numbers of its mesh and of itself. They rise in the order of the
/// file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PrimitiveNumber {
    pub(super) mesh: u32,
    pub(super) primitive: u32,
}

impl PrimitiveNumber {
    /// The JSON pointer to it.
    pub(super) fn pointer(self) -> String {
        format!("/meshes/{}/primitives/{}", self.mesh, self.primitive)
    }
}

/// A list of vertex indices in an accessor.
#[derive(Debug, Clone)]
pub(super) struct IndexList {
    /// The JSON pointer to the accessor.
    pub(super) pointer: String,
    /// The vertex numbers, without gaps.
    pub(super) records: StridedRecords,
    /// The JSON states its smallest and largest values.
    pub(super) is_bounded: bool,
}

impl IndexList {
    /// The list in an accessor; `None` if that has no records.
    pub(super) fn of(accessor: Accessor) -> Option<Self> {
        Some(Self {
            records: accessor.records?,
            is_bounded: accessor.is_bounded,
            pointer: accessor.pointer,
        })
    }
}

/// What a primitive draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Draws {
    /// Triangles, each by three vertices of its own.
    Faces,
    /// The same, but each is drawn over those before, which shows.
    FacesInOrder,
    /// Something else, whose order stays, by a list of vertex numbers that can be renumbered. Why it
    /// stays: to be read after "left as it is: ".
    Other(&'static str),
}

/// A primitive that can be changed as far as itself is concerned: its faces re-ordered or, if it draws
/// something else, its vertices renumbered.
///
/// A file can have very many, so what few of them have is in a box of its own.
#[derive(Debug)]
pub(super) struct Movable {
    pub(super) number: PrimitiveNumber,
    pub(super) draws: Draws,
    pub(super) vertex_count: usize,
    /// What it draws, by the numbers of its vertices; `None` if each face is three vertices in a row.
    pub(super) indices: Option<Box<IndexList>>,
    /// The records of all attributes and morph targets, rising, each once.
    pub(super) vertices: Box<[StridedRecords]>,
    pub(super) uncommon: Option<Box<Uncommon>>,
    /// The numbers of all accessors it names.
    pub(super) accessors: Box<[u32]>,
}

/// What few primitives have.
#[derive(Debug, Default)]
pub(super) struct Uncommon {
    pub(super) outline: Option<IndexList>,
    /// The sparse elements of attributes and morph targets, rising, each once.
    pub(super) sparse: Vec<Sparse>,
    /// Accessors whose sparse elements cannot be moved.
    pub(super) unmoved_sparse: Vec<usize>,
    /// Clusters in which its faces must stay.
    pub(super) culling: Option<Culling>,
    /// Why the vertices must stay.
    pub(super) vertex_obstacle: Option<VertexObstacle>,
}

impl Uncommon {
    /// Whether there is nothing uncommon.
    pub(super) fn is_empty(&self) -> bool {
        self.outline.is_none()
            && self.culling.is_none()
            && self.vertex_obstacle.is_none()
            && self.sparse.is_empty()
            && self.unmoved_sparse.is_empty()
    }
}

impl Movable {
    pub(super) fn outline(&self) -> Option<&IndexList> {
        self.uncommon.as_ref()?.outline.as_ref()
    }

    pub(super) fn culling(&self) -> Option<&Culling> {
        self.uncommon.as_ref()?.culling.as_ref()
    }

    pub(super) fn sparse(&self) -> &[Sparse] {
        self.uncommon
            .as_ref()
            .map_or(&[], |uncommon| &uncommon.sparse)
    }

    pub(super) fn vertex_obstacle(&self) -> Option<&VertexObstacle> {
        self.uncommon.as_ref()?.vertex_obstacle.as_ref()
    }

    /// The lists of vertex numbers: what it draws, and its outline.
    pub(super) fn lists(&self) -> impl Iterator<Item = &IndexList> {
        self.indices.as_deref().into_iter().chain(self.outline())
    }

    /// Those that are not corners of faces.
    pub(super) fn other_lists(&self) -> impl Iterator<Item = &IndexList> {
        let drawn = self.indices.as_deref();
        let drawn = drawn.filter(|_| matches!(self.draws, Draws::Other(_)));
        drawn.into_iter().chain(self.outline())
    }
}

/// A primitive that stays as it is.
#[derive(Debug)]
pub(super) struct Staying {
    pub(super) number: PrimitiveNumber,
    pub(super) why: Cow<'static, str>,
    /// The numbers of all accessors it names.
    pub(super) accessors: Box<[u32]>,
}

/// A primitive as it was read: may it be changed?
#[derive(Debug)]
pub(super) enum Primitive {
    Movable(Movable),
    Staying(Staying),
}
