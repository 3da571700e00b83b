//! What is wrong with an update record.

use std::fmt;

/// Why an update record cannot follow those before it.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryError {
    /// Number of the record, from 0.
    pub record: usize,
    /// What is wrong with it.
    pub kind: HistoryErrorKind,
}

/// What is wrong with an update record.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum HistoryErrorKind {
    /// It removes a face that does not exist.
    NoSuchFace {
        /// The number that it names.
        face: u32,
        /// How many face numbers there are so far.
        count: usize,
    },
    /// It removes a face that has left before, or removes one twice.
    FaceIsGone {
        /// The face.
        face: u32,
        /// The record that removed it.
        left_with: u32,
    },
    /// It names a vertex that does not exist.
    NoSuchVertex {
        /// Where it names it.
        what: &'static str,
        /// The number that it names.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// It names a vertex that has left before, or leaves with it.
    VertexIsGone {
        /// Where it names it.
        what: &'static str,
        /// The vertex.
        vertex: u32,
        /// The record that removed it.
        left_with: u32,
    },
    /// It removes a vertex that a face still uses.
    VertexInUse {
        /// The vertex.
        vertex: u32,
        /// The first face that uses it.
        face: u32,
    },
    /// It does not say for each of its vertices what they are merged into.
    PartialMerge {
        /// How many vertices it removes.
        vertices: usize,
        /// How many it says this for.
        merged: usize,
    },
    /// Its error is negative, infinite or not a number.
    InvalidError {
        /// The error.
        error: f32,
    },
    /// There are more records, removals or face numbers than 32 bits count.
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// How many there would be.
        count: usize,
        /// How many are allowed.
        limit: usize,
    },
}

impl fmt::Display for HistoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "record {}: ", self.record)?;
        match self.kind {
            HistoryErrorKind::NoSuchFace { face, count } => write!(
                f,
                "removed face {face}: there are {count} face numbers so far. Faces of the full mesh \
                 are numbered from 0, inserted faces follow in the order of the records"
            ),
            HistoryErrorKind::FaceIsGone { face, left_with } => write!(
                f,
                "removed face {face} left with record {left_with}. Remove each face once"
            ),
            HistoryErrorKind::NoSuchVertex {
                what,
                vertex,
                vertex_count,
            } => write!(
                f,
                "{what} {vertex}: there are {vertex_count} vertices, numbered from 0"
            ),
            HistoryErrorKind::VertexIsGone {
                what,
                vertex,
                left_with,
            } => write!(
                f,
                "{what} {vertex} left with record {left_with}. Name vertices that are still there"
            ),
            HistoryErrorKind::VertexInUse { vertex, face } => write!(
                f,
                "removed vertex {vertex} is still used by face {face}. Remove that face too"
            ),
            HistoryErrorKind::PartialMerge { vertices, merged } => write!(
                f,
                "merges {merged} vertices, but removes {vertices}. Say it for each of them, or for none"
            ),
            HistoryErrorKind::InvalidError { error } => write!(
                f,
                "its error is {error}. Give a finite number from 0, or 0 if it is not known"
            ),
            HistoryErrorKind::TooLarge { what, count, limit } => write!(
                f,
                "{count} {what}: at most {limit} can be counted in 32 bits. Split the mesh"
            ),
        }
    }
}

impl std::error::Error for HistoryError {}
