//! What a geometry cache refuses.

use std::fmt;

/// Why a [`GeometryCache`](super::GeometryCache) is not made, or leaves everything as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum GeometryCacheError {
    /// The number of slots is out of range.
    Slots {
        /// How many were asked for.
        slots: usize,
    },
    /// More vertices than 32-bit numbers can count.
    Vertices {
        /// How many there are.
        count: usize,
    },
    /// The error of a vertex is below zero or not a number.
    Error {
        /// The vertex.
        vertex: usize,
        /// What was given as its error.
        error: f32,
    },
    /// A list of vertices names one that does not exist.
    Vertex {
        /// What the list has, such as `"active vertices"`.
        list: &'static str,
        /// Where in the list.
        position: usize,
        /// The number found there.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
}

impl GeometryCacheError {
    /// The largest number of slots.
    pub(crate) const MOST_SLOTS: usize = 1 << 30;

    /// Refuses a list with a vertex that is not below the count.
    pub(super) fn check(
        list: &'static str,
        vertices: &[u32],
        vertex_count: usize,
    ) -> Result<(), Self> {
        let is_missing = |&vertex: &u32| vertex as usize >= vertex_count;
        match vertices.iter().position(is_missing) {
            None => Ok(()),
            Some(position) => Err(Self::Vertex {
                list,
                position,
                vertex: vertices[position],
                vertex_count,
            }),
        }
    }
}

impl fmt::Display for GeometryCacheError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slots { slots } => write!(
                f,
                "{slots} slots: give 3, which a face needs, to {}",
                Self::MOST_SLOTS
            ),
            Self::Vertices { count } => {
                write!(f, "{count} vertices: at most {} can be numbered", u32::MAX)
            }
            Self::Error { vertex, error } => {
                write!(f, "the error of vertex {vertex} is {error}: give 0 or more")
            }
            Self::Vertex {
                list,
                position,
                vertex,
                vertex_count,
            } => write!(
                f,
                "{list}, position {position}: vertex {vertex} does not exist; the {vertex_count} vertices are numbered from 0"
            ),
        }
    }
}

impl std::error::Error for GeometryCacheError {}
