//! The files that the command line names: one by one, by folder, or by pattern.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result};
use meshweft::files::Format;

use crate::usage::Usage;

/// A file to work on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Input {
    pub(crate) path: PathBuf,
    /// Where it goes below an output folder: its path from the folder that was named, or that a
    /// pattern starts with; of a file that was named, its name.
    pub(crate) relative: PathBuf,
}

/// The files that the names stand for, in the order of the names, each once; sorted within a
/// folder.
///
/// A folder gives every mesh file in it and below, without hidden ones and without those in
/// `except`. A name that has `*`, `?` or `[` and does not exist as a file is a pattern.
///
/// # Errors
/// A folder that cannot be read; a folder or a pattern without a mesh file; a pattern that is none.
pub(crate) fn expand(names: &[PathBuf], except: Option<&Path>) -> Result<Vec<Input>> {
    let except = except.and_then(|folder| fs::canonicalize(folder).ok());
    let mut inputs: Vec<Input> = Vec::new();

    for name in names {
        let before = inputs.len();
        if name.is_dir() {
            add_below(name, Path::new(""), except.as_deref(), &mut inputs)
                .with_context(|| name.display().to_string())?;
        } else if is_pattern(name) {
            add_matching(name, &mut inputs)?;
        } else {
            // A file that is not there is reported when its turn comes.
            let relative = name.file_name().map_or_else(|| name.clone(), PathBuf::from);
            let path = name.clone();
            inputs.push(Input { path, relative });
            continue;
        }

        if inputs.len() == before {
            let name = name.display();
            return Err(Usage(format!("{name}: no mesh file found")).into());
        }
    }

    // A file may be named twice, or be in two of the folders.
    let mut seen = BTreeSet::new();
    inputs.retain(|input| seen.insert(input.path.clone()));
    Ok(inputs)
}

/// Adds the mesh files in the folder `below` of `root`, and deeper, but not those in `except`, a
/// canonical path.
fn add_below(
    root: &Path,
    below: &Path,
    except: Option<&Path>,
    inputs: &mut Vec<Input>,
) -> io::Result<()> {
    let folder = root.join(below);
    if except.is_some() && fs::canonicalize(&folder).ok().as_deref() == except {
        return Ok(());
    }

    // Sorted by name: the system gives them in any order.
    let mut entries = fs::read_dir(&folder)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = entry.file_name();
        if name.as_encoded_bytes().starts_with(b".") {
            continue;
        }

        let relative = below.join(&name);
        // Links to folders are not followed: they may lead in circles.
        if entry.file_type()?.is_dir() {
            add_below(root, &relative, except, inputs)?;
        } else if Format::of_path(&relative).is_some() && entry.path().is_file() {
            let path = root.join(&relative);
            inputs.push(Input { path, relative });
        }
    }
    Ok(())
}

/// Whether a name is a pattern.
fn is_pattern(name: &Path) -> bool {
    has_wildcard(name.as_os_str()) && !name.exists()
}

fn has_wildcard(part: &OsStr) -> bool {
    part.as_encoded_bytes()
        .iter()
        .any(|byte| b"*?[".contains(byte))
}

/// Adds the mesh files that a pattern matches.
fn add_matching(pattern: &Path, inputs: &mut Vec<Input>) -> Result<()> {
    // The folders before the first wildcard are not repeated below the output.
    let is_plain = |part: &Component<'_>| !has_wildcard(part.as_os_str());
    let prefix: PathBuf = pattern.components().take_while(is_plain).collect();
    let parts = pattern.components().skip_while(is_plain);
    let parts = parts.map(|part| Part::new(part.as_os_str(), pattern));
    let parts = parts.collect::<Result<Vec<_>>>()?;

    let mut found = Vec::new();
    add_below_pattern(&prefix, Path::new(""), &parts, &mut found)
        .with_context(|| pattern.display().to_string())?;
    // `**` may lead to a file in several ways.
    let mut seen = BTreeSet::new();
    found.retain(|relative| seen.insert(relative.clone()));
    for relative in found {
        let path = prefix.join(&relative);
        if Format::of_path(&path).is_some() && path.is_file() {
            inputs.push(Input { path, relative });
        }
    }
    Ok(())
}

/// A part of a pattern.
enum Part {
    /// `**`: any number of folders.
    Folders,
    Plain(OsString),
    Name(glob::Pattern),
}

impl Part {
    fn new(part: &OsStr, whole: &Path) -> Result<Self> {
        if !has_wildcard(part) {
            return Ok(Self::Plain(part.to_owned()));
        }
        let wrong = |why: String| Usage(format!("{}: {why}", whole.display()));
        let Some(text) = part.to_str() else {
            let why = "a pattern is UTF-8 text: name the folder, or the files";
            return Err(wrong(why.into()).into());
        };
        if text == "**" {
            return Ok(Self::Folders);
        }
        let pattern = glob::Pattern::new(text).map_err(|error| wrong(error.to_string()))?;
        Ok(Self::Name(pattern))
    }
}

/// Adds what the parts of a pattern match in the folder `below` of `root`, sorted within a folder. What
/// is not UTF-8 in a name is matched by `?` and `*`.
fn add_below_pattern(
    root: &Path,
    below: &Path,
    parts: &[Part],
    found: &mut Vec<PathBuf>,
) -> io::Result<()> {
    let Some((part, rest)) = parts.split_first() else {
        found.push(below.to_owned());
        return Ok(());
    };
    match part {
        Part::Folders => add_below_pattern(root, below, rest, found)?,
        Part::Plain(name) => return add_below_pattern(root, &below.join(name), rest, found),
        Part::Name(_) => {}
    }

    let folder = root.join(below);
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        &folder
    };
    if !folder.is_dir() {
        return Ok(());
    }
    let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = entry.file_name();
        let relative = below.join(&name);
        // As in a folder, and in a shell: what is hidden is named by its dot.
        let is_hidden = name.as_encoded_bytes().starts_with(b".");
        let is_named = matches!(part, Part::Name(pattern) if pattern.as_str().starts_with('.'));
        if is_hidden && !is_named {
            continue;
        }
        match part {
            // Links to folders are not followed: they may lead in circles.
            Part::Folders if entry.file_type()?.is_dir() => {
                add_below_pattern(root, &relative, parts, found)?;
            }
            Part::Folders if rest.is_empty() => found.push(relative),
            Part::Name(pattern) if pattern.matches(&name.to_string_lossy()) => {
                add_below_pattern(root, &relative, rest, found)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Share `index` of `count`, counted from 1: every `count`-th item from that one on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// The items of `all` that belong to this share.
    pub(crate) fn of<T>(self, all: Vec<T>) -> Vec<T> {
        let first = self.index - 1;
        all.into_iter().skip(first).step_by(self.count).collect()
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let parts = parts.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err("write I/N with I from 1 to N, such as 2/8".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_part_the_inputs() {
        let input = |n: usize| Input {
            path: n.to_string().into(),
            relative: n.to_string().into(),
        };
        let all: Vec<Input> = (0..10).map(input).collect();
        let mut parts = Vec::new();
        for shard in ["1/3", "2/3", "3/3"] {
            let shard: Shard = shard.parse().unwrap();
            parts.extend(shard.of(all.clone()));
        }
        assert_eq!(parts.len(), all.len());
        assert!(all.iter().all(|input| parts.contains(input)));
        for bad in ["0/3", "4/3", "1", "a/b", "1/0", "1/2/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
