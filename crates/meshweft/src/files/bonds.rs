//! What keeps records from being left out.

use super::error::{FileErrorKind, Problem};
use super::note::Note;

/// What may be about the faces or vertices that are left out, so that none can be.
#[derive(Debug, Default)]
pub(super) struct Bonds {
    pub(super) of_faces: Option<Note>,
    pub(super) of_vertices: Option<Note>,
}

impl Bonds {
    /// # Errors
    /// Faces or vertices leave that something may be about.
    pub(super) fn check(&self, faces_leave: bool, vertices_leave: bool) -> Result<(), Problem> {
        let faces = self.of_faces.as_ref().filter(|_| faces_leave);
        let vertices = self.of_vertices.as_ref().filter(|_| vertices_leave);
        match faces.or(vertices) {
            Some(note) => {
                let text = format!("none can be left out: {}", note.text);
                Err(FileErrorKind::unsupported(text).at(note.place.clone()))
            }
            None => Ok(()),
        }
    }
}
