//! Which buffers the other glTF files around a document name: no more of these is read than their JSON,
//! and of that no more than a limit.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::value::RawValue;

use super::container::Container;
use super::external_buffers;
use super::json::{string_at, string_end};
use super::uri::{is_of_another_place, path_with_parents, relative_path};
use crate::files::disk::{files_of, folders_of, read_start};
use crate::files::format::Format;
use crate::files::links::{Stamp, real_path};
use crate::limits::Limits;

/// Most bytes of JSON that are read of one file, decompressed.
const MOST_JSON: u64 = 32 << 20;
/// Most bytes of JSON that are read for one answer.
const MOST_JSON_IN_ALL: u64 = 1 << 30;
/// How many folders above that of a glTF are looked at, and the most of those in it.
const LEVELS_ABOVE: usize = 4;
const MOST_FOLDERS_BELOW: usize = 256;
/// Most files that one glTF may name.
const MOST_NAMES: usize = 1 << 16;

/// Of the buffers of these files, those that another glTF names too: each as a path beside the file, as
/// [`ReadOptions::keep_buffers`](crate::files::ReadOptions::keep_buffers) takes it.
///
/// Looked at are the glTF files in the folder of each file, in four above, in those in it, in those of its
/// buffers and in those between; links are followed. Their JSON is read, up to 32 MiB of a file and 1 GiB in
/// all; what cannot be read, or is over that, names nothing here
/// ([`Document::write`](crate::files::Document::write) then leaves the buffers of that folder as they are,
/// and gives the document its own).
///
/// # Complexity
/// Time O(bytes of JSON), space O(names of buffers).
#[must_use]
pub fn shared_buffers<'a>(files: impl IntoIterator<Item = &'a Path>) -> Vec<PathBuf> {
    let mut users = Users::default();
    let mut shared = Vec::new();
    for file in files {
        let is_gltf = is_gltf(file);
        let buffers = is_gltf.then(|| external_buffers(file, &limits()).ok());
        let buffers = buffers.flatten().unwrap_or_default();
        users.look_around(file, &buffers);
        let own = real_path(file);
        shared.extend(buffers.into_iter().filter(|buffer| {
            let of = users.of.get(&real_path(buffer));
            of.is_some_and(|users| users.iter().any(|user| *user != own))
        }));
    }
    shared.sort();
    shared.dedup();
    shared
}

/// What was found out of files before, by their paths: it holds as long as they are the same.
#[derive(Debug, Clone, Default)]
pub(in crate::files) struct Known(Arc<Mutex<BTreeMap<PathBuf, (Stamp, Named)>>>);

/// The real path of a glTF, and those of the buffers that it names; `None` if that cannot be told.
#[derive(Debug, Clone)]
struct Named {
    user: PathBuf,
    buffers: Option<Vec<PathBuf>>,
}

/// Of some buffers of `main`, those that another glTF names, as real paths; what is found out is kept in
/// `known`.
///
/// # Errors
/// A glTF of which this cannot be told, because it cannot be read, or not within limits.
pub(in crate::files) fn named_by_others(
    main: &Path,
    buffers: &[PathBuf],
    known: Known,
) -> Result<BTreeSet<PathBuf>, PathBuf> {
    let mut users = Users {
        known,
        ..Users::default()
    };
    users.look_around(main, buffers);
    let own = real_path(main);
    if let Some(untold) = users.untold.into_iter().find(|file| *file != own) {
        return Err(untold);
    }
    let others = users.of.into_iter();
    let others = others.filter(|(_, users)| users.iter().any(|user| *user != own));
    Ok(others.map(|(buffer, _)| buffer).collect())
}

/// The files that the buffers of a glTF name, as paths from its folder; none of what is not one.
pub(in crate::files) fn buffer_names(path: &Path) -> BTreeSet<PathBuf> {
    let names = is_gltf(path).then(|| names_of_buffers(path)).flatten();
    let mut names = names.unwrap_or_default();
    // What is not below the folder is not its own.
    names.retain(|name| !name.components().any(|part| part == Component::ParentDir));
    names
}

/// The files that the buffers of a glTF name, as paths from its folder, `..` included; `None` if that cannot
/// be told.
pub(in crate::files) fn names_of_buffers(path: &Path) -> Option<BTreeSet<PathBuf>> {
    Users::default().names(path)
}

/// Who names which buffers, as real paths.
#[derive(Default)]
struct Users {
    of: BTreeMap<PathBuf, BTreeSet<PathBuf>>,
    /// Files of which it cannot be told what they name.
    untold: BTreeSet<PathBuf>,
    /// Folders that were looked at, and those of them whose files must be told.
    folders: BTreeMap<PathBuf, bool>,
    /// How many bytes of JSON were read.
    read: u64,
    known: Known,
}

impl Users {
    /// Looks at every folder from which one of the buffers of `main` may be named.
    fn look_around(&mut self, main: &Path, buffers: &[PathBuf]) {
        if buffers.is_empty() {
            return;
        }
        let folder = main.parent().map(real_path).unwrap_or_default();
        let mut folders = BTreeSet::from([folder.clone()]);
        for buffer in buffers {
            let buffer = real_path(buffer);
            let below = buffer.ancestors().skip(1);
            folders.extend(
                below
                    .take_while(|f| f.starts_with(&folder))
                    .map(Path::to_owned),
            );
        }
        for folder in folders {
            self.look_at(&folder, true);
        }
        // From above, and from below by `..`, a buffer may be named too; but what lies there has mostly
        // nothing to do with it.
        for above in folder.ancestors().skip(1).take(LEVELS_ABOVE) {
            self.look_at(above, false);
        }
        for below in folders_of(&folder).into_iter().take(MOST_FOLDERS_BELOW) {
            self.look_at(&below, false);
        }
    }

