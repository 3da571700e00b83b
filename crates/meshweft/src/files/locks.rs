//! Folders are locked while several files change together, so that two writers do not mix theirs.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// Keeps other writers of files that belong together out of some folders, until it is dropped.
///
/// Advisory, for every thread and process that asks; where a system cannot lock folders, nothing is locked.
pub(super) struct FolderLocks {
    _folders: Vec<fs::File>,
}

impl FolderLocks {
    /// Waits for the folders, given by their real paths.
    pub(super) fn of(folders: BTreeSet<PathBuf>) -> Self {
        // All take them in the order of their names, so nobody waits for one that waits for him.
        let opened = folders
            .into_iter()
            .filter_map(|folder| fs::File::open(folder).ok());
        let locked = opened.filter(|folder| folder.lock().is_ok());
        Self {
            _folders: locked.collect(),
        }
    }
}
