//! Errors in the caller's arrays.

use std::fmt;

/// What is wrong with an array from the caller.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// A face names a vertex that does not exist.
    IndexOutOfRange {
        /// Number of the face, from 0.
        face: usize,
        /// Corner of the face: 0, 1 or 2.
        corner: usize,
        /// The index found there.
        index: u32,
        /// How many vertices the mesh has.
        vertex_count: usize,
    },
    /// The number of flat indices is not a multiple of three.
    PartialFace {
        /// How many there are.
        len: usize,
    },
    /// More vertices or faces than can be numbered: 32 bits are a number, some of which an algorithm may need.
    TooLarge {
        /// What there is too much of, such as `"vertices"` or `"faces"`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// An array does not have each number below its length exactly once.
    NotAPermutation {
        /// Position of the offending entry.
        position: usize,
        /// Its value: too large, or seen before.
        value: u32,
        /// Length of the array.
        len: usize,
    },
    /// Two arrays that belong together have different lengths.
    LengthMismatch {
        /// What the array is.
        what: &'static str,
        /// The length that was needed.
        expected: usize,
        /// The length that was found.
        found: usize,
    },
    /// A corner rotation is not 0, 1 or 2.
    InvalidRotation {
        /// Position in the new order.
        position: usize,
        /// The value found there.
        value: u8,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::IndexOutOfRange {
                face,
                corner,
                index,
                vertex_count,
            } => match vertex_count.checked_sub(1) {
                Some(last) => write!(
                    f,
                    "face {face}, corner {corner}: index {index} is past the last vertex ({last})"
                ),
                None => write!(
                    f,
                    "face {face}, corner {corner}: index {index}, but the mesh has no vertices"
                ),
            },
            Self::PartialFace { len } => {
                write!(
                    f,
                    "{len} indices: not a multiple of three, the corners of a face"
                )
            }
            Self::TooLarge { what, count, limit } => {
                write!(f, "{count} {what}: at most {limit} can be numbered here")
            }
            Self::NotAPermutation {
                position,
                value,
                len,
            } => write!(
                f,
                "not a permutation: entry {position} is {value}, which is {} for length {len}",
                if (*value as usize) < *len {
                    "a repetition"
                } else {
                    "too large"
                }
            ),
            Self::LengthMismatch {
                what,
                expected,
                found,
            } => write!(f, "{what}: expected {expected} entries, found {found}"),
            Self::InvalidRotation { position, value } => write!(
                f,
                "rotation {value} at position {position}: a face has three corners, so use 0, 1 or 2"
            ),
        }
    }
}

impl std::error::Error for MeshError {}
