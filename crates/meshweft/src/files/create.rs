//! New files on the disk.

use std::path::Path;

use super::document::Document;
use super::error::{FileError, FileErrorKind, Place};
use super::format::Format;
use super::new_mesh::NewMesh;
use super::write::{WriteOptions, Written};

/// Writes a new file of these meshes, of the format that its name stands for: see [`Document::create`] for
/// what each format holds. A name that ends in `.gz` is compressed, and folders are made.
///
/// The file is written under another name and then renamed, so it is whole whenever it is there. What has
/// that name is replaced with `overwrite` only, and not if it is read-only.
///
/// ```
/// use meshweft::Limits;
/// use meshweft::files::{Document, FileErrorKind, NewMesh, create};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let triangle = NewMesh::plain("triangle", &corners, &[[0, 1, 2]]);
/// let path = std::env::temp_dir().join("meshweft-new-file/triangle.obj");
/// create(&path, &[triangle], true)?;
/// let document = Document::open(&path, Limits::default())?;
/// assert_eq!(document.positions(0)?.as_deref(), Some(&corners[..]));
///
/// let again = create(&path, &[triangle], false).unwrap_err();
/// assert!(matches!(again.kind, FileErrorKind::Exists));
/// # std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
/// # Ok::<(), meshweft::files::FileError>(())
/// ```
///
/// # Errors
/// [`FileError`] as of [`Document::create`] and [`Document::write_with`]; of kind
/// [`FileErrorKind::Unsupported`] if the name stands for no format, and [`FileErrorKind::Exists`] if there is
/// such a file that is not to be replaced.
///
/// # Complexity
/// Time and space O(bytes of the file).
pub fn create(path: &Path, meshes: &[NewMesh<'_>], overwrite: bool) -> Result<Written, FileError> {
    let (format, options) = checked(path, overwrite)?;
    Document::create(format, path, meshes)?.write_with(path, &options)
}

/// Whether [`create`] may write a file of this name: before there is anything to write.
///
/// # Errors
/// [`FileError`] as of [`create`]: the name stands for no format, there is such a file that is not to be replaced, or it is read-only.
pub fn check_new(path: &Path, overwrite: bool) -> Result<(), FileError> {
    checked(path, overwrite).map(|_| ())
}

fn checked(path: &Path, overwrite: bool) -> Result<(Format, WriteOptions<'static>), FileError> {
    let options = WriteOptions {
        replace_existing: overwrite,
        ..WriteOptions::default()
    };
    let Some(format) = Format::of_path(path) else {
        let text = "the name of a new file says its format: end it in .glb, .gltf, .ply, .obj, .off or .stl";
        let problem = FileErrorKind::unsupported(text).at(Place::File);
        return Err(problem.in_file(path, None));
    };
    options
        .check_existing(path)
        .map_err(|problem| problem.in_file(path, Some(format)))?;
    Ok((format, options))
}
