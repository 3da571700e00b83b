//! Mesh files, changed in place: faces and vertices are permuted, every other byte stays.
//!
//! Re-ordering permutes records of a file, so the file is patched rather than written anew:
//! whatever a reader does not know (materials, extras, extensions, comments) cannot be lost.
//! Read [`Document`] first, then [`MeshEntry`]; each format has a module of its own.

mod document;
mod entry;
mod error;
mod gltf;
mod obj;
mod off;
mod options;
mod ply;
mod records;
mod splice;
mod stl;
mod text;
mod vrml;

use std::path::{Path, PathBuf};
use std::{fmt, io};

pub use document::{Document, remove_abandoned};
pub use entry::MeshEntry;
pub use error::{FileError, FileErrorKind, Place};
pub use gltf::external_buffers;
pub use options::ReadOptions;

use crate::permutation::{FaceOrder, VertexOrder};
use error::Problem;

/// What a reader hands to [`Document`].
type ReadResult = Result<(Box<dyn Content>, Vec<Note>), Problem>;

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// glTF 2.0 as JSON, with buffers beside it or inside.
    Gltf,
    /// glTF 2.0 as one binary file.
    Glb,
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ascii or binary.
    Ply,
    /// Object File Format, ascii.
    Off,
    /// Stereolithography, binary or ascii.
    Stl,
    /// VRML97, also called VRML 2.0.
    Vrml,
}

impl Format {
    /// The format that a file name stands for; `.gz` at the end is ignored.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        match name.rsplit_once('.')?.1 {
            "gltf" => Some(Self::Gltf),
            "glb" => Some(Self::Glb),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "off" => Some(Self::Off),
            "stl" => Some(Self::Stl),
            "wrl" | "vrml" => Some(Self::Vrml),
            _ => None,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gltf => "glTF",
            Self::Glb => "GLB",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Off => "OFF",
            Self::Stl => "STL",
            Self::Vrml => "VRML",
        })
    }
}

/// Something that was left as it is, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Note {
    /// Where it stands.
    pub place: Place,
    /// What was left and why.
    pub text: String,
    /// How many further places in the file this holds for.
    pub more: usize,
}

impl Note {
    fn new(place: Place, text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            place,
            text,
            more: 0,
        }
    }
}

/// What a format's reader offers to [`Document`].
trait Content {
    /// The meshes, kept up to date by `apply`.
    fn meshes(&self) -> &[MeshEntry];
    /// Permutes records; the caller has checked the lengths.
    fn apply(&mut self, mesh: usize, faces: &FaceOrder, vertices: Option<&VertexOrder>);
    /// Every file to write when the document goes to `path`, the main one last.
    fn files(&self, path: &Path) -> Result<Vec<OutputFile<'_>>, Problem>;
}

/// A file to be written, its bytes made as they are written.
struct OutputFile<'a> {
    path: PathBuf,
    write: Box<WriteFile<'a>>,
}

/// Writes all bytes of a file, in large pieces.
type WriteFile<'a> = dyn Fn(&mut dyn io::Write) -> io::Result<()> + 'a;
