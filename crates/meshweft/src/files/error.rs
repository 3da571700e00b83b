//! What is wrong with a file, where, and what to do about it.

use std::fmt;
use std::path::{Path, PathBuf};

use super::format::Format;
use super::text::line_of;
use crate::attribute::AttributeInfo;

/// Why a file could not be read, changed or written.
#[derive(Debug)]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// Its format, where that was known.
    pub format: Option<Format>,
    /// Where in the file.
    pub place: Place,
    /// What is wrong.
    pub kind: FileErrorKind,
}

/// Where in a file something was found; as text, nothing for [`File`](Self::File).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// Nowhere in particular.
    File,
    /// A line of text, from 1.
    Line(usize),
    /// A byte offset, from 0.
    Byte(usize),
    /// A JSON pointer (RFC 6901), such as `/meshes/3/primitives/0`.
    Json(String),
    /// A mesh that was to be stored.
    NewMesh {
        /// Its number among those that were given, from 0.
        number: usize,
        /// Its name; empty if it has none.
        name: String,
    },
}

/// What is wrong with a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum FileErrorKind {
    /// The operating system refused.
    Io(std::io::Error),
    /// A file that would be replaced is read-only, and [`WriteOptions`](super::WriteOptions) do not allow
    /// that.
    ReadOnly,
    /// There is something with the name of a new file, and [`WriteOptions`](super::WriteOptions) do not allow
    /// to replace it.
    Exists,
    /// Neither the name nor the first bytes belong to a format that is read.
    UnknownFormat,
    /// The file ends inside what it promised.
    Truncated {
        /// What was being read.
        what: String,
    },
    /// The bytes are not what the format asks for.
    Malformed {
        /// What was found and what was expected.
        problem: String,
    },
    /// A count or size above the [`Limits`](crate::Limits).
    OverLimit {
        /// What there is too much of.
        what: &'static str,
        /// How much there is.
        found: u64,
        /// How much is accepted.
        limit: u64,
    },
    /// The file is sound but uses what is not supported.
    Unsupported {
        /// What it uses, and what to do about it.
        feature: String,
    },
    /// Something that is not known, in a file that is read with [`strict`](super::ReadOptions::strict).
    Unknown {
        /// What it is: an extension, an element, a statement.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// An order that the file's meshes cannot take.
    Order(crate::MeshError),
}

impl FileErrorKind {
    /// [`Malformed`](Self::Malformed) with this text.
    pub(crate) fn malformed(problem: impl Into<String>) -> Self {
        Self::Malformed {
            problem: problem.into(),
        }
    }

    /// [`Truncated`](Self::Truncated) while reading this.
    pub(crate) fn truncated(what: impl Into<String>) -> Self {
        Self::Truncated { what: what.into() }
    }

    /// [`Unsupported`](Self::Unsupported) with this text.
    pub(crate) fn unsupported(feature: impl Into<String>) -> Self {
        Self::Unsupported {
            feature: feature.into(),
        }
    }

    /// This problem at a place, in a file whose name the caller adds.
    pub(crate) fn at(self, place: Place) -> Problem {
        Problem { place, kind: self }
    }
}

/// A problem found by a reader, which sees bytes and not paths.
#[derive(Debug)]
pub(crate) struct Problem {
    pub(crate) place: Place,
    pub(crate) kind: FileErrorKind,
}

impl Problem {
    pub(crate) fn in_file(self, path: &Path, format: Option<Format>) -> FileError {
        FileError {
            path: path.to_owned(),
            format,
            place: self.place,
            kind: self.kind,
        }
    }
}

/// What is wrong in the bytes of a file, and the byte where.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) at: usize,
    pub(super) kind: FileErrorKind,
}

impl Fault {
    pub(super) fn malformed(at: usize, text: impl Into<String>) -> Self {
        let kind = FileErrorKind::malformed(text);
        Self { at, kind }
    }

    /// The problem, placed on its line of the text.
    pub(super) fn on_its_line(self, source: &[u8]) -> Problem {
        self.kind.at(Place::Line(line_of(source, self.at)))
    }
}

/// The error for an attribute that a mesh does not have.
pub(super) fn no_attribute(info: &AttributeInfo) -> Problem {
    let text = format!(
        "this mesh has no attribute {}: take one of those that are listed",
        info.semantic
    );
    FileErrorKind::unsupported(text).at(Place::File)
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.path.display())?;
        match self.place {
            Place::File => write!(f, "{}", self.kind),
            _ => write!(f, "{}: {}", self.place, self.kind),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Json(pointer) => f.write_str(pointer),
            Self::NewMesh { number, name } if name.is_empty() => write!(f, "mesh {number}"),
            Self::NewMesh { number, name } => write!(f, "mesh {number}, {name:?}"),
        }
    }
}

impl fmt::Display for FileErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "{error}"),
            Self::ReadOnly => f.write_str("it is read-only, and is not replaced unasked"),
            Self::Exists => f.write_str("it is there already, and is not replaced unasked"),
            Self::UnknownFormat => f.write_str(
                "unknown format: neither the name nor the first bytes are of glTF, GLB (also .vrm), OBJ, PLY, \
                 OFF, STL or VRML, optionally compressed by gzip",
            ),
            Self::Truncated { what } => write!(
                f,
                "the file ends inside {what}. Fetch it again or re-export it: it is incomplete"
            ),
            Self::Malformed { problem } => {
                let end = if problem.ends_with('?') { "" } else { "." };
                write!(f, "{problem}{end} Fix it there, or re-export the file")
            }
            Self::OverLimit { what, found, limit } => {
                write!(
                    f,
                    "{found} {what}: more than the limit of {limit}. Split the file, or allow more"
                )
            }
            Self::Unsupported { feature } => f.write_str(feature),
            Self::Unknown { what, name } => write!(
                f,
                "{what} {name} is not known and may depend on the order of vertices or faces"
            ),
            Self::Order(error) => write!(f, "{error}"),
        }
    }
}

// No `source`: the text above already says what the system or the mesh said.
impl std::error::Error for FileError {}
