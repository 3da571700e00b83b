//! A document is written: to a disk, or to memory.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::{fs, io};

use super::companions::{self, Copied};
use super::content::{OutputFile, OutputPlace, WriteFile};
use super::disk::{
    copy_file, gzip_encoder, holds, is_gzip, remove, remove_abandoned_below, write_files,
};
use super::document::{Document, folder_of};
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::format::{Format, ending};
use super::gltf;
use super::links::{
    Stamp, check_link, check_stays_in_folder, is_read_only, is_same_folder, other_names, real_path,
    spelled_out,
};
use super::locks::FolderLocks;
use super::note::Note;
use super::outputs::Outputs;
use super::placing::{Beside, Placed, Placement, is_made_here};
use crate::limits::Limits;

/// What [`Document::write_with`] may do.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct WriteOptions<'a> {
    /// Copy the [companions](Document::companions) along, if the output is in another folder.
    pub copy_companions: bool,
    /// Replace the file that has the name of the output.
    pub replace_existing: bool,
    /// Replace files that are read-only.
    pub replace_read_only: bool,
    /// The outputs of the run that this one is part of: nothing else is put in their places.
    pub outputs: Option<&'a Outputs>,
}

impl Default for WriteOptions<'_> {
    /// Companions come along, the output may be there already, and what is read-only stays.
    fn default() -> Self {
        Self {
            copy_companions: true,
            replace_existing: true,
            replace_read_only: false,
            outputs: None,
        }
    }
}

impl WriteOptions<'_> {
    /// Refuses an output whose name something has, if that is not to be replaced.
    pub(super) fn check_existing(&self, path: &Path) -> Result<(), Problem> {
        match !self.replace_existing && fs::symlink_metadata(path).is_ok() {
            true => Err(FileErrorKind::Exists.at(Place::File)),
            false => Ok(()),
        }
    }
}

/// What [`Document::write`] has written.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Written {
    /// The files, the main one last.
    pub files: Vec<PathBuf>,
    /// The size of all of them as they stand on the disk.
    pub bytes: u64,
    /// Those beside the main file that have another name than the document read them by: what it was, and
    /// what it is, in the folder of the main file.
    pub renamed: Vec<(PathBuf, String)>,
    /// The companions that are in their places in another folder now: copied, or there before with the same
    /// bytes.
    pub copied: Vec<PathBuf>,
    /// What was left as it was, and why.
    pub notes: Vec<Note>,
}

