//! Where in its files a document has what each of its levels of detail needs.

use std::path::PathBuf;

/// Bytes of one of the files of a document. In order, they rise file by file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FileBytes {
    /// 0 is the main file, others are those in [`LevelBytes::beside`], from 1 on.
    pub(crate) file: usize,
    pub(crate) start: u64,
    /// The byte after the last.
    pub(crate) end: u64,
}

/// What each level of detail needs.
///
/// What stands in the text of the main file is in none of the lists: the text is read first, and whole.
#[derive(Debug, Default)]
pub(crate) struct LevelBytes {
    /// How many bytes the main file has before its data: header and text.
    pub(crate) head: u64,
    /// The files beside it, as paths from its folder.
    pub(crate) beside: Vec<PathBuf>,
    /// Coarsest first; level 0 is the last.
    pub(crate) levels: Vec<LevelNeeds>,
    pub(crate) images: Vec<FileBytes>,
}

/// What a level of detail needs that no coarser one does, and perhaps some of what these do.
#[derive(Debug, Clone, Default)]
pub(crate) struct LevelNeeds {
    /// How many faces it has, each mesh counted once.
    pub(crate) faces: u64,
    /// How many vertices, up to the last that it uses; positions that several meshes share are counted once.
    pub(crate) vertices: u64,
    /// Index lists, attributes and morph targets.
    pub(crate) geometry: Vec<FileBytes>,
    /// Matrices of joints and instances.
    pub(crate) matrices: Vec<FileBytes>,
}
