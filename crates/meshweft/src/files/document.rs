//! A file in memory: its meshes as values, its bytes ready to be patched.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;

use super::error::{FileError, FileErrorKind, Place, Problem};
use super::{Content, Format, MeshEntry, Note, OutputFile, ReadOptions};
use crate::error::MeshError;
use crate::limits::Limits;
use crate::permutation::{FaceOrder, VertexOrder};

/// A mesh file whose faces and vertices can be permuted in place.
///
/// ```no_run
/// use std::path::Path;
/// use meshweft::{CacheModel, Limits, files::Document, order::KCacheReorder};
///
/// let mut document = Document::open(Path::new("scene.glb"), Limits::default())?;
/// let algorithm = KCacheReorder { cache: CacheModel::fifo(12), ..Default::default() };
/// for mesh in 0..document.meshes().len() {
///     let order = document.meshes()[mesh].record_order(|mesh, polygons| match polygons {
///         Some(starts) => algorithm.polygon_order(mesh, starts),
///         None => algorithm.face_order(mesh),
///     });
///     document.apply(mesh, &order, None)?;
/// }
/// document.write(Path::new("ordered.glb"))?;
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
pub struct Document {
    path: PathBuf,
    format: Format,
    content: Box<dyn Content>,
    notes: Vec<Note>,
}

impl Document {
    /// Reads the file and everything it refers to that holds vertices or faces.
    ///
    /// A name that ends in `.gz` is decompressed first.
    ///
    /// # Errors
    /// [`FileError`]: the file cannot be read, is of no known format, is not sound, or is over a
    /// limit.
    pub fn open(path: &Path, options: impl Into<ReadOptions>) -> Result<Self, FileError> {
        let options = options.into();
        let format = Format::of_path(path);
        let in_file = |kind: FileErrorKind| kind.at(Place::File).in_file(path, format);
        let known = format.ok_or_else(|| in_file(FileErrorKind::UnknownFormat))?;
        let bytes = read_limited(path, &options.limits).map_err(in_file)?;
        Self::from_bytes(bytes, known, path, options)
    }

