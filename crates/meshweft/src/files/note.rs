//! What a reader says about what it leaves as it is.

use std::fmt::Display;

use super::error::Place;

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
    pub(crate) fn new(place: Place, text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            place,
            text,
            more: 0,
        }
    }

    /// The file has no faces.
    pub(super) fn nothing_to_order() -> Self {
        Self::new(Place::File, "no faces: there is nothing to order")
    }

    /// The faces of a mesh keep their order.
    pub(super) fn faces_stay(place: Place, why: impl Display) -> Self {
        Self::new(place, format!("the faces stay where they are: {why}"))
    }

    /// The faces of a mesh keep their order, because they are transparent.
    pub(super) fn transparent(place: Place, why: &str) -> Self {
        let why = format!(
            "{why}, so each is drawn over those before it; reorder_transparent lets them move"
        );
        Self::faces_stay(place, why)
    }

    /// The vertices of a mesh keep their order.
    pub(super) fn vertices_stay(place: Place, why: impl Display) -> Self {
        Self::new(place, format!("the vertices stay where they are: {why}"))
    }
}
