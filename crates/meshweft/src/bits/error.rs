//! What is wrong with a stream.

use std::fmt;

/// Why a stream cannot be decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DecodeError {
    /// The byte at which decoding had arrived.
    pub byte: usize,
    /// What is wrong there.
    pub kind: DecodeErrorKind,
}

/// What is wrong with a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum DecodeErrorKind {
    /// It ends before the faces are complete.
    EndsEarly,
    /// It has other symbols than were written: what was decoded does not end where it should.
    Damaged,
    /// It has more of something than it says.
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many it says there are.
        said: usize,
    },
    /// It names a vertex that cannot be there.
    NoSuchVertex {
        /// The vertex that it names.
        vertex: u32,
    },
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "byte {}: ", self.byte)?;
        match self.kind {
            DecodeErrorKind::EndsEarly => write!(
                f,
                "the stream ends before the mesh is complete. Fetch it again"
            ),
            DecodeErrorKind::Damaged => {
                write!(
                    f,
                    "the stream is damaged. Fetch it again or compress the mesh again"
                )
            }
            DecodeErrorKind::TooMany { what, said } => write!(
                f,
                "the stream has more {what} than the {said} that it says. It is damaged: fetch it again"
            ),
            DecodeErrorKind::NoSuchVertex { vertex } => write!(
                f,
                "the stream names vertex {vertex}, which cannot be there. It is damaged: fetch it again"
            ),
        }
    }
}

impl std::error::Error for DecodeError {}
