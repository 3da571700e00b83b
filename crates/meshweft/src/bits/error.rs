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
    /// It does not begin as an archive of meshes does.
    NoArchive,
    /// It does not begin as a vertex hierarchy does.
    NoHierarchy,
    /// It does not begin as a terrain does.
    NoTerrain,
    /// It is not such a stream, or was written by a later version.
    Unknown {
        /// What is not known.
        what: &'static str,
        /// The number that stands there.
        found: u64,
    },
    /// It says that it has more than [`Limits`](crate::Limits) allow.
    AboveLimit {
        /// What there is too much of.
        what: &'static str,
        /// How many it says there are.
        said: u64,
        /// How many are allowed.
        limit: usize,
    },
    /// It names a vertex that cannot be there.
    NoSuchVertex {
        /// The vertex that it names.
        vertex: u32,
    },
}

impl DecodeError {
    /// The end of the bytes, too early.
    pub(crate) fn ends_early(byte: usize) -> Self {
        let kind = DecodeErrorKind::EndsEarly;
        Self { byte, kind }
    }

    /// Damage at a byte.
    pub(crate) fn damaged(byte: usize) -> Self {
        let kind = DecodeErrorKind::Damaged;
        Self { byte, kind }
    }
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
            DecodeErrorKind::NoArchive => write!(
                f,
                "this is not a .mwz file. Give one that was written by compress"
            ),
            DecodeErrorKind::NoHierarchy => write!(
                f,
                "this is not a .mwl file. Give one that was written by lod build"
            ),
            DecodeErrorKind::NoTerrain => write!(
                f,
                "this is not a .mwt file. Give one that was written by terrain build"
            ),
            DecodeErrorKind::Unknown { what, found } => write!(
                f,
                "{what} {found} is not known. A later version of meshweft may have written the stream: update, or fetch it again"
            ),
            DecodeErrorKind::AboveLimit { what, said, limit } => write!(
                f,
                "the stream has {said} {what}, and {limit} are allowed. If you trust it, raise the limit"
            ),
            DecodeErrorKind::NoSuchVertex { vertex } => write!(
                f,
                "the stream names vertex {vertex}, which cannot be there. It is damaged: fetch it again"
            ),
        }
    }
}

impl std::error::Error for DecodeError {}
