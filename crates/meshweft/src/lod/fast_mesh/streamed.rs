//! A front of a file of which only what is needed is read.

use std::io::{self, Read, Seek};

use super::budget::FrameBudget;
use super::changes::FrontChanges;
use super::front::Front;
use super::hierarchy::VertexHierarchy;
use super::loader::BlockLoader;
use super::stored::{Head, SIGNATURE};
use crate::limits::Limits;
use crate::lod::block_file::BlockFile;
use crate::lod::hierarchy_error::HierarchyError;
use crate::lod::view::CameraView;

/// A [`Front`] of a `.mwl` file: points are read in blocks when a view needs one of them.
///
/// Memory is taken for all points, but a system gives it only as blocks are read.
#[derive(Debug)]
pub struct StreamedFront<S> {
    front: Front,
    file: HierarchyFile<S>,
}

/// A file with its table of blocks.
#[derive(Debug)]
struct HierarchyFile<S> {
    blocks: BlockFile<S>,
    head: Head,
}

impl<S: Read + Seek> HierarchyFile<S> {
    /// Reads the head, and the coarsest mesh.
    fn open(source: S, limits: Limits) -> Result<(Self, VertexHierarchy), HierarchyError> {
        let (mut blocks, head) = BlockFile::open(source, &SIGNATURE)?;
        let head = Head::from_bytes(&head, blocks.length(), limits)?;
        let entry = head.blocks[0];
        let hierarchy = head.hierarchy(blocks.read(0, entry.offset, entry.length)?)?;
        Ok((Self { blocks, head }, hierarchy))
    }
}

impl<S: Read + Seek> BlockLoader for HierarchyFile<S> {
    type Error = HierarchyError;

    fn load(
        &mut self,
        block: usize,
        hierarchy: &mut VertexHierarchy,
    ) -> Result<(), HierarchyError> {
        let entry = self.head.blocks[1 + block];
        let bytes = self.blocks.read(1 + block, entry.offset, entry.length)?;
        self.head.put_block(block, bytes, hierarchy)?;
        Ok(())
    }
}

impl<S: Read + Seek> StreamedFront<S> {
    /// The coarsest mesh of a file: the table of blocks and the roots are read.
    ///
    /// # Errors
    /// [`HierarchyError`] if the file cannot be read, is not a hierarchy, or is damaged.
    pub fn open(source: S, limits: Limits) -> Result<Self, HierarchyError> {
        let (file, hierarchy) = HierarchyFile::open(source, limits)?;
        Ok(Self {
            front: Front::new(hierarchy),
            file,
        })
    }

    /// The front as it is.
    #[must_use]
    pub fn front(&self) -> &Front {
        &self.front
    }

    /// How many bytes the file has, and how many were read.
    #[must_use]
    pub fn bytes(&self) -> [u64; 2] {
        self.file.blocks.bytes()
    }

    /// As [`Front::update`].
    ///
    /// # Errors
    /// [`HierarchyError`] if a block cannot be read. The mesh is somewhere between the last one and that of the view, without
    /// cracks, and [`Front::changes`] says what changed.
    ///
    /// # Panics
    /// If `hysteresis` is not above 0 and at most 1.
    pub fn update(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
    ) -> Result<&FrontChanges, HierarchyError> {
        self.front.update_by(view, hysteresis, &mut self.file)?;
        Ok(self.front.changes())
    }

    /// As [`Front::update_within`].
    ///
    /// # Errors
    /// As [`update`](Self::update).
    ///
    /// # Panics
    /// If `hysteresis` is not above 0 and at most 1.
    pub fn update_within(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        budget: FrameBudget,
    ) -> Result<(&FrontChanges, bool), HierarchyError> {
        let file = &mut self.file;
        let is_done = self
            .front
            .update_within_by(view, hysteresis, budget, file)?;
        Ok((self.front.changes(), is_done))
    }

    /// As [`Front::refine_fully`].
    ///
    /// # Errors
    /// As [`update`](Self::update).
    pub fn refine_fully(&mut self) -> Result<&FrontChanges, HierarchyError> {
        self.front.refine_fully_by(&mut self.file)?;
        Ok(self.front.changes())
    }
}

impl VertexHierarchy {
    /// Whether bytes begin as those of a `.mwl` file do.
    #[must_use]
    pub fn begins_bytes(start: &[u8]) -> bool {
        start.starts_with(&SIGNATURE.magic)
    }

    /// The whole hierarchy from the bytes of a `.mwl` file.
    ///
    /// # Errors
    /// [`HierarchyError`] if they are not a hierarchy, are cut, have changed, or have more than is allowed.
    ///
    /// # Complexity
    /// Time O(vertices), space about five times the bytes.
    pub fn from_bytes(bytes: &[u8], limits: Limits) -> Result<Self, HierarchyError> {
        let (mut file, mut hierarchy) = HierarchyFile::open(io::Cursor::new(bytes), limits)?;
        for block in 0..file.head.blocks.len() - 1 {
            file.load(block, &mut hierarchy)?;
        }
        Ok(hierarchy)
    }
}
