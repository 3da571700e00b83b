//! Where the files beside a main file go when a document is written, so that nothing else is replaced
//! and no moment leaves a main file with buffers that are not its own.
//!
//! A write that changes one file is one rename. One that changes more gives each changed file a name
//! that the old main file does not use; the main file, renamed last, then stands for all of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use super::error::{FileErrorKind, Place, Problem};

/// A file beside the main one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside<'a> {
    /// Its path from the folder of the main file.
    pub(super) relative: &'a Path,
    pub(super) bytes: &'a [u8],
    pub(super) is_changed: bool,
}

/// What becomes of a file beside the main one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Placed {
    /// It is there already.
    Stays,
    /// It is written under its own name, which nothing has.
    New,
    /// It is written under its own name, over a file of the same document.
    Replaces,
    /// It is named like this, in the folder of the main file.
    Renamed {
        name: String,
        /// Whether it is there already, under that name.
        is_there: bool,
    },
}

impl Placed {
    /// Its path from the folder of the main file.
    pub(super) fn path<'a>(&'a self, beside: &Beside<'a>) -> &'a Path {
        match self {
            Self::Renamed { name, .. } => Path::new(name),
            _ => beside.relative,
        }
    }
}

/// Where a document goes on a disk.
pub(super) struct Placement<'a> {
    /// The main file.
    pub(super) path: &'a Path,
    /// Whether the document was read from the folder of the main file, and whether from that file.
    pub(super) is_beside: bool,
    pub(super) is_over: bool,
    /// The files that the main file which is there names, as paths beside it.
    pub(super) named: &'a [PathBuf],
    /// The text of the main file, if it does not change but for the names of others.
    pub(super) text: Option<&'a [u8]>,
    /// Whether the file at a path holds these bytes.
    pub(super) holds: fn(&Path, &[u8]) -> io::Result<bool>,
}

