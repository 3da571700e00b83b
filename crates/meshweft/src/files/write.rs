//! A document is written: to a disk, or to memory.

use std::io;
use std::path::{Path, PathBuf};

use super::content::{OutputFile, OutputPlace};
use super::disk::{holds, is_same_folder, remove, write_files};
use super::document::{Document, folder_of};
use super::error::{FileError, FileErrorKind, Place, Problem};
use super::format::Format;
use super::gltf;
use super::placing::{Placed, Placement, is_made_here};
use crate::limits::Limits;

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
        }
    }
}

impl Document {
    /// Writes the file and the buffers beside it, so that whenever this ends, what was there is whole, or
    /// what is new is. No file is replaced but `path` and the buffers that the file at `path` names.
    ///
    /// In the folder that its buffers were read from, those that have not changed are left alone. Another
    /// buffer keeps its name if it is the only file that changes, or if nothing has that name; else it is
    /// called `name.bin` after `path`, or `name.0123abcd.bin` after what is in it. Of the buffers that the
    /// file at `path` named before, and now does not, those with such digits are removed, unless another
    /// glTF of the folder names them; others stay.
    ///
    /// A name that ends in `.gz` is compressed.
    ///
    /// # Errors
    /// [`FileError`] if a file cannot be written, or `path` is of another format.
    pub fn write(&self, path: &Path) -> Result<Written, FileError> {
        let in_file = |problem: Problem| problem.in_file(path, Some(self.format));
        if Format::of_path(path) != Some(self.format) {
            let feature = format!(
                "a {} file stays one: give the output the same ending as {}",
                self.format,
                self.path.display()
            );
            return Err(in_file(FileErrorKind::unsupported(feature).at(Place::File)));
        }

        // What is there.
        let beside = self.content.beside();
        let folder = self.folder.as_deref();
        let is_beside = folder.is_some_and(|folder| is_same_folder(folder, folder_of(path)));
        let is_over = is_beside && self.path.file_name() == path.file_name();
        let named: Vec<PathBuf> = match is_over {
            true => beside
                .iter()
                .map(|b| path.with_file_name(b.relative))
                .collect(),
            false if beside.is_empty() || !path.exists() => Vec::new(),
            // A file that is not a glTF names nothing; what others name too is not its own.
            false => {
                let named = gltf::external_buffers(path, &Limits::default()).unwrap_or_default();
                let others = gltf::named_by_others(path);
                let is_own =
                    |buffer: &PathBuf| others.as_ref().is_some_and(|o| !o.contains(buffer));
                named.into_iter().filter(is_own).collect()
            }
        };
        let placement = Placement {
            path,
            is_beside,
            is_over,
            named: &named,
            text: self.content.unchanged_text(),
            holds,
        };

        let mut tries = 0;
        loop {
            let placed = placement.place(&beside).map_err(in_file)?;
            let mut files = self.content.files(path, &placed).map_err(in_file)?;
            if let Some(main) = files.last_mut().filter(|_| !is_over) {
                main.place = OutputPlace::Replaced;
            }
            match write_files(&files) {
                Ok(sizes) => {
                    self.remove_left_over(&placement.left_over(&beside, &placed), path);
                    return Ok(Written {
                        renamed: placement.renamed(&beside, &placed),
                        ..Written::of(files, sizes, is_beside)
                    });
                }
                // Somebody else took a name: look again.
                Err((_, error)) if error.kind() == io::ErrorKind::AlreadyExists && tries < 16 => {
                    tries += 1;
                }
                Err((path, error)) => {
                    let problem = FileErrorKind::Io(error).at(Place::File);
                    return Err(problem.in_file(&path, Some(self.format)));
                }
            }
        }
    }

    /// Removes buffers that were made and named here, unless another glTF of the folder may need them.
    fn remove_left_over(&self, files: &[PathBuf], main: &Path) {
        let made: Vec<&PathBuf> = files.iter().filter(|file| is_made_here(file)).collect();
        if made.is_empty() {
            return;
        }
        // One that cannot be read may name anything.
        let Some(others) = gltf::named_by_others(main) else {
            return;
        };
        let free = made.into_iter().filter(|file| !others.contains(*file));
        let free: Vec<PathBuf> = free.cloned().collect();
        remove(&free);
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

fn bytes_of(file: &OutputFile<'_>) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    let written = (file.write)(&mut bytes);
    written.map_err(|error| FileErrorKind::Io(error).at(Place::File))?;
    Ok(bytes)
}
