//! What holds for a face: the statements above it that stay in force.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Statements that say something of all faces below them, until the next one of their kind.
const KINDS: [&[u8]; 14] = [
    b"g",
    b"o",
    b"s",
    USEMTL,
    b"usemap",
    b"mg",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
];

const USEMTL: &[u8] = b"usemtl";

/// What a statement of one kind said last.
#[derive(Clone, Default, PartialEq, Eq)]
struct Setting {
    /// Its text after the keyword.
    text: Option<Range<usize>>,
    /// How many libraries stood above it: a name may mean something else after one more.
    libraries: usize,
}

/// The state of the faces at one place of a file, and that of the last face above it.
pub(super) struct FaceState<'a> {
    source: &'a [u8],
    now: [Setting; KINDS.len()],
    at_last_face: [Setting; KINDS.len()],
    /// Whether a setting may differ from that of the last face.
    is_touched: bool,
    /// What `mtllib` named, and where first.
    pub(super) libraries: BTreeMap<&'a [u8], usize>,
    /// What `maplib` named.
    map_libraries: BTreeSet<&'a [u8]>,
}

impl<'a> FaceState<'a> {
    pub(super) fn new(source: &'a [u8]) -> Self {
        Self {
            source,
            now: Default::default(),
            at_last_face: Default::default(),
            is_touched: false,
            libraries: BTreeMap::new(),
            map_libraries: BTreeSet::new(),
        }
    }

    /// Takes a statement with the text `rest` after its keyword; `false` if it does not hold for
    /// faces.
    pub(super) fn set(&mut self, keyword: &[u8], rest: Range<usize>) -> bool {
        match keyword {
            b"mtllib" => {
                let at = rest.start;
                self.libraries.entry(&self.source[rest]).or_insert(at);
                return true;
            }
            b"maplib" => {
                self.map_libraries.insert(&self.source[rest]);
                return true;
            }
            _ => {}
        }
        let Some(kind) = KINDS.iter().position(|&kind| kind == keyword) else {
            return false;
        };
        let setting = Setting {
            text: Some(rest),
            libraries: match keyword {
                USEMTL => self.libraries.len(),
                b"usemap" => self.map_libraries.len(),
                _ => 0,
            },
        };
        if !self.is_same(&self.now[kind], &setting) {
            self.now[kind] = setting;
            self.is_touched = true;
        }
        true
    }

    /// Whether the state is that of the last face.
    pub(super) fn is_that_of_last_face(&self) -> bool {
        let mut pairs = self.now.iter().zip(&self.at_last_face);
        !self.is_touched || pairs.all(|(now, last)| self.is_same(now, last))
    }

    /// Whether a face here has the state of the last one; it is the last one from now on.
    ///
    /// Compares only the texts of statements that came since: O(their bytes) in all.
    pub(super) fn continues(&mut self) -> bool {
        let is_same = self.is_that_of_last_face();
        self.is_touched = false;
        if !is_same {
            self.at_last_face.clone_from(&self.now);
        }
        is_same
    }

    /// The material that holds here.
    pub(super) fn material(&self) -> Option<&'a [u8]> {
        let kind = KINDS.iter().position(|&kind| kind == USEMTL)?;
        let text = self.now[kind].text.clone()?;
        Some(&self.source[text])
    }

    /// All that holds here, as a value: the same for the same.
    pub(super) fn value(&self) -> Vec<(Option<&'a [u8]>, usize)> {
        let settings = self.now.iter();
        let value = settings.map(|setting| {
            let text = setting.text.clone().map(|text| &self.source[text]);
            (text, setting.libraries)
        });
        value.collect()
    }

    fn is_same(&self, a: &Setting, b: &Setting) -> bool {
        let text = |setting: &Setting| setting.text.clone().map(|text| &self.source[text]);
        a == b || (a.libraries == b.libraries && text(a) == text(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether each `f` of a text has the state of the one above it.
    fn continued(text: &str) -> Vec<bool> {
        let mut state = FaceState::new(text.as_bytes());
        let mut continued = Vec::new();
        let mut at = 0;
        for line in text.split_inclusive(';') {
            let (keyword, rest) = line.trim_end_matches(';').split_once(' ').unwrap();
            let start = at + keyword.len() + 1;
            match keyword {
                "f" => continued.push(state.continues()),
                _ => assert!(state.set(keyword.as_bytes(), start..start + rest.len())),
            }
            at += line.len();
        }
        continued
    }

    #[test]
    fn states_are_compared_by_value() {
        let same = "usemtl a;f 1;usemtl a;f 2;usemtl b;usemtl a;f 3;";
        assert_eq!(continued(same), [false, true, true]);
        let back = "usemtl a;f 1;usemtl b;f 2;usemtl a;f 3;s 1;f 4;s 1;f 5;s off;f 6;";
        assert_eq!(continued(back), [false, false, false, false, true, false]);
        assert_eq!(continued("f 1;g a;f 2;g a;f 3;"), [true, false, true]);
    }

    #[test]
    fn a_name_after_another_library_may_be_another_material() {
        let text = "mtllib a;usemtl x;f 1;mtllib a;usemtl x;f 2;mtllib b;f 3;usemtl x;f 4;";
        assert_eq!(continued(text), [false, true, true, false]);
    }
}