impl Written {
    /// The files with their sizes; what lay beside the source already is not part of it.
    fn of(files: Vec<OutputFile<'_>>, sizes: Vec<u64>, is_beside: bool) -> Self {
        let main = files.len().saturating_sub(1);
        let sized = files.into_iter().zip(sizes).enumerate();
        let is_part = |(number, (file, _)): &(usize, (OutputFile<'_>, u64))| {
            !is_beside || file.place != OutputPlace::Occupied || *number == main
        };
        let part = sized
            .filter(is_part)
            .map(|(_, (file, size))| (file.path, size));
        let (files, sizes): (_, Vec<u64>) = part.unzip();
        Self {
            files,
            bytes: sizes.iter().sum(),
            renamed: Vec::new(),
            copied: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl Document {
    /// Writes the file, the buffers beside it, and into another folder copies of its companions, as
    /// [`write_with`](Self::write_with) does by default.
    ///
    /// # Errors
    /// As there.
    pub fn write(&self, path: &Path) -> Result<Written, FileError> {
        self.write_with(path, &WriteOptions::default())
    }

    /// Writes the file and the buffers beside it, so that whenever this ends, what was there is whole, or
    /// what is new is. No file is replaced but `path` and the buffers that the file at `path`, and no other
    /// glTF around it, names. Folders are made.
    ///
    /// In the folder that its buffers were read from, those that have not changed are left alone. Another
    /// buffer keeps its name if it is the only file that changes and no other glTF names it, or if nothing
    /// has that name; else it is called `name.bin` after `path`, or `name.0123abcd.bin` after what is in it.
    /// Of the buffers that the file at `path` named before, and now does not, those with such digits are
    /// removed, unless another glTF names them; others stay. Who names a buffer is found as by
    /// [`shared_buffers`](super::shared_buffers); a file in the folder that cannot be read may name any.
    ///
    /// [Companions](Self::companions) are copied to the same places below the other folder. None of them
    /// replaces a file; what could not be copied is noted.
    ///
    /// Several writers of one folder wait for each other, in this process and in others, where the system
    /// can lock folders. A name that ends in `.gz` is compressed, and so is a file that was read compressed
    /// under a name without `.gz`; a compressed file that has not changed is copied.
    ///
    /// # Errors
    /// [`FileError`] if a file cannot be written, or `path` says another format and does not end as the name
    /// that it was read under, or is a link that leads
    /// elsewhere, or a file that would be replaced has changed since it was read; of kind
    /// [`FileErrorKind::ReadOnly`] if a read-only file would be replaced, [`FileErrorKind::Exists`] if any
    /// would and the options say no.
    pub fn write_with(
        &self,
        path: &Path,
        options: &WriteOptions<'_>,
    ) -> Result<Written, FileError> {
        let in_file = |problem: Problem| problem.in_file(path, Some(self.format));
        let failed = |(path, error): (PathBuf, io::Error)| {
            let problem = FileErrorKind::Io(error).at(Place::File);
            problem.in_file(&path, Some(self.format))
        };
        if !self.may_be_called(path) {
            let feature = format!(
                "a {} file stays one: give the output the same ending as {}",
                self.format,
                self.path.display()
            );
            return Err(in_file(FileErrorKind::unsupported(feature).at(Place::File)));
        }

        options.check_existing(path).map_err(in_file)?;

        // What it is replaced by, if only one file is written.
        let beside = self.content.beside();
        let source = self.folder.as_deref();
        let is_beside = source.is_some_and(|folder| is_same_folder(folder, folder_of(path)));
        let main = real_path(path);
        let is_taken = |place: &Path, is_changed: bool| {
            let outputs = options.outputs;
            outputs.is_some_and(|outputs| outputs.keeps_from(&main, place, is_changed))
        };
        let mut copied = Copied::default();
        if let Some(source) = source.filter(|_| !is_beside) {
            // It would name another file than its own.
            let needed = companions::copy(&self.content.unread(), source, path, &is_taken);
            if let Some(note) = needed.map_err(failed)?.notes.into_iter().next() {
                let feature = format!(
                    "{}, but its meshes are in it: choose another output",
                    note.text
                );
                return Err(in_file(FileErrorKind::unsupported(feature).at(Place::File)));
            }
        }
        if let Some(source) = source.filter(|_| options.copy_companions && !is_beside) {
            check_link(path, folder_of(path)).map_err(|error| failed((path.to_owned(), error)))?;
            copied =
                companions::copy(&self.companions(), source, path, &is_taken).map_err(failed)?;
        }
        let mut written = match self.is_to_be_copied(path) {
            true => self.copy_to(path, options)?,
            false => self.write_all(path, &beside, is_beside, &is_taken, options)?,
        };
        written.copied = copied.files;
        written.notes.extend(copied.notes);
        Ok(written)
    }

    /// Whether it is copied instead of written: a compressed file, whose bytes might change otherwise.
    fn is_to_be_copied(&self, path: &Path) -> bool {
        let is_alone = self.content.beside().is_empty() && self.folder.is_some();
        // Where its name does not say that it is compressed, that of the output need not.
        let stays_compressed = self.is_gzip() && (is_gzip(path) || !is_gzip(&self.path));
        !self.is_edited && is_alone && stays_compressed
    }

    fn copy_to(&self, path: &Path, options: &WriteOptions<'_>) -> Result<Written, FileError> {
        check_read_only(path, options)
            .map_err(|problem| problem.in_file(path, Some(self.format)))?;
        let copied = copy_file(&self.path, path, !options.replace_existing);
        let bytes = copied.map_err(|error| {
            // Somebody else may have been faster.
            let there = options.check_existing(path).err();
            let problem = there.unwrap_or_else(|| FileErrorKind::Io(error).at(Place::File));
            problem.in_file(path, Some(self.format))
        })?;
        let mut written = Written::of(Vec::new(), Vec::new(), false);
        (written.files, written.bytes) = (vec![path.to_owned()], bytes);
        Ok(written)
    }

    /// Writes the main file and those `beside` it.
    fn write_all(
        &self,
        path: &Path,
        beside: &[Beside<'_>],
        is_beside: bool,
        is_taken: &dyn Fn(&Path, bool) -> bool,
        options: &WriteOptions<'_>,
    ) -> Result<Written, FileError> {
        let in_file = |problem: Problem| problem.in_file(path, Some(self.format));
        let _locks = self.lock(path, beside).map_err(in_file)?;

        // What is there.
        let is_over = is_beside && real_path(&self.path) == real_path(path);
        self.check_unchanged(path, beside, is_beside, is_over)?;
        let targets = beside.iter().map(|b| path.with_file_name(b.relative));
        remove_abandoned_below(targets, path);
        let (named, note) = self.own_buffers(path, beside, is_over, options);
        let placement = Placement {
            path,
            is_beside,
            is_over,
            named: &named,
            text: self.content.unchanged_text(),
            is_taken,
            real: real_path,
            holds,
        };

        let mut tries = 0;
        loop {
            let placed = placement.place(beside).map_err(in_file)?;
            let mut files = self.content.files(path, &placed).map_err(in_file)?;
            if let Some(main) = files.last_mut().filter(|_| !is_over) {
                main.place = match options.replace_existing {
                    true => OutputPlace::Replaced,
                    false => OutputPlace::Free,
                };
            }
            let replaced = files
                .iter()
                .filter(|file| file.place == OutputPlace::Replaced);
            for file in replaced.clone() {
                check_read_only(&file.path, options)
                    .map_err(|problem| problem.in_file(&file.path, Some(self.format)))?;
            }
            let mut notes: Vec<Note> = replaced.filter_map(other_names_note).collect();
            if let Some(main) = files.last_mut().filter(|_| self.is_gzip_inside(path)) {
                compress(main);
            }

            match write_files(&files) {
                Ok(sizes) => {
                    self.remember(&files);
                    let left_over = placement.left_over(beside, &placed);
                    remove_left_over(not_named(left_over, path), options);
                    let renamed = placement.renamed(beside, &placed);
                    notes.extend(note.filter(|_| !renamed.is_empty()));
                    return Ok(Written {
                        renamed,
                        notes,
                        ..Written::of(files, sizes, is_beside)
                    });
                }
                // Somebody else took a name: look again.
                Err((_, error)) if error.kind() == io::ErrorKind::AlreadyExists && tries < 16 => {
                    options.check_existing(path).map_err(in_file)?;
                    tries += 1;
                }
                Err((path, error)) => {
                    let problem = FileErrorKind::Io(error).at(Place::File);
                    return Err(problem.in_file(&path, Some(self.format)));
                }
            }
        }
    }

    /// Whether a name fits: it says the format, or the same as the name that it was read under.
    fn may_be_called(&self, path: &Path) -> bool {
        let named = Format::of_path(path);
        named == Some(self.format) || ending(path) == ending(&self.path)
    }

    /// Whether it is compressed under a name that does not say so, as it was when it was read.
    fn is_gzip_inside(&self, path: &Path) -> bool {
        self.is_gzip() && !is_gzip(&self.path) && !is_gzip(&real_path(path))
    }

    /// Refuses to write beside files, or over one, that are not those that were read: what somebody else
    /// has changed would be lost, or would not fit.
    fn check_unchanged(
        &self,
        path: &Path,
        beside: &[Beside<'_>],
        is_beside: bool,
        is_over: bool,
    ) -> Result<(), FileError> {
        let own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        let buffers = beside.iter().filter(|_| is_beside);
        let buffers = buffers.map(|buffer| (path.with_file_name(buffer.relative), buffer.stamp));
        let main = is_over.then(|| (path.to_owned(), self.stamp));
        let is_other = |now: Option<Stamp>, read: Stamp| {
            now != Some(read) && !now.is_some_and(|now| own.contains(&now))
        };
        let mut all = buffers.chain(main);
        let other =
            all.find(|(path, read)| read.is_some_and(|read| is_other(Stamp::of(path), read)));
        other.map_or(Ok(()), |(path, _)| {
            let feature = "it has changed since it was read: try again";
            let problem = FileErrorKind::unsupported(feature).at(Place::File);
            Err(problem.in_file(&path, Some(self.format)))
        })
    }

    /// Keeps in mind which files it has written.
    fn remember(&self, files: &[OutputFile<'_>]) {
        let written = files
            .iter()
            .filter(|file| file.place != OutputPlace::Occupied);
        let stamps = written.filter_map(|file| Stamp::of(&file.path));
        let mut own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        own.extend(stamps);
    }

    /// Keeps other writers out of the folders that files go to, if there are files that belong together.
    fn lock(&self, path: &Path, beside: &[Beside<'_>]) -> Result<FolderLocks, Problem> {
        let mut folders = BTreeSet::new();
        if !beside.is_empty() {
            let refused = |error| FileErrorKind::Io(error).at(Place::File);
            check_stays_in_folder(path).map_err(refused)?;
            let folder = folder_of(path);
            fs::create_dir_all(spelled_out(folder)).map_err(refused)?;
            folders.insert(real_path(folder));
            let below = beside.iter();
            let below =
                below.filter_map(|b| path.with_file_name(b.relative).parent().map(real_path));
            folders.extend(below);
        }
        FolderLocks::of(folders).map_err(|error| FileErrorKind::Io(error).at(Place::File))
    }

    /// The buffers that the main file at `path` names, and no other glTF; and what to say if that cannot be
    /// told.
    fn own_buffers(
        &self,
        path: &Path,
        beside: &[Beside<'_>],
        is_over: bool,
        options: &WriteOptions<'_>,
    ) -> (Vec<PathBuf>, Option<Note>) {
        let at = |beside: &Beside<'_>| path.with_file_name(beside.relative);
        let named: Vec<PathBuf> = match is_over {
            // Nothing is replaced, and nothing left over.
            true if !beside.iter().any(|beside| beside.is_changed) => Vec::new(),
            true => beside.iter().map(at).collect(),
            false if beside.is_empty() || !path.exists() => Vec::new(),
            // A file that is not a glTF names nothing.
            false => gltf::external_buffers(path, &Limits::default()).unwrap_or_default(),
        };
        if named.is_empty() {
            return (named, None);
        }
        let known = options
            .outputs
            .map_or_else(Default::default, |run| run.known.clone());
        match gltf::named_by_others(path, &named, known) {
            Ok(others) => {
                let is_own = |buffer: &PathBuf| !others.contains(&real_path(buffer));
                (named.into_iter().filter(is_own).collect(), None)
            }
            Err(other) => {
                let text = format!(
                    "whether {} names a buffer of this file cannot be told: the old buffers stay as \
                     they were",
                    other.display()
                );
                (Vec::new(), Some(Note::new(Place::File, text)))
            }
        }
    }

    /// Every file of the document with its bytes, the main one last: what
    /// [`Surroundings::Memory`](super::Surroundings::Memory) takes. Nothing is compressed, and no disk is
    /// touched.
    ///
    /// The paths are from the folder of `name`, and that of the main file is the last part of it. The
    /// others have the paths by which they were read, and so the text of the main file stays. Only for
    /// another name in the folder of [`path`](Self::path), as it is written, those that have changed
    /// get new names: the files of the source stay whole if these are put beside them.
    ///
    /// # Errors
    /// [`FileError`] if the document cannot be stored under that name.
    ///
    /// # Complexity
    /// Time and space O(bytes of all files).
    pub fn to_bytes(&self, name: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, FileError> {
        let in_file = |problem: Problem| problem.in_file(name, Some(self.format));
        let main = name.file_name().map_or(name, Path::new);
        let beside = self.content.beside();
        let is_beside = folder_of(name) == folder_of(&self.path);
        let placed = match is_beside && name.file_name() != self.path.file_name() {
            false => vec![Placed::New; beside.len()],
            true => {
                let placement = Placement {
                    path: main,
                    is_beside: true,
                    is_over: false,
                    named: &[],
                    text: None,
                    is_taken: &|_, _| false,
                    real: Path::to_owned,
                    holds: |_, _| Err(io::ErrorKind::NotFound.into()),
                };
                placement.place(&beside).map_err(in_file)?
            }
        };

        let files = self.content.files(main, &placed).map_err(in_file)?;
        let with_bytes = |file: OutputFile<'_>| {
            let bytes = bytes_of(&file).map_err(in_file)?;
            Ok((file.path, bytes))
        };
        files.into_iter().map(with_bytes).collect()
    }

    /// The bytes of the main file alone, not compressed; the files beside it keep their names. For
    /// a format without such files this is all there is.
    ///
    /// # Errors
    /// As [`to_bytes`](Self::to_bytes).
    pub fn to_main_bytes(&self) -> Result<Vec<u8>, FileError> {
        let placed = vec![Placed::Stays; self.content.beside().len()];
        let files = self.content.files(&self.path, &placed);
        let bytes = files.and_then(|files| files.last().map_or(Ok(Vec::new()), bytes_of));
        bytes.map_err(|problem| problem.in_file(&self.path, Some(self.format)))
    }
}

/// Refuses to replace a read-only file unasked.
fn check_read_only(path: &Path, options: &WriteOptions<'_>) -> Result<(), Problem> {
    match !options.replace_read_only && is_read_only(path) {
        true => Err(FileErrorKind::ReadOnly.at(Place::File)),
        false => Ok(()),
    }
}

/// Says that a file has other names, which keep the old bytes.
fn other_names_note(file: &OutputFile<'_>) -> Option<Note> {
    let more = other_names(&file.path);
    (more > 0).then(|| {
        let text = format!(
            "{} had {more} more name{} (hard links): what they name stays as it was",
            file.path.display(),
            if more == 1 { "" } else { "s" }
        );
        Note::new(Place::File, text)
    })
}

/// Those of some files that the main file, as it now is, does not name: it may name some that were not
/// there to be read. None, if that cannot be told.
fn not_named(mut files: Vec<PathBuf>, path: &Path) -> Vec<PathBuf> {
    if files.is_empty() {
        return files;
    }
    let Some(named) = gltf::names_of_buffers(path) else {
        return Vec::new();
    };
    let named = named
        .iter()
        .map(|name| real_path(&path.with_file_name(name)));
    let named: BTreeSet<PathBuf> = named.collect();
    files.retain(|file| !named.contains(&real_path(file)));
    files
}

/// Removes buffers that were made and named here.
fn remove_left_over(files: Vec<PathBuf>, options: &WriteOptions<'_>) {
    let is_free =
        |file: &PathBuf| is_made_here(file) && (options.replace_read_only || !is_read_only(file));
    let free: Vec<PathBuf> = files.into_iter().filter(is_free).collect();
    remove(&free);
}

/// Lets a file be written compressed, whatever it is called.
fn compress(file: &mut OutputFile<'_>) {
    let write: Box<WriteFile<'_>> = Box::new(|_| Ok(()));
    let write = std::mem::replace(&mut file.write, write);
    file.write = Box::new(move |sink| {
        let mut encoder = gzip_encoder(sink);
        write(&mut encoder)?;
        encoder.finish().map(drop)
    });
}

fn bytes_of(file: &OutputFile<'_>) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    let written = (file.write)(&mut bytes);
    written.map_err(|error| FileErrorKind::Io(error).at(Place::File))?;
    Ok(bytes)
}
