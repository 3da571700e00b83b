//! Which formats there are, and how a file tells its own.

use std::fmt;
use std::path::Path;

/// A file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// glTF 2.0 as JSON, with buffers beside it or inside.
    Gltf,
    /// glTF 2.0 as one binary file; VRM is one.
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
    /// The format that a file name stands for; `.gz` at the end is ignored. What is in the file may be
    /// another: see [`of_content`](Self::of_content).
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        match ending(path)?.as_str() {
            "gltf" => Some(Self::Gltf),
            "glb" | "vrm" => Some(Self::Glb),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "off" => Some(Self::Off),
            "stl" => Some(Self::Stl),
            "wrl" | "vrml" => Some(Self::Vrml),
            _ => None,
        }
    }
}

/// What a file name ends with, without `.gz`, in small letters.
pub(super) fn ending(path: &Path) -> Option<String> {
    // What is not UTF-8 is not in the ending.
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    Some(name.rsplit_once('.')?.1.to_owned())
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
