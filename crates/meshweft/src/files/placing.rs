//! Where the files beside a main file go when a document is written, so that nothing else is replaced
//! and no moment leaves a main file with buffers that are not its own.
//!
//! A write that changes one file is one rename. One that changes more gives each changed file a name
//! that the old main file does not use; the main file, renamed last, then stands for all of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use super::error::{FileErrorKind, Place, Problem};
use super::links::Stamp;

/// A file beside the main one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside<'a> {
    /// Its path from the folder of the main file.
    pub(super) relative: &'a Path,
    pub(super) bytes: &'a [u8],
    pub(super) is_changed: bool,
    /// Which file it was read from.
    pub(super) stamp: Option<Stamp>,
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
    /// The files that the main file which is there names and that may be replaced, as paths beside it.
    pub(super) named: &'a [PathBuf],
    /// The text of the main file, if it does not change but for the names of others.
    pub(super) text: Option<&'a [u8]>,
    /// Whether a file may not take a place, a real path; and whether it has changed.
    pub(super) is_taken: &'a dyn Fn(&Path, bool) -> bool,
    /// The real path of a file.
    pub(super) real: fn(&Path) -> PathBuf,
    /// Whether the file at a path holds these bytes.
    pub(super) holds: fn(&Path, &[u8]) -> io::Result<bool>,
}

impl Placement<'_> {
    /// What becomes of each.
    ///
    /// # Errors
    /// The main file has the name of another, or no name is left for one.
    pub(super) fn place(&self, all: &[Beside<'_>]) -> Result<Vec<Placed>, Problem> {
        let main = (self.real)(self.path);
        let is_path = |beside: &Beside<'_>| (self.real)(&self.at(beside.relative)) == main;
        if self.is_beside && all.iter().any(is_path) {
            return Err(name_of_a_buffer(self.path));
        }

        let own: BTreeSet<PathBuf> = self.named.iter().map(|named| (self.real)(named)).collect();
        let mut placed: Vec<Placed> = Vec::with_capacity(all.len());
        for beside in all {
            placed.push(match self.alone(beside, &own) {
                Some(placed) => placed,
                None => self.with_new_name(beside, all, &placed)?,
            });
        }

        // One file changes in one rename.
        let is_renamed = |placed: &Placed| matches!(placed, Placed::Renamed { .. });
        let changes_text = placed.iter().any(is_renamed) || self.changes_text();
        let replaced = placed.iter().filter(|placed| **placed == Placed::Replaces);
        if replaced.count() > usize::from(!changes_text) {
            for (number, beside) in all.iter().enumerate() {
                if placed[number] == Placed::Replaces {
                    placed[number] = self.with_new_name(beside, all, &placed)?;
                }
            }
        }
        Ok(placed)
    }

    /// The files that the main file named and no longer names, as paths beside it.
    pub(super) fn left_over(&self, all: &[Beside<'_>], placed: &[Placed]) -> Vec<PathBuf> {
        let at = |relative: &Path| (self.real)(&self.at(relative));
        let pairs = all.iter().zip(placed);
        let mut kept: BTreeSet<PathBuf> = pairs.map(|(b, placed)| at(placed.path(b))).collect();
        if self.is_beside && !self.is_over {
            // The source has them still.
            kept.extend(all.iter().map(|beside| at(beside.relative)));
        }
        let left = |named: &&PathBuf| !kept.contains(&(self.real)(named));
        self.named.iter().filter(left).cloned().collect()
    }

    /// Where a file beside the main one is.
    fn at(&self, relative: &Path) -> PathBuf {
        self.path.with_file_name(relative)
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

    /// What becomes of a file if no other changes, where those at the real paths `own` may be replaced;
    /// `None` if it needs another name.
    fn alone(&self, beside: &Beside<'_>, own: &BTreeSet<PathBuf>) -> Option<Placed> {
        let there = self.at(beside.relative);
        // In the folder that it came from, it is there.
        if self.is_beside && !beside.is_changed {
            return Some(Placed::Stays);
        }
        let real = (self.real)(&there);
        let is_named = own.contains(&real);
        if self.is_beside {
            return (self.is_over && is_named).then_some(Placed::Replaces);
        }
        if (self.is_taken)(&real, beside.is_changed) {
            return None;
        }
        match (self.holds)(&there, beside.bytes) {
            Ok(true) => Some(Placed::Stays),
            Ok(false) => is_named.then_some(Placed::Replaces),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Some(Placed::New),
            // It cannot be read, so it cannot be told whose it is.
            Err(_) => None,
        }
    }

    /// A name that says whose it is, or else what is in it: nobody uses it for anything else, and none of
    /// those that are `placed` has it.
    fn with_new_name(
        &self,
        beside: &Beside<'_>,
        all: &[Beside<'_>],
        placed: &[Placed],
    ) -> Result<Placed, Problem> {
        let stem = stem_of(self.path);

        let renamed = |name: String| {
            let there = self.at(Path::new(&name));
            if (self.is_taken)(&(self.real)(&there), beside.is_changed) {
                return None;
            }
            let is_there = match (self.holds)(&there, beside.bytes) {
                Ok(true) => true,
                Err(error) if error.kind() == io::ErrorKind::NotFound => false,
                Ok(false) | Err(_) => return None,
            };
            Some(Placed::Renamed { name, is_there })
        };
        let is_given = |name: &String| {
            let is_it = |placed: &Placed| matches!(placed, Placed::Renamed { name: given, .. } if given == name);
            placed.iter().any(is_it)
        };

        // The short name, unless the old main file, or the document, calls something else so.
        let plain = short_name(self.path);
        let others = all.iter().filter(|other| other.relative != beside.relative);
        let is_of_another = others
            .clone()
            .any(|other| other.relative == Path::new(&plain));
        let is_single = !others.clone().any(|other| other.is_changed);
        if is_single
            && !is_of_another
            && !is_given(&plain)
            && !self.is_over
            && let Some(placed) = renamed(plain)
        {
            return Ok(placed);
        }

        // Eight digits of what is in it, more if another file has them.
        let digits = format!("{:016x}", content_hash(beside.bytes));
        let names = (8..=digits.len()).map(|length| format!("{stem}.{}.bin", &digits[..length]));
        let of_another = |name: &String| {
            all.iter().any(|other| other.relative == Path::new(name)) || is_given(name)
        };
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

/// What a buffer is called after the main file.
pub(super) fn short_name(main: &Path) -> String {
    format!("{}.bin", stem_of(main))
}

/// The name of a main file without what says its format, as part of the name of another.
fn stem_of(main: &Path) -> String {
    let name = main.file_name().unwrap_or_default().to_string_lossy();
    // Characters that URIs of files cannot have, and what is not UTF-8.
    stem(&name).replace([':', '\\', char::REPLACEMENT_CHARACTER], "_")
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
