//! A GLB of the positions and faces of a document of another format.

use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use super::facets::says_nothing;
use super::plain_meshes::plain_meshes;
use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::files::{Document, FileError, Format, NewMesh};

/// A GLB, and what it does not have of its source.
pub(super) struct Converted {
    pub(super) document: Document,
    pub(super) lost: Vec<String>,
}

/// Why no GLB was made.
#[derive(Debug)]
#[non_exhaustive]
pub enum ConversionError {
    /// It would lose what the document also has.
    Lost {
        /// The file.
        file: PathBuf,
        /// What that is.
        what: Vec<String>,
    },
    /// It would lose faces that were not read.
    UnreadFaces {
        /// The file.
        file: PathBuf,
        /// Whose.
        mesh: String,
    },
    /// The document has no faces.
    NoFaces {
        /// The file.
        file: PathBuf,
    },
    /// The document cannot be read, or the GLB not made.
    File(FileError),
}

impl fmt::Display for ConversionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lost { file, what } => write!(
                f,
                "{}: a GLB is made of the positions and faces, and the file also has {}. Leave it out with \
                 drop_attributes, or convert the file to .glb first",
                file.display(),
                what.join(", ")
            ),
            Self::UnreadFaces { file, mesh } => write!(
                f,
                "{}: {mesh} has faces that cannot be read, so no GLB can be made of the file",
                file.display()
            ),
            Self::NoFaces { file } => write!(f, "{}: there are no faces", file.display()),
            Self::File(error) => error.fmt(f),
        }
    }
}

// No `source`: the text above already says it.
impl std::error::Error for ConversionError {}

impl From<FileError> for ConversionError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

/// Makes a GLB with the names, positions and faces of the meshes. What else the document has is an error, unless it is to be
/// dropped.
pub(super) fn converted(
    document: &Document,
    drop_attributes: bool,
) -> Result<Converted, ConversionError> {
    let file = || document.path().to_owned();
    let unlisted = document.unlisted();
    let mut unread = unlisted.iter().filter(|it| it.has_faces);
    let other = document.meshes().iter().find(|it| it.has_other_faces);
    let unread = unread
        .next()
        .map(|it| &it.what)
        .or(other.map(|it| &it.name));
    if let Some(mesh) = unread {
        let mesh = mesh.clone();
        return Err(ConversionError::UnreadFaces { file: file(), mesh });
    }

    // What is not a name, a position or a face.
    let mut lost = Vec::new();
    for (number, entry) in document.meshes().iter().enumerate() {
        for info in document.attributes(number) {
            lost.extend(loss(document, number, &info)?);
        }
        let records = 0..entry.record_count();
        if records
            .into_iter()
            .any(|record| entry.faces_of(record).len() > 1)
        {
            lost.push("polygons, which become triangles".to_owned());
        }
        if entry.mesh.face_count() == 0 {
            lost.push(format!("{}, which has no faces", entry.name));
        }
    }
    lost.extend(unlisted.into_iter().map(|it| it.what));
    let mut seen = BTreeSet::new();
    lost.retain(|what| seen.insert(what.clone()));
    if !lost.is_empty() && !drop_attributes {
        let what = lost;
        return Err(ConversionError::Lost { file: file(), what });
    }

    // The rest.
    let plain = plain_meshes(document)?;
    let meshes = plain.iter().filter(|it| it.mesh.face_count() > 0);
    let meshes: Vec<NewMesh<'_>> = meshes
        .map(|it| NewMesh::plain(&it.name, it.mesh.positions(), it.mesh.faces()))
        .collect();
    if meshes.is_empty() {
        return Err(ConversionError::NoFaces { file: file() });
    }
    let name = document.path().with_extension("glb");
    let document = Document::create(Format::Glb, &name, &meshes)?;
    Ok(Converted { document, lost })
}

/// What is lost of an attribute, if anything.
fn loss(
    document: &Document,
    mesh: usize,
    info: &AttributeInfo,
) -> Result<Option<String>, FileError> {
    let is_position = info.semantic == Semantic::Position && info.morph_target.is_none();
    use ComponentType::{F64, I32, U32};
    if is_position {
        let is_wide = matches!(info.component_type, F64 | I32 | U32);
        return Ok(is_wide.then(|| "bits of its positions beyond 32-bit floats".to_owned()));
    }
    if says_nothing(document, mesh, info)? {
        return Ok(None);
    }
    let of = match info.domain {
        Domain::Face => " of faces",
        Domain::Corner => " of corners",
        Domain::Vertex => "",
    };
    Ok(Some(format!("{}{of}", info.semantic)))
}
