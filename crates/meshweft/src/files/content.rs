//! What a format gives to a document: its meshes, the way to change them, the files to write.

use std::path::{Path, PathBuf};
use std::{fmt, io};

use super::edit::NewValue;
use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use super::level_bytes::LevelBytes;
use super::new_levels::{NewLevels, VerticesOfLevels};
use super::new_mesh::NewMesh;
use super::note::Note;
use super::placing::{Beside, Placed};
use super::select::SelectPlan;
use super::stored_culling::{PlacedTable, SeenSides, StoredCulling};
use super::unlisted::Unlisted;
use crate::attribute::{Attribute, AttributeInfo};
use crate::permutation::{FaceOrder, VertexOrder};

/// What a format's reader hands to [`Document`](super::Document).
pub(super) type ReadResult = Result<(Box<dyn Content>, Vec<Note>), Problem>;

/// What a format's reader offers to [`Document`](super::Document).
///
/// Its `Debug` output is short: bytes and faces are counted and not listed.
pub(super) trait Content: Send + Sync + fmt::Debug {
    /// The meshes, kept up to date by every edit.
    fn meshes(&self) -> &[MeshEntry];
    /// What is stored with the vertices, corners and faces of a mesh; nothing is decoded for it.
    fn attributes(&self, mesh: usize) -> Vec<AttributeInfo>;
    /// The values of an attribute that [`attributes`](Self::attributes) lists, in the order in which
    /// vertices and faces now are.
    fn attribute(&self, mesh: usize, info: &AttributeInfo) -> Result<Attribute, Problem>;
    /// The positions of the vertices of a file that has no faces; `None` if it has faces, or is of a format that has no vertices then.
    fn loose_positions(&self) -> Result<Option<Attribute>, Problem> {
        Ok(None)
    }
    /// A number of where the values of that attribute are stored: meshes with the same number share them.
    /// `None` if nothing is shared, or that is not known.
    fn store(&self, _mesh: usize, _info: &AttributeInfo) -> Option<usize> {
        None
    }
    /// For each corner of a mesh, three a face, a number: corners of one vertex have the same if the same is
    /// stored with them and holds for their faces (materials, groups). Empty if that is so for all.
    fn corner_kinds(&self, _mesh: usize) -> Result<Vec<u32>, Problem> {
        Ok(Vec::new())
    }
    /// What the file holds that is neither in its meshes nor in their attributes.
    fn unlisted(&self) -> Vec<Unlisted>;
    /// Does [`Edit::Order`](super::Edit::Order); the caller has checked the orders.
    fn order(&mut self, mesh: usize, faces: Option<&FaceOrder>, vertices: Option<&VertexOrder>);
    /// Does [`Edit::Select`](super::Edit::Select), or changes nothing; the notes of the document as it
    /// then is.
    fn select(&mut self, _plan: SelectPlan) -> Result<Vec<Note>, Problem> {
        let text =
            "faces are not left out of files of this format: convert it to .ply or .glb first";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// Does [`Edit::Append`](super::Edit::Append), or changes nothing; the notes of the document as it
    /// then is.
    fn append(
        &mut self,
        _meshes: &[NewMesh<'_>],
        _values: &[NewValue<'_>],
    ) -> Result<Vec<Note>, Problem> {
        let text = "meshes can be added to .gltf and .glb files only";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// The culling table of a mesh, if it has one.
    fn culling(&self, _mesh: usize) -> Option<StoredCulling> {
        None
    }
    /// Calls `visit` with each culling table, in the order of the file.
    fn each_table(&self, _visit: &mut dyn FnMut(PlacedTable<'_>)) -> Result<(), Problem> {
        Ok(())
    }
    /// What is wrong with tables that keep their faces from being read as a mesh, if there are such.
    fn damaged_table(&self) -> Option<&Note> {
        None
    }
    /// Which sides of the faces of each mesh are seen, or why none of them may be left out.
    fn seen_sides(&self) -> Vec<Result<SeenSides, &'static str>> {
        vec![Ok(SeenSides::Front); self.meshes().len()]
    }
    /// Does [`Edit::Cull`](super::Edit::Cull), or changes nothing; the notes of the document as it then is.
    fn cull(&mut self, _tables: &[(usize, &StoredCulling)]) -> Result<Vec<Note>, Problem> {
        let text = "culling tables can be added to .gltf and .glb files only";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// For each mesh, whether all that draws its faces has the same vertices.
    fn draws_alike(&self) -> Vec<bool> {
        vec![true; self.meshes().len()]
    }
    /// For each mesh, which vertices its levels of detail can have.
    fn vertices_of_levels(&self) -> Vec<VerticesOfLevels> {
        vec![VerticesOfLevels::OfMesh; self.meshes().len()]
    }
    /// For each mesh, the largest scale that it is drawn with; 1 where none is known.
    fn drawn_scales(&self) -> Vec<f64> {
        vec![1.0; self.meshes().len()]
    }
    /// Does [`Edit::Levels`](super::Edit::Levels), or changes nothing; the notes of the document as it then is.
    fn add_levels(&mut self, _meshes: &[NewLevels]) -> Result<Vec<Note>, Problem> {
        let text = "levels of detail can be added to .gltf and .glb files only";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// Where in the files of the document each level of detail has what it needs.
    fn level_bytes(&self) -> Result<LevelBytes, Problem> {
        let text = "only .gltf and .glb files have byte ranges for levels of detail";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// Does [`Edit::StreamLayout`](super::Edit::StreamLayout), or changes nothing; the notes of the document as it then
    /// is, or `None` if it was laid out like that.
    fn stream_layout(&mut self) -> Result<Option<Vec<Note>>, Problem> {
        let text = "only buffers of .gltf and .glb files can be laid out for streaming";
        Err(FileErrorKind::unsupported(text).at(Place::File))
    }
    /// The files beside the main one.
    fn beside(&self) -> Vec<Beside<'_>> {
        Vec::new()
    }
    /// Files that it names, and that are neither read as vertices or faces nor changed: images, materials.
    /// Paths from the folder of the main file, without `..`; whether they are there is not known.
    fn companions(&self) -> Vec<PathBuf> {
        Vec::new()
    }
    /// Files that it needs and that were not read to their ends; nothing in them changes.
    fn unread(&self) -> Vec<PathBuf> {
        Vec::new()
    }
    /// The text of the main file as it was read, if nothing in it has changed.
    fn unchanged_text(&self) -> Option<&[u8]> {
        None
    }
    /// Every file of the document, each beside the main one as `placed` says, the main one last.
    fn files(&self, path: &Path, placed: &[Placed]) -> Result<Vec<OutputFile<'_>>, Problem>;
    /// The size of all files beside the main one that were read.
    fn size_beside(&self) -> u64 {
        0
    }
}

/// A file to be written, its bytes made as they are written.
pub(super) struct OutputFile<'a> {
    pub(super) path: PathBuf,
    pub(super) place: OutputPlace,
    pub(super) write: Box<WriteFile<'a>>,
}

/// Writes all bytes of a file, in large pieces.
pub(super) type WriteFile<'a> = dyn Fn(&mut dyn io::Write) -> io::Result<()> + 'a;

/// What is at the place of a file to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OutputPlace {
    /// The file itself, with these bytes.
    Occupied,
    /// Nothing, and nothing is replaced.
    Free,
    /// Anything: it is replaced.
    Replaced,
}
