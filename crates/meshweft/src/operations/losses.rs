//! What a document holds that a format of few things would lose.

use std::fmt;

use super::facets::says_nothing;
use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::files::{Document, FileError, MeshEntry};

/// What a document has besides positions, faces and what else is kept.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Losses {
    /// What meshes store, by mesh.
    pub(super) attributes: Vec<(String, Vec<AttributeInfo>)>,
    /// What else there is, in the words of the format.
    pub(super) others: Vec<String>,
}

impl Losses {
    /// All that is lost of a document of which meshes at full resolution are kept; `keeps` says of an attribute of a mesh whether it is kept. What an STL says twice does not
    /// count.
    ///
    /// # Errors
    /// Attributes cannot be read.
    pub(super) fn of(
        document: &Document,
        keeps: impl Fn(usize, &AttributeInfo) -> bool,
    ) -> Result<Self, FileError> {
        let entries = document.meshes();
        let mut attributes = Vec::new();
        let full = entries.iter().enumerate();
        for (number, entry) in full.filter(|(_, entry)| entry.level.is_none()) {
            let mut lost = Vec::new();
            for info in document.attributes(number) {
                let is_kept = is_position(&info) || keeps(number, &info);
                if !is_kept && !says_nothing(document, number, &info)? {
                    lost.push(info);
                }
            }
            if !lost.is_empty() {
                attributes.push((entry.name.clone(), lost));
            }
        }
        let levels = entries.iter().any(|entry| entry.level.is_some());
        let levels = levels.then(|| "levels of detail".to_owned());
        let others = document.unlisted().into_iter().map(|it| it.what);
        Ok(Self {
            attributes,
            others: levels.into_iter().chain(others).collect(),
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.attributes.is_empty() && self.others.is_empty()
    }
}

/// What is lost, as the rest of a sentence that says what is kept.
pub(super) fn told(attributes: &[(String, Vec<AttributeInfo>)], others: &[String]) -> String {
    let of_mesh = attributes.iter().map(|(mesh, attributes)| {
        let names: Vec<String> = attributes.iter().map(name_of).collect();
        format!("{mesh} also stores {}", names.join(", "))
    });
    let others = (!others.is_empty()).then(|| format!("the file also has {}", others.join(", ")));
    let all: Vec<String> = of_mesh.chain(others).collect();
    all.join("; ")
}

/// What an attribute is called.
fn name_of(info: &AttributeInfo) -> String {
    let name = &info.semantic;
    match (info.morph_target, info.domain) {
        (Some(target), _) => format!("{name} of morph target {target}"),
        (None, Domain::Vertex) => name.to_string(),
        (None, Domain::Corner) => format!("{name} of corners"),
        (None, Domain::Face) => format!("{name} of faces"),
    }
}

/// Says that faces cannot be read; `what` cannot be done then.
pub(super) fn write_unread(
    f: &mut fmt::Formatter<'_>,
    file: &std::path::Path,
    mesh: &str,
    what: &str,
) -> fmt::Result {
    write!(
        f,
        "{}: {mesh} has faces that cannot be read (strips, fans, compressed ones, or a list of another mesh with \
         other positions), so it cannot be {what} whole. Convert the file to lists of triangles",
        file.display()
    )
}

/// What has faces that were not read, outside of all meshes.
pub(super) fn unread_outside(document: &Document) -> Option<String> {
    let mut unlisted = document.unlisted().into_iter();
    unlisted.find(|it| it.has_faces).map(|it| it.what)
}

/// Whether a mesh has faces of fewer than three corners.
pub(super) fn has_lines(entry: &MeshEntry) -> bool {
    (0..entry.record_count()).any(|record| entry.faces_of(record).is_empty())
}

/// Whether a mesh has positions of more bits than a 32-bit float.
pub(super) fn has_wide_positions(document: &Document, mesh: usize) -> bool {
    use ComponentType::{F64, I32, U32};
    let attributes = document.attributes(mesh);
    let mut positions = attributes.iter().filter(|info| is_position(info));
    positions.any(|info| matches!(info.component_type, F64 | I32 | U32))
}

fn is_position(info: &AttributeInfo) -> bool {
    info.semantic == Semantic::Position && info.morph_target.is_none()
}