    /// Reads a file that is in memory already; `path` names it in errors, and is where the external
    /// buffers of a glTF are looked for.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn from_bytes(
        bytes: Vec<u8>,
        format: Format,
        path: &Path,
        options: impl Into<ReadOptions>,
    ) -> Result<Self, FileError> {
        let options = &options.into();
        let read = match format {
            Format::Gltf | Format::Glb => super::gltf::read(bytes, format, path, options),
            Format::Obj => super::obj::read(bytes, options),
            Format::Ply => super::ply::read(bytes, options),
            Format::Off => super::off::read(bytes, &options.limits),
            Format::Stl => super::stl::read(bytes, &options.limits),
            Format::Vrml => super::vrml::read(bytes, &options.limits),
        };
        let (content, notes) = read.map_err(|problem| problem.in_file(path, Some(format)))?;
        Ok(Self {
            path: path.to_owned(),
            format,
            content,
            notes,
        })
    }

    /// The path it was read from.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// The meshes that can be re-ordered, as they now are.
    #[must_use]
    pub fn meshes(&self) -> &[MeshEntry] {
        self.content.meshes()
    }

    /// What is left as it is, and why.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Permutes the face records of a mesh, and its vertices too if an order for them is given.
    ///
    /// The vertex order is of the vertices as they are now; it renumbers every mesh of the same
    /// [`vertex_group`](MeshEntry::vertex_group).
    ///
    /// # Errors
    /// [`FileErrorKind::Order`] or [`FileErrorKind::Unsupported`] if the order is of another
    /// length, moves a record out of its run, turns corners that must stay, or moves vertices that
    /// must stay. Nothing is changed then.
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn apply(
        &mut self,
        mesh: usize,
        faces: &FaceOrder,
        vertices: Option<&VertexOrder>,
    ) -> Result<(), FileError> {
        check_order(&self.meshes()[mesh], faces, vertices)
            .map_err(|kind| kind.at(Place::File).in_file(&self.path, Some(self.format)))?;
        self.content.apply(mesh, faces, vertices);
        Ok(())
    }

    /// Writes the file, and the buffers beside it, each under a temporary name that is then
    /// renamed: what was there before is whole until the new file is.
    ///
    /// A name that ends in `.gz` is compressed.
    ///
    /// # Errors
    /// [`FileError`] if a file cannot be written, or `path` is of another format.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let in_file = |problem: Problem| problem.in_file(path, Some(self.format));
        if Format::of_path(path) != Some(self.format) {
            let feature = format!(
                "a {} file stays one: give the output the same ending as {}",
                self.format,
                self.path.display()
            );
            return Err(in_file(FileErrorKind::unsupported(feature).at(Place::File)));
        }
        let io = |path: &Path, error| {
            let problem = FileErrorKind::Io(error).at(Place::File);
            problem.in_file(path, Some(self.format))
        };
        for file in self.content.files(path).map_err(in_file)? {
            // Buffers of a glTF may stand in folders below that of the main file.
            if let Some(folder) = file.path.parent().filter(|_| file.path != path) {
                fs::create_dir_all(folder).map_err(|error| io(folder, error))?;
            }
            write_renamed(&file).map_err(|error| io(&file.path, error))?;
        }
        Ok(())
    }

    /// The bytes of the main file, as [`write`](Self::write) would write them to `path` without
    /// compression.
    ///
    /// # Errors
    /// [`FileError`] if the document cannot be stored under that name.
    pub fn to_bytes(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        let files = self.content.files(path);
        let mut files = files.map_err(|problem| problem.in_file(path, Some(self.format)))?;
        let mut bytes = Vec::new();
        if let Some(main) = files.pop() {
            let io = |error| FileErrorKind::Io(error).at(Place::File);
            let written = (main.write)(&mut bytes).map_err(io);
            written.map_err(|problem| problem.in_file(path, Some(self.format)))?;
        }
        Ok(bytes)
    }
}

fn check_order(
    entry: &MeshEntry,
    faces: &FaceOrder,
    vertices: Option<&VertexOrder>,
) -> Result<(), FileErrorKind> {
    let length = |what, expected, found| match expected == found {
        true => Ok(()),
        false => Err(FileErrorKind::Order(MeshError::LengthMismatch {
            what,
            expected,
            found,
        })),
    };
    length("face order", entry.record_count(), faces.len())?;
    let unsupported = |text: &str| {
        Err(FileErrorKind::unsupported(format!(
            "mesh {:?}: {text}",
            entry.name
        )))
    };
    if !entry.keeps_runs(faces) {
        return unsupported("the order moves a face out of its run (group, material, …)");
    }
    let turns = faces.rotations().iter().any(|&r| r != 0);
    if turns && (!entry.corners_turnable || entry.polygons.is_some()) {
        return unsupported("the order turns corners that must stay");
    }
    let Some(vertices) = vertices else {
        return Ok(());
    };
    length("vertex order", entry.mesh.vertex_count(), vertices.len())?;
    match entry.vertices_movable || vertices.is_identity() {
        true => Ok(()),
        false => unsupported("its vertices must stay where they are"),
    }
}

fn is_gzip(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"))
}

/// The bytes of a file, or what they decompress to if its name ends in `.gz`.
///
/// Comes with the number of bytes to expect, 0 if it is not known.
fn source(path: &Path) -> io::Result<(Box<dyn Read>, u64)> {
    let file = fs::File::open(path)?;
    Ok(match is_gzip(path) {
        true => (Box::new(MultiGzDecoder::new(io::BufReader::new(file))), 0),
        false => {
            let length = file.metadata()?.len();
            (Box::new(file), length)
        }
    })
}