impl Placement<'_> {
    /// What becomes of each.
    ///
    /// # Errors
    /// A file has to be renamed and the name would not be UTF-8, or one that is there cannot be read.
    pub(super) fn place(&self, all: &[Beside<'_>]) -> Result<Vec<Placed>, Problem> {
        let is_path = |beside: &Beside<'_>| self.path.with_file_name(beside.relative) == self.path;
        if self.is_beside && all.iter().any(is_path) {
            return Err(name_of_a_buffer(self.path));
        }

        let mut placed = Vec::with_capacity(all.len());
        for beside in all {
            placed.push(match self.alone(beside) {
                Some(placed) => placed,
                None => self.with_new_name(beside, all)?,
            });
        }

        // One file changes in one rename.
        let is_renamed = |placed: &Placed| matches!(placed, Placed::Renamed { .. });
        let changes_text = placed.iter().any(is_renamed) || self.changes_text();
        let replaced = placed.iter().filter(|placed| **placed == Placed::Replaces);
        if replaced.count() > usize::from(!changes_text) {
            for (placed, beside) in placed.iter_mut().zip(all) {
                if *placed == Placed::Replaces {
                    *placed = self.with_new_name(beside, all)?;
                }
            }
        }
        Ok(placed)
    }

    /// The files that the main file named and no longer names, as paths beside it.
    pub(super) fn left_over(&self, all: &[Beside<'_>], placed: &[Placed]) -> Vec<PathBuf> {
        let at = |relative: &Path| self.path.with_file_name(relative);
        let pairs = all.iter().zip(placed);
        let mut kept: BTreeSet<PathBuf> = pairs.map(|(b, placed)| at(placed.path(b))).collect();
        if self.is_beside && !self.is_over {
            // The source has them still.
            kept.extend(all.iter().map(|beside| at(beside.relative)));
        }
        let named = self.named.iter().filter(|&named| !kept.contains(named));
        named.cloned().collect()
    }

    /// What files were called, and what they are called now.
    pub(super) fn renamed(&self, all: &[Beside<'_>], placed: &[Placed]) -> Vec<(PathBuf, String)> {
        let pairs = all.iter().zip(placed);
        let renamed = pairs.filter_map(|(beside, placed)| match placed {
            Placed::Renamed { name, .. } => Some((beside.relative.to_owned(), name.clone())),
            Placed::Stays | Placed::New | Placed::Replaces => None,
        });
        renamed.collect()
    }

    /// Whether the main file changes, even if all others keep their names.
    fn changes_text(&self) -> bool {
        match self.text {
            Some(text) => !self.is_over && !(self.holds)(self.path, text).unwrap_or(false),
            None => true,
        }
    }

    /// What becomes of a file if no other changes; `None` if it needs another name.
    fn alone(&self, beside: &Beside<'_>) -> Option<Placed> {
        let there = self.path.with_file_name(beside.relative);
        // In the folder that it came from, it is there.
        if self.is_beside && !beside.is_changed {
            return Some(Placed::Stays);
        }
        let is_named = self.named.contains(&there);
        if self.is_beside {
            return (self.is_over && is_named).then_some(Placed::Replaces);
        }
        match (self.holds)(&there, beside.bytes) {
            Ok(true) => Some(Placed::Stays),
            Ok(false) => is_named.then_some(Placed::Replaces),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Some(Placed::New),
            // It cannot be read, so it cannot be told whose it is.
            Err(_) => None,
        }
    }

    /// A name that says whose it is, or else what is in it: nobody uses it for anything else.
    fn with_new_name(&self, beside: &Beside<'_>, all: &[Beside<'_>]) -> Result<Placed, Problem> {
        let name = self.path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| {
            let feature = "the name of a buffer beside the output would not be UTF-8 text: choose \
                           another name";
            FileErrorKind::unsupported(feature).at(Place::File)
        })?;
        // Characters that URIs of files cannot have.
        let stem = stem(name).replace([':', '\\'], "_");

        // The short name, unless the old main file, or the document, calls something else so.
        let renamed =
            |name: String| match (self.holds)(&self.path.with_file_name(&name), beside.bytes) {
                Ok(true) => Some(Placed::Renamed {
                    name,
                    is_there: true,
                }),
                Err(error) if error.kind() == io::ErrorKind::NotFound => Some(Placed::Renamed {
                    name,
                    is_there: false,
                }),
                Ok(false) | Err(_) => None,
            };
        let plain = format!("{stem}.bin");
        let others = all.iter().filter(|other| other.relative != beside.relative);
        let is_of_another = others
            .clone()
            .any(|other| other.relative == Path::new(&plain));
        let is_single = !others.clone().any(|other| other.is_changed);
        if is_single
            && !is_of_another
            && !self.is_over
            && let Some(placed) = renamed(plain)
        {
            return Ok(placed);
        }

        // Eight digits of what is in it, more if another file has them.
        let digits = format!("{:016x}", content_hash(beside.bytes));
        let names = (8..=digits.len()).map(|length| format!("{stem}.{}.bin", &digits[..length]));
        let of_another = |name: &String| all.iter().any(|other| other.relative == Path::new(name));
        let mut free = names.filter(|name| !of_another(name)).filter_map(renamed);
        free.next().ok_or_else(|| {
            let feature = format!(
                "every name like {stem}.{}.bin is taken: move those files",
                &digits[..8]
            );
            FileErrorKind::unsupported(feature).at(Place::File)
        })
    }
}

/// The error for a main file with the name of one beside it.
pub(super) fn name_of_a_buffer(path: &Path) -> Problem {
    let feature = format!(
        "{} is the name of a buffer of the file: choose another for the output",
        path.display()
    );
    FileErrorKind::unsupported(feature).at(Place::File)
}

/// A file name without what says its format.
fn stem(name: &str) -> &str {
    // Only the endings are cut: `scene.v2.gltf` stays `scene.v2`.
    let lower = name.to_ascii_lowercase();
    let mut endings = [".gltf.gz", ".glb.gz", ".gltf", ".glb"].into_iter();
    match endings.find(|ending| lower.ends_with(ending)) {
        Some(ending) => &name[..name.len() - ending.len()],
        None => name.split_once('.').map_or(name, |(stem, _)| stem),
    }
}

/// Whether a file is called after what is in it: then it was made by [`Placement::place`].
pub(super) fn is_made_here(path: &Path) -> bool {
    let digits = || {
        let name = path.file_name()?.to_str()?.strip_suffix(".bin")?;
        let (_, digits) = name.rsplit_once('.')?;
        Some(digits).filter(|digits| (8..=16).contains(&digits.len()))
    };
    let Some(digits) = digits() else {
        return false;
    };
    let is_file = fs::metadata(path).is_ok_and(|data| data.is_file());
    let bytes = is_file.then(|| fs::read(path).ok()).flatten();
    bytes.is_some_and(|bytes| format!("{:016x}", content_hash(&bytes)).starts_with(digits))
}

/// 64 bits of what is in a file (FNV-1a): the same content has the same name.
fn content_hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
