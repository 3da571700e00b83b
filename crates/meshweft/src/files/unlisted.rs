//! What a file holds that is neither in its meshes nor in their attributes.
//!
//! Each format says it in its own words. What is only for people or for the reader of the format does not
//! count: comments, header text, how numbers are written.

use std::borrow::Cow;
use std::collections::BTreeMap;

/// Something that a copy of names, positions, faces and listed attributes would not have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Unlisted {
    /// What it is, in the words of the format.
    pub(crate) what: String,
    /// Whether these are faces, without which no copy is whole.
    pub(crate) has_faces: bool,
}

impl Unlisted {
    /// Something other than faces.
    pub(super) fn other(what: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            has_faces: false,
        }
    }
}

/// Kinds that are named; of others it is only said that they are there.
const MOST_KINDS: usize = 16;

/// What is found in a file, each kind once.
#[derive(Debug, Default)]
pub(super) struct FoundKinds {
    /// Which of all kinds each was.
    kinds: BTreeMap<Cow<'static, str>, usize>,
    /// Whether there are more kinds.
    has_more: bool,
    /// The first faces that are in no mesh.
    faces: Option<String>,
}

impl FoundKinds {
    /// Adds a kind, if it is not known yet.
    pub(super) fn add(&mut self, what: &'static str) {
        if !self.kinds.contains_key(what) {
            self.insert(what.into());
        }
    }

    /// As [`add`](Self::add), of a kind that is named after the file.
    pub(super) fn add_named(&mut self, what: String) {
        if !self.kinds.contains_key(what.as_str()) {
            self.insert(what.into());
        }
    }

    fn insert(&mut self, what: Cow<'static, str>) {
        match self.kinds.len() {
            MOST_KINDS => self.has_more = true,
            next => {
                self.kinds.insert(what, next);
            }
        }
    }

    /// Faces that are in no mesh.
    pub(super) fn add_faces(&mut self, what: String) {
        self.faces.get_or_insert(what);
    }

    /// All of it, as it was found.
    pub(super) fn into_list(self) -> Vec<Unlisted> {
        let mut kinds: Vec<_> = self.kinds.into_iter().collect();
        kinds.sort_by_key(|&(_, number)| number);

        let faces = self.faces.into_iter().map(|what| Unlisted {
            what,
            has_faces: true,
        });
        let kinds = kinds.into_iter().map(|(what, _)| Unlisted::other(what));
        let more = self
            .has_more
            .then(|| Unlisted::other("more of other kinds"));
        faces.chain(kinds).chain(more).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_named_once_and_not_without_end() {
        let mut found = FoundKinds::default();
        found.add("b");
        for number in 0..20 {
            found.add("a");
            found.add_named(format!("c{number}"));
        }
        found.add_faces("a strip".to_owned());
        found.add_faces("another".to_owned());
        let list = found.into_list();
        let named: Vec<&str> = list.iter().map(|it| it.what.as_str()).collect();
        assert_eq!(named[..4], ["a strip", "b", "a", "c0"]);
        assert_eq!(*named.last().unwrap(), "more of other kinds");
        assert_eq!(named.len(), 1 + MOST_KINDS + 1);
        assert!(list.iter().skip(1).all(|it| !it.has_faces) && list[0].has_faces);
    }
}