/// The start of a file, up to the length that `length` finds in its first bytes.
pub(super) fn read_start(
    path: &Path,
    limits: &Limits,
    length: impl Fn(&[u8]) -> u64,
) -> Result<Vec<u8>, FileErrorKind> {
    const FIRST: u64 = 64;
    let (mut source, _) = source(path).map_err(FileErrorKind::Io)?;
    let mut bytes = Vec::new();
    let mut read = |bytes: &mut Vec<u8>, limit: u64| {
        let left = limit.saturating_sub(bytes.len() as u64);
        source.by_ref().take(left).read_to_end(bytes)
    };
    read(&mut bytes, FIRST).map_err(FileErrorKind::Io)?;
    let limit = length(&bytes).min(limits.file_bytes);
    read(&mut bytes, limit).map_err(FileErrorKind::Io)?;
    Ok(bytes)
}

/// The bytes of a file, decompressed if its name ends in `.gz`.
pub(super) fn read_limited(path: &Path, limits: &Limits) -> Result<Vec<u8>, FileErrorKind> {
    let (mut source, expected) = source(path).map_err(FileErrorKind::Io)?;
    // Room for the whole file at once, and for the look whether anything follows.
    let room = usize::try_from(expected.min(limits.file_bytes)).unwrap_or(0);
    let mut bytes = Vec::with_capacity(room + 1);
    let limit = limits.file_bytes;
    let read = source
        .by_ref()
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes);
    let found = read.map_err(
        |error| match is_gzip(path) && error.raw_os_error().is_none() {
            // Not the system but the decompressor.
            true => FileErrorKind::malformed(format!(
                "the compressed data is damaged after {} bytes of content ({error})",
                bytes.len()
            )),
            false => FileErrorKind::Io(error),
        },
    )? as u64;
    match found > limit {
        true => Err(FileErrorKind::OverLimit {
            what: "bytes or more",
            found,
            limit,
        }),
        false => Ok(bytes),
    }
}

/// What the names of temporary files end with.
const TEMPORARY: &str = ".meshweft-tmp";

/// Removes temporary files in `folder` whose writer has died; those that are being written stay.
///
/// Nothing is reported: what cannot be removed does no harm.
pub fn remove_abandoned(folder: &Path) {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if !name.starts_with(b".") || !name.ends_with(TEMPORARY.as_bytes()) {
            continue;
        }
        let path = entry.path();
        // Its writer holds a lock as long as it lives.
        let is_abandoned = fs::File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if is_abandoned {
            let _ = fs::remove_file(path);
        }
    }
}

/// Writes to a temporary file in the same folder and renames it over `path`.
///
/// A link is followed, and a file that is replaced keeps its permissions.
fn write_renamed(output: &OutputFile<'_>) -> io::Result<()> {
    // Two threads may write one buffer that two files share.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let path = &fs::canonicalize(&output.path).unwrap_or_else(|_| output.path.clone());
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{number}{TEMPORARY}", std::process::id()));
    let temporary = path.with_file_name(name);
    let write = || -> io::Result<()> {
        let mut file = fs::File::create(&temporary)?;
        // Not every file system has locks; without one nobody clears up after a dead writer.
        let _ = file.lock();
        if is_gzip(path) {
            // No time stamp in the header: the same bytes in give the same bytes out.
            let mut encoder = GzEncoder::new(&mut file, Compression::default());
            (output.write)(&mut encoder)?;
            encoder.finish()?;
        } else {
            (output.write)(&mut file)?;
        }
        if let Ok(replaced) = fs::metadata(path) {
            file.set_permissions(replaced.permissions())?;
            // The old bytes must not be gone before the new ones are on the disk.
            file.sync_all()?;
        }
        fs::rename(&temporary, path)
    };
    write().inspect_err(|_| {
        // The half-written file is of no use; the error that led here is the one to report.
        let _ = fs::remove_file(&temporary);
    })
}
