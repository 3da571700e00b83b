//! The files that a glTF names beside its buffers: images, and what extensions name by a URI.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::json::Value;
use super::object::Object;
use super::uri::{is_of_another_place, relative_path};

/// The files that a glTF names.
#[derive(Default)]
pub(super) struct Companions {
    /// Paths below the folder of the glTF.
    pub(super) files: BTreeSet<PathBuf>,
    /// The first URI that names no file there, why, and how many more there are.
    pub(super) refused: Option<(String, usize)>,
}

impl Companions {
    /// All but the buffers.
    pub(super) fn of(root: &Object) -> Self {
        let mut all = Self::default();
        for (name, value) in root.as_value().members() {
            if name != "buffers" {
                all.member(&name, value);
                continue;
            }
            for buffer in value.elements() {
                let members = buffer.members().filter(|(name, _)| name != "uri");
                members.for_each(|(name, value)| all.member(&name, value));
            }
        }
        all
    }

    /// What a member of an object names, itself or below.
    fn member(&mut self, name: &str, value: Value<'_>) {
        // What is in `extras` means something to one program only.
        if name == "extras" {
            return;
        }
        // As in `images`, or `schemaUri` of EXT_structural_metadata.
        if (name == "uri" || name.ends_with("Uri"))
            && let Some(uri) = value.text()
        {
            self.uri(&uri);
            return;
        }
        self.below(value);
    }

    /// No deeper than the limit for JSON allows.
    fn below(&mut self, value: Value<'_>) {
        value
            .members()
            .for_each(|(name, value)| self.member(&name, value));
        value.elements().for_each(|value| self.below(value));
    }

    fn uri(&mut self, uri: &str) {
        if is_of_another_place(uri) {
            return;
        }
        match (relative_path(uri), &mut self.refused) {
            (Ok(path), _) => drop(self.files.insert(path)),
            (Err(_), Some((_, more))) => *more += 1,
            (Err(why), None) => self.refused = Some((why, 0)),
        }
    }
}
