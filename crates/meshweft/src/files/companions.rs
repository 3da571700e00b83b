//! Files that a document names and that have nothing to do with an order: images, materials. They come
//! along to another folder, and replace nothing there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

use super::disk::{Claim, copy_new, is_same_content, remove_abandoned_below};
use super::error::Place;
use super::links::{check_link, real_path};
use super::note::Note;

/// What became of the files that a document names.
#[derive(Debug, Default)]
pub(super) struct Copied {
    /// Those that are in their places now.
    pub(super) files: Vec<PathBuf>,
    pub(super) notes: Vec<Note>,
}

/// Copies files from a folder to that of `main`, each to the same place below it.
///
/// One that is there with the same bytes is left, and one that cannot be read, or whose place is taken
/// (by another file, or as `is_taken` says of its real path), is noted.
///
/// # Errors
/// What the system says about writing, and of which file.
pub(super) fn copy(
    companions: &[PathBuf],
    from: &Path,
    main: &Path,
    is_taken: &dyn Fn(&Path, bool) -> bool,
) -> Result<Copied, (PathBuf, io::Error)> {
    let mut copied = Copied::default();
    let targets = companions
        .iter()
        .map(|relative| main.with_file_name(relative));
    remove_abandoned_below(targets, main);
    // One note for each reason: a document may name very many.
    let mut left: BTreeMap<String, (PathBuf, usize)> = BTreeMap::new();
    for relative in companions {
        let (source, target) = (from.join(relative), main.with_file_name(relative));
        match place(&source, from, &target, main, is_taken) {
            Ok(Destination::ToCopy) => match copy_new(&source, &target) {
                Ok(Claim::Taken) if !is_same_content(&source, &target).unwrap_or(false) => {
                    leave(&mut left, relative, ANOTHER);
                }
                Ok(Claim::Taken | Claim::Done) => copied.files.push(target),
                Err(error) => return Err((target, error)),
            },
            Ok(Destination::There) => copied.files.push(target),
            Ok(Destination::Left(why)) => leave(&mut left, relative, &why),
            Err(error) => return Err((source, error)),
        }
    }

    copied.notes = left
        .into_iter()
        .map(|(why, (first, more))| Note {
            more,
            ..Note::new(
                Place::File,
                format!("{} is not copied: {why}", first.display()),
            )
        })
        .collect();
    Ok(copied)
}

/// Why a file stays where it is whose place is taken.
const ANOTHER: &str = "another file of this name is there";

fn leave(left: &mut BTreeMap<String, (PathBuf, usize)>, relative: &Path, why: &str) {
    match left.get_mut(why) {
        Some((_, more)) => *more += 1,
        None => drop(left.insert(why.to_owned(), (relative.to_owned(), 0))),
    }
}

/// What there is where a file is to be copied to.
enum Destination {
    ToCopy,
    /// It has been copied before.
    There,
    /// It is not copied, and why.
    Left(String),
}

/// Whether a file is to be copied.
///
/// # Errors
/// It may be there, but the system cannot read it now.
fn place(
    source: &Path,
    from: &Path,
    target: &Path,
    main: &Path,
    is_taken: &dyn Fn(&Path, bool) -> bool,
) -> io::Result<Destination> {
    let left = |why: String| Ok(Destination::Left(why));

    // The source: a file that can be read.
    if let Err(error) = check_link(source, from) {
        return left(error.to_string());
    }
    let opened = fs::metadata(source).and_then(|data| match data.is_file() {
        true => fs::File::open(source).map(|_| true),
        false => Ok(false),
    });
    match opened {
        Ok(true) => {}
        Ok(false) => return left("it is not a file".into()),
        Err(error) => {
            return match error.kind() {
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => {
                    left("it does not exist".into())
                }
                io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidFilename => {
                    left(error.to_string())
                }
                _ => Err(error),
            };
        }
    }

    // Its place: free, or with the same file.
    let folder = main.parent().unwrap_or(Path::new(""));
    if let Err(error) = check_link(target, folder) {
        return left(format!("at its place, {error}"));
    }
    let place = real_path(target);
    if place == real_path(main) || is_taken(&place, false) {
        return left("another output of this run has its name".into());
    }
    if !target.exists() {
        return Ok(Destination::ToCopy);
    }
    match is_same_content(source, target) {
        Ok(true) => Ok(Destination::There),
        Ok(false) => left(ANOTHER.into()),
        Err(error) => left(format!("what has its name cannot be read ({error})")),
    }
}
