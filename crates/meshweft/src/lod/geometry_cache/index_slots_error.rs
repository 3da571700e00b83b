//! What an index buffer of slots refuses.

use std::fmt;

/// Why an [`IndexSlots`](super::IndexSlots) leaves everything as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IndexSlotsError {
    /// A list of faces names one that does not exist.
    Face {
        /// What the list has: `"removed faces"`, `"added faces"` or `"living faces"`.
        list: &'static str,
        /// Where in the list.
        position: usize,
        /// The number found there.
        face: u32,
        /// How many faces there are.
        face_count: usize,
    },
    /// A face that is added has a vertex that is not active in the frame.
    Inactive {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
}

impl fmt::Display for IndexSlotsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Face {
                list,
                position,
                face,
                face_count,
            } => write!(
                f,
                "{list}, position {position}: face {face} does not exist; the {face_count} faces are numbered from 0"
            ),
            Self::Inactive { face, vertex } => write!(
                f,
                "face {face} is added, but its vertex {vertex} is not active: give it to the cache first, in the same frame"
            ),
        }
    }
}

impl std::error::Error for IndexSlotsError {}
