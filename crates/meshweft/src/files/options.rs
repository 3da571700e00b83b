//! How a file is read: limits, and what to do about what is not known.

use std::path::PathBuf;

use super::error::FileErrorKind;
use crate::limits::Limits;

/// How [`Document::open`](super::Document::open) reads a file; [`Limits`] alone will do, too.
///
/// ```
/// use meshweft::{Limits, files::ReadOptions};
///
/// let mut options = ReadOptions::from(Limits::default());
/// options.assume_order_safe.push("ACME_colours".into());
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// How much is accepted.
    pub limits: Limits,
    /// Refuse a file with something that is not known and may depend on the order of vertices or
    /// faces. Without it, that order is kept, with a [`Note`](super::Note).
    pub strict: bool,
    /// Names of glTF extensions, PLY elements, OBJ statements and first words of OBJ comments that do not
    /// depend on any order, by the word of the caller.
    pub assume_order_safe: Vec<String>,
    /// External buffers whose bytes must stay, because other files read them too: paths beside that of
    /// the document, as [`external_buffers`](super::external_buffers) gives them.
    pub keep_buffers: Vec<PathBuf>,
    /// Let faces of an OBJ cross `g` and `o` lines, so that groups may lose and gain faces.
    /// Materials and smoothing groups are never crossed.
    pub across_groups: bool,
    /// Let transparent faces be moved. They are drawn one over the other in their order, so without this
    /// they keep it, with a note; their vertices may move.
    ///
    /// Transparent is what is drawn with a material of `alphaMode` `BLEND`, in any variant of a glTF; one
    /// whose `.mtl` has `d` below 1, `Tr` above 0 or `map_d`; or one of a VRML file with a `transparency`.
    pub reorder_transparent: bool,
    /// Order triangle strips as faces: where the file is written, they are a list of triangles with the
    /// winding that the strips have, without triangles that have no area by their corners' numbers.
    /// Without this they stay as they are, with a note.
    pub strips_to_lists: bool,
}

impl From<Limits> for ReadOptions {
    fn from(limits: Limits) -> Self {
        Self {
            limits,
            ..Self::default()
        }
    }
}

impl From<&Self> for ReadOptions {
    fn from(options: &Self) -> Self {
        options.clone()
    }
}

impl ReadOptions {
    /// Whether the caller vouches for what has this name.
    pub(super) fn is_assumed_safe(&self, name: &str) -> bool {
        self.assume_order_safe.iter().any(|safe| safe == name)
    }

    /// The error for something unknown, if it is to be refused.
    pub(super) fn refusal(&self, what: &'static str, name: &str) -> Option<FileErrorKind> {
        self.strict.then(|| FileErrorKind::Unknown {
            what,
            name: name.to_owned(),
        })
    }
}
