//! Why a hierarchy cannot be read from a file.

use std::fmt;
use std::io;

use crate::bits::{DecodeError, DecodeErrorKind};

/// Why a hierarchy could not be read from a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum HierarchyError {
    /// The file could not be read.
    Read(io::Error),
    /// What was read is not a hierarchy, or is damaged.
    Decode(DecodeError),
}

/// What to do about damage.
const CURE: &str = "copy it again, or build it again";

impl fmt::Display for HierarchyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => error.fmt(f),
            Self::Decode(DecodeError { byte, kind }) => match kind {
                DecodeErrorKind::NoHierarchy => {
                    write!(
                        f,
                        "byte {byte}: this is not a .mwl file: give one that `meshweft lod build` wrote"
                    )
                }
                DecodeErrorKind::NoTerrain => {
                    write!(
                        f,
                        "byte {byte}: this is not a .mwt file: give one that `meshweft terrain build` wrote"
                    )
                }
                DecodeErrorKind::EndsEarly => write!(
                    f,
                    "byte {byte}: the file is cut, or has more bytes than it should: {CURE}"
                ),
                DecodeErrorKind::Unknown { what, found } => write!(
                    f,
                    "byte {byte}: {what} {found} is not known. A later version of meshweft may have written the file: update \
                     meshweft. Otherwise {CURE}"
                ),
                DecodeErrorKind::AboveLimit { what, said, limit } => write!(
                    f,
                    "byte {byte}: the file has {said} {what}, and {limit} are allowed: if you trust it, raise the limit"
                ),
                _ => write!(f, "byte {byte}: the file is damaged: {CURE}"),
            },
        }
    }
}

impl std::error::Error for HierarchyError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read(error) => Some(error),
            Self::Decode(error) => Some(error),
        }
    }
}

impl From<io::Error> for HierarchyError {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

impl From<DecodeError> for HierarchyError {
    fn from(error: DecodeError) -> Self {
        Self::Decode(error)
    }
}