    fn look_at(&mut self, folder: &Path, is_to_be_told: bool) {
        let before = self.folders.get(folder).copied();
        if before.is_some_and(|was_to_be_told| was_to_be_told || !is_to_be_told) {
            return;
        }
        self.folders.insert(folder.to_owned(), is_to_be_told);

        let mut files = files_of(folder);
        files.retain(|path| is_gltf(path));
        files.sort();
        for file in files {
            let Some(Named { user, buffers }) = self.named(file) else {
                continue;
            };
            match buffers {
                Some(buffers) => {
                    for buffer in buffers {
                        self.of.entry(buffer).or_default().insert(user.clone());
                    }
                }
                None if is_to_be_told => drop(self.untold.insert(user)),
                None => {}
            }
        }
    }

    /// What a glTF names; nothing if it is not a file.
    fn named(&mut self, file: PathBuf) -> Option<Named> {
        let stamp = Stamp::of(&file)?;
        let known = self.known.0.clone();
        let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((before, named)) = known.get(&file)
            && *before == stamp
        {
            return Some(named.clone());
        }
        let names = self.names(&file);
        let real = |name: &PathBuf| real_path(&file.with_file_name(name));
        let named = Named {
            user: real_path(&file),
            buffers: names.map(|names| names.iter().map(real).collect()),
        };
        known.insert(file, (stamp, named.clone()));
        Some(named)
    }

    /// The files that the buffers of a glTF name, as paths from its folder; `None` if that cannot be told.
    fn names(&mut self, path: &Path) -> Option<BTreeSet<PathBuf>> {
        let length = |start: &[u8]| match start.starts_with(b"glTF") {
            // The binary chunk of a GLB may be large, and is of no use here.
            true => Container::json_end(start),
            false => u64::MAX,
        };
        let bytes = read_start(path, &limits(), length).ok()?;
        self.read += bytes.len() as u64;
        if bytes.len() as u64 > MOST_JSON || self.read > MOST_JSON_IN_ALL {
            return None;
        }
        let container = match bytes.starts_with(b"glTF") {
            true => Container::of_start(bytes).ok()?,
            false => Container::of_text(bytes),
        };

        let text = &container.head[container.json.clone()];
        serde_json::from_slice::<&RawValue>(text).ok()?;
        let mut names = BTreeSet::new();
        for uri in buffer_uris(text) {
            let uri = uri?;
            if !is_of_another_place(&uri) {
                // Some go up, which is refused here, but not by other programs.
                names.extend(relative_path(&uri).ok().or_else(|| path_with_parents(&uri)));
            }
            if names.len() > MOST_NAMES {
                return None;
            }
        }
        Some(names)
    }
}

/// One byte more tells that there is more.
fn limits() -> Limits {
    Limits {
        file_bytes: MOST_JSON + 1,
        ..Limits::default()
    }
}

fn is_gltf(path: &Path) -> bool {
    matches!(Format::of_path(path), Some(Format::Gltf | Format::Glb))
}

/// The `uri` of each buffer in sound JSON, without a list of its values: the text may be large.
fn buffer_uris(text: &[u8]) -> impl Iterator<Item = Option<Cow<'_, str>>> {
    let (mut at, mut depth) = (0, 0_usize);
    let mut is_in_buffers = false;
    let mut is_uri = false;
    std::iter::from_fn(move || {
        while let Some(&byte) = text.get(at) {
            let start = at;
            at += 1;
            match byte {
                b'{' | b'[' => depth += 1,
                b'}' | b']' => depth = depth.saturating_sub(1),
                b'"' => {
                    at = string_end(text, start);
                    let after = text[at..].iter().find(|byte| !byte.is_ascii_whitespace());
                    let is_name = after == Some(&b':');
                    match (is_name, depth) {
                        (true, 1) => {
                            is_in_buffers = string_at(text, start).as_deref() == Some("buffers");
                        }
                        // An object in the list.
                        (true, 3) if is_in_buffers => {
                            is_uri = string_at(text, start).as_deref() == Some("uri");
                        }
                        (false, 3) if is_in_buffers && is_uri => {
                            is_uri = false;
                            return Some(string_at(text, start));
                        }
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        None
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uris_of_buffers_are_found_in_any_text() {
        let text = br#" {"uri":"no","buffer":[{"uri":"no"}],
            "b\u0075ffers" : [ {"a":{"uri":"no"},"uri":"a\u002ebin","b":["uri"]}, {"name" : "uri"},
                {"uri" : "b.bin" , "x":"no"}, {"uri":1}, 2],
            "images":[{"uri":"no"}], "buffers":[{"uri":"c"}]} "#;
        let uris: Vec<_> = buffer_uris(text).map(Option::unwrap).collect();
        assert_eq!(uris, ["a.bin", "b.bin", "c"]);
        assert_eq!(buffer_uris(b"[[[\"uri\"]]]").count(), 0);
    }
}
