//! What touches what: compact rows, and the faces at each vertex.

mod adjacency;
pub(crate) mod rows;

pub use adjacency::Adjacency;
pub(crate) use adjacency::distinct;
