//! What a file says of the faces that need not be drawn.

use super::error::Place;

/// A culling table as a file stores it, in the extension `MESHWEFT_culling` of a glTF: clusters of consecutive faces,
/// each with four planes. [`CullingTable::from_parts`](crate::culling::CullingTable::from_parts) takes the parts.
///
/// In [`Edit::Cull`](super::Edit::Cull) it is to be stored; [`Document::culling`](super::Document::culling) reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredCulling {
    /// The origin of the planes.
    pub center: [f32; 3],
    /// How far positions are from it at most.
    pub reach: f32,
    /// Where the faces of each cluster begin, and how many there are: rising, the first 0.
    pub starts: Vec<u32>,
    /// The four planes of each cluster.
    pub planes: Vec<[[f32; 4]; 4]>,
}

/// A culling table where it stands: several primitives may draw the faces of one mesh, each with a table of its own.
#[derive(Debug)]
pub(crate) struct PlacedTable<'a> {
    /// Whose faces they are.
    pub(crate) mesh: usize,
    /// The first primitive that has this table.
    pub(crate) place: Place,
    /// Whether it is the first of the mesh.
    pub(crate) is_first: bool,
    /// `None` if the mesh has too many to look at.
    pub(crate) table: Option<StoredCulling>,
    /// What the primitive draws, if it has positions of three numbers.
    pub(crate) positions: Option<&'a [[f32; 3]]>,
}

/// Which sides of the faces of a mesh are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SeenSides {
    /// Those that the corners turn left on.
    Front,
    /// Both.
    Both,
}
