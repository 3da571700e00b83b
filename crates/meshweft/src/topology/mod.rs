//! What touches what: compact rows, the faces at each vertex, and the faces at each edge.

mod adjacency;
pub(crate) mod half_edges;
pub(crate) mod rows;

pub use adjacency::Adjacency;
pub(crate) use adjacency::distinct;
