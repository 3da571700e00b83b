//! One file under several names: links are followed before names are compared, and lead nowhere else.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{fs, io};

/// A folder by a name that is not empty.
pub(super) fn spelled_out(folder: &Path) -> &Path {
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
}

/// The one name of a file, whatever links lead to it; of one that is not there yet, the name that it
/// will have.
pub(super) fn real_path(path: &Path) -> PathBuf {
    let mut there = spelled_out(path);
    let mut missing: Vec<OsString> = Vec::new();
    loop {
        if let Ok(real) = there.canonicalize() {
            return missing
                .into_iter()
                .rev()
                .fold(real, |path, name| path.join(name));
        }
        let (Some(parent), Some(name)) = (there.parent(), there.file_name()) else {
            return path.to_owned();
        };
        missing.push(name.to_owned());
        there = spelled_out(parent);
    }
}

/// Whether these are one folder.
pub(super) fn is_same_folder(a: &Path, b: &Path) -> bool {
    real_path(a) == real_path(b)
}

/// An error if a link at `path`, or on the way from `folder` to it, leads out of the folder or to nothing.
pub(super) fn check_link(path: &Path, folder: &Path) -> io::Result<()> {
    for part in path.ancestors().take_while(|part| *part != folder) {
        if let Some(target) = dangling(part) {
            let text = format!(
                "it is a link to {}, which does not exist: remove the link",
                target.display()
            );
            return Err(io::Error::new(io::ErrorKind::NotFound, text));
        }
    }
    let target = real_path(path);
    match target.starts_with(real_path(folder)) {
        true => Ok(()),
        false => Err(io::Error::other(format!(
            "it is a link out of the folder, to {}: put the file itself there",
            target.display()
        ))),
    }
}

/// Where a link to nothing leads.
pub(super) fn dangling(path: &Path) -> Option<PathBuf> {
    let target = fs::read_link(path).ok()?;
    (!path.exists()).then_some(target)
}

/// An error if `path` is a link to a file of another folder, beside which its buffers would not be.
pub(super) fn check_stays_in_folder(path: &Path) -> io::Result<()> {
    let (target, folder) = (real_path(path), path.parent().unwrap_or(Path::new("")));
    match target.parent() == Some(&real_path(folder)) {
        true => Ok(()),
        false => Err(io::Error::other(format!(
            "it is a link into another folder, to {}: give that name",
            target.display()
        ))),
    }
}

/// How many other names a file has that are not links to it.
pub(super) fn other_names(path: &Path) -> u64 {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        fs::metadata(path).map_or(0, |data| data.nlink().saturating_sub(1))
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        0
    }
}

/// Whether a file may not be written to.
pub(super) fn is_read_only(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|data| data.permissions().readonly())
}

/// What tells that a file is still the one that was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    size: u64,
    modified: Option<SystemTime>,
    /// Another file may have taken its name.
    number: u64,
}

impl Stamp {
    /// That of the file which is there now, if it is one.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let data = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&data);
        #[cfg(not(unix))]
        let number = 0;
        Some(Self {
            size: data.len(),
            modified: data.modified().ok(),
            number,
        })
    }
}
