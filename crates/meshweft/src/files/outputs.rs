//! The outputs of one run, so that none of its documents takes a place of another, whoever comes first.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::document::folder_of;
use super::gltf;
use super::links::real_path;
use super::placing::short_name;

/// The files that the documents of a run are read from and written to, and the buffers that they bring
/// along.
///
/// No buffer and no copy of a companion takes the place of an input or output. Of documents whose buffers
/// have the same place, the first has it, and the others get other names; if these are one file, it stays
/// there for those that do not change it. So the names do not depend on who writes first.
#[derive(Debug, Clone, Default)]
pub struct Outputs {
    /// Inputs and outputs, as all paths here by their real paths.
    places: BTreeSet<PathBuf>,
    /// Where buffers would go under the names that they have.
    wanted: BTreeMap<PathBuf, Wanted>,
    /// Who could call a buffer so, after itself.
    short: BTreeMap<PathBuf, BTreeSet<PathBuf>>,
    /// Which buffers the files around them name, as far as it has been asked.
    pub(super) known: gltf::Known,
}

/// Who would put buffers to one place.
#[derive(Debug, Clone, Default)]
struct Wanted {
    /// The outputs, in the order of the run.
    by: Vec<PathBuf>,
    /// The buffers.
    sources: BTreeSet<PathBuf>,
}

impl Outputs {
    /// Those of a run: the input and the output of each document. Of a glTF that goes to another folder
    /// the JSON is read, within the limits of [`shared_buffers`](super::shared_buffers).
    ///
    /// # Complexity
    /// Time O(bytes of JSON), space O(names).
    pub fn of<'a>(documents: impl IntoIterator<Item = (&'a Path, &'a Path)>) -> Self {
        let mut all = Self::default();
        for (input, output) in documents {
            let main = real_path(output);
            all.places.extend([real_path(input), main.clone()]);
            let short = main.with_file_name(short_name(&main));
            all.short.entry(short).or_default().insert(main.clone());
            if real_path(folder_of(input)) == real_path(folder_of(output)) {
                continue;
            }
            for relative in gltf::buffer_names(input) {
                let place = real_path(&output.with_file_name(&relative));
                let wanted = all.wanted.entry(place).or_default();
                wanted.by.push(main.clone());
                wanted
                    .sources
                    .insert(real_path(&input.with_file_name(relative)));
            }
        }
        all
    }

    /// Whether a buffer or companion of the document that is written to `main` may not be at `place`.
    pub(super) fn keeps_from(&self, main: &Path, place: &Path, is_changed: bool) -> bool {
        if self.places.contains(place) {
            return true;
        }
        let others = |all: &BTreeSet<PathBuf>| all.iter().any(|other| other != main);
        let wanted = self.wanted.get(place);
        match wanted {
            // One that is called so after itself.
            None => self.short.get(place).is_some_and(others),
            Some(wanted) if wanted.by.iter().all(|other| other == main) => false,
            Some(wanted) if wanted.sources.len() == 1 => is_changed,
            Some(wanted) => wanted.by.first().is_some_and(|first| first != main),
        }
    }
}
