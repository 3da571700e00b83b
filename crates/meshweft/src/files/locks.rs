//! Folders are locked while several files change together, so that two writers do not mix theirs.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;
use std::{fs, io, thread};

/// How long to wait before a folder is tried again, and how often: half a minute in all.
const PAUSE: Duration = Duration::from_millis(20);
const MOST_TRIES: u32 = 1500;

/// Keeps other writers of files that belong together out of some folders, until it is dropped.
///
/// Advisory, for every thread and process that asks; where a system cannot lock folders, nothing is locked.
pub(super) struct FolderLocks {
    _folders: Vec<fs::File>,
}

impl FolderLocks {
    /// Waits for the folders, given by their real paths.
    ///
    /// # Errors
    /// One is locked by somebody else for half a minute.
    pub(super) fn of(folders: BTreeSet<PathBuf>) -> io::Result<Self> {
        let mut locked = Vec::new();
        let mut seen = BTreeSet::new();
        // All take them in the order of their names, so nobody waits for one that waits for him.
        for path in folders {
            let Ok(folder) = fs::File::open(&path) else {
                continue;
            };
            // One folder may have two names, and is locked once.
            if !seen.insert(identity(&folder, &path)) {
                continue;
            }
            let mut tries = 0;
            let is_locked = loop {
                match folder.try_lock() {
                    Ok(()) => break true,
                    Err(fs::TryLockError::Error(_)) => break false,
                    Err(fs::TryLockError::WouldBlock) if tries >= MOST_TRIES => {
                        return Err(io::Error::new(
                            io::ErrorKind::ResourceBusy,
                            format!(
                                "another program has locked the folder {}: try again when it is done",
                                path.display()
                            ),
                        ));
                    }
                    Err(fs::TryLockError::WouldBlock) => thread::sleep(PAUSE),
                }
                tries += 1;
            };
            if is_locked {
                locked.push(folder);
            }
        }
        Ok(Self { _folders: locked })
    }
}

/// What tells an open folder from all others.
#[cfg(unix)]
fn identity(folder: &fs::File, path: &std::path::Path) -> (u64, u64, PathBuf) {
    use std::os::unix::fs::MetadataExt;
    match folder.metadata() {
        Ok(data) => (data.dev(), data.ino(), PathBuf::new()),
        Err(_) => (0, 0, path.to_owned()),
    }
}

#[cfg(not(unix))]
fn identity(_: &fs::File, path: &std::path::Path) -> (u64, u64, PathBuf) {
    (0, 0, path.to_owned())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn one_folder_under_two_names_is_locked_once() {
        let folder = std::env::temp_dir().join(format!("meshweft-locks-{}", std::process::id()));
        fs::create_dir_all(folder.join("below")).unwrap();
        let names = [folder.clone(), folder.join("below/..")];
        let locks = FolderLocks::of(BTreeSet::from(names)).unwrap();
        assert_eq!(locks._folders.len(), 1);
        let other = fs::File::open(&folder).unwrap();
        assert!(other.try_lock().is_err());
        drop(locks);
        assert!(other.try_lock().is_ok());
        fs::remove_dir_all(&folder).unwrap();
    }
}
