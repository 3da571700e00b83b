//! Why the text of a history could not be read, and where.

use std::{fmt, io};

use super::error::HistoryError;
use crate::error::MeshError;

/// Why a history could not be read.
#[derive(Debug)]
pub struct ReadHistoryError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub kind: ReadHistoryErrorKind,
}

/// What is wrong with a history that is read.
#[derive(Debug)]
#[non_exhaustive]
pub enum ReadHistoryErrorKind {
    /// The reader failed.
    Io(io::Error),
    /// The line is not what a history has there.
    Malformed {
        /// What was found and what was expected.
        problem: String,
    },
    /// The file ends before its last record.
    Truncated {
        /// How many records it has.
        found: usize,
        /// How many the first line promises.
        promised: usize,
    },
    /// A count above the [`Limits`](crate::Limits).
    OverLimit {
        /// What there is too much of.
        what: &'static str,
        /// How much there is, at least.
        found: u64,
        /// How much is accepted.
        limit: u64,
    },
    /// The faces of the full mesh.
    Mesh(MeshError),
    /// A record cannot follow those before it.
    Record(HistoryError),
}

impl ReadHistoryErrorKind {
    pub(super) fn malformed(problem: impl Into<String>) -> Self {
        Self::Malformed {
            problem: problem.into(),
        }
    }
}

impl fmt::Display for ReadHistoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: ", self.line)?;
        match &self.kind {
            ReadHistoryErrorKind::Io(error) => write!(f, "{error}"),
            ReadHistoryErrorKind::Malformed { problem } => write!(f, "{problem}"),
            ReadHistoryErrorKind::Truncated { found, promised } => write!(
                f,
                "the file ends after {found} of {promised} records. Fetch it again: it is incomplete"
            ),
            ReadHistoryErrorKind::OverLimit { what, found, limit } => write!(
                f,
                "{found} {what}: more than the limit of {limit}. Split the mesh, or allow more"
            ),
            ReadHistoryErrorKind::Mesh(error) => write!(f, "{error}"),
            ReadHistoryErrorKind::Record(error) => write!(f, "{error}"),
        }
    }
}

// No `source`: the text above already says what the system, the mesh or the record said.
impl std::error::Error for ReadHistoryError {}
