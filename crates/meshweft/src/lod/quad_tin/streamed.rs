//! A terrain in a file of which only what is needed is read.

use std::io::{self, BufRead, BufReader, Read, Seek, Write};

use super::descent::{TinSurface, draw};
use super::hierarchy::QuadTin;
use super::limited::{TinLimit, draw_within};
use super::stored::StoredHead;
use super::stored_tree::{SIGNATURE, StoredTree, TinBlock};
use super::tree::TinTree;
use super::triangle::{BisectionTree, DrawnTree};
use crate::limits::Limits;
use crate::lod::block_file::BlockFile;
use crate::lod::hierarchy_error::HierarchyError;
use crate::lod::view::CameraView;

/// A [`QuadTin`] of a `.mwt` file: vertices are read in blocks when a surface needs one of them.
#[derive(Debug)]
pub struct StreamedTin<S> {
    tin: QuadTin,
    name: String,
    file: BlockFile<S>,
    blocks: Vec<TinBlock>,
}

impl<S: Read + Seek> StreamedTin<S> {
    /// The coarsest surface of a file.
    ///
    /// # Errors
    /// [`HierarchyError`] if the file cannot be read, is not a terrain, or is damaged.
    pub fn open(source: S, limits: Limits) -> Result<Self, HierarchyError> {
        let (file, head) = BlockFile::open(source, &SIGNATURE)?;
        let StoredHead {
            tree,
            extent,
            name,
            blocks,
        } = StoredHead::from_bytes(&head, file.length(), limits)?;
        let corners = tree.corner_block();
        let mut streamed = Self {
            tin: QuadTin { tree, extent },
            name,
            file,
            blocks,
        };
        streamed.read(corners)?;
        Ok(streamed)
    }

    /// What was read so far.
    #[must_use]
    pub fn tin(&self) -> &QuadTin {
        &self.tin
    }

    /// How many bytes the file has, and how many were read.
    #[must_use]
    pub fn bytes(&self) -> [u64; 2] {
        self.file.bytes()
    }

    /// What the terrain is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// As [`QuadTin::draw`].
    ///
    /// # Errors
    /// [`HierarchyError`] if a block cannot be read; the surface has holes then.
    pub fn draw(
        &mut self,
        view: &CameraView,
        surface: &mut TinSurface,
    ) -> Result<(), HierarchyError> {
        self.draw_by(None, view, surface)
    }

    /// As [`QuadTin::draw_within`].
    ///
    /// # Errors
    /// As [`draw`](Self::draw).
    pub fn draw_within(
        &mut self,
        limit: TinLimit,
        view: &CameraView,
        surface: &mut TinSurface,
    ) -> Result<(), HierarchyError> {
        self.draw_by(Some(limit), view, surface)
    }

    /// Draws, and reads blocks on the way.
    fn draw_by(
        &mut self,
        limit: Option<TinLimit>,
        view: &CameraView,
        surface: &mut TinSurface,
    ) -> Result<(), HierarchyError> {
        let source = TinBlocks {
            file: &mut self.file,
            entries: &self.blocks,
        };
        match &mut self.tin.tree {
            TinTree::Grid(tree) => source.draw(tree, limit, view, surface),
            TinTree::Points(tree) => source.draw(tree, limit, view, surface),
        }
    }

    /// Reads all that was not read yet.
    ///
    /// # Errors
    /// [`HierarchyError`] if a block cannot be read.
    pub fn into_tin(mut self) -> Result<QuadTin, HierarchyError> {
        for block in 0..self.blocks.len() {
            if !self.tin.tree.has_block(block) {
                self.read(block)?;
            }
        }
        Ok(self.tin)
    }

    fn read(&mut self, block: usize) -> Result<(), HierarchyError> {
        let mut source = TinBlocks {
            file: &mut self.file,
            entries: &self.blocks,
        };
        match &mut self.tin.tree {
            TinTree::Grid(tree) => source.read_into(tree, block),
            TinTree::Points(tree) => source.read_into(tree, block),
        }
    }
}

/// The blocks of a file.
struct TinBlocks<'a, S> {
    file: &'a mut BlockFile<S>,
    entries: &'a [TinBlock],
}

impl<S: Read + Seek> TinBlocks<'_, S> {
    fn read_into<T: StoredTree>(
        &mut self,
        tree: &mut T,
        block: usize,
    ) -> Result<(), HierarchyError> {
        let entry = self.entries[block];
        let bytes = self.file.read(block, entry.offset, entry.length)?;
        entry.read_into(tree, block, bytes)?;
        Ok(())
    }

    fn draw<T: StoredTree + BisectionTree>(
        self,
        tree: &mut T,
        limit: Option<TinLimit>,
        view: &CameraView,
        surface: &mut TinSurface,
    ) -> Result<(), HierarchyError> {
        let mut reading = ReadingTree {
            tree,
            blocks: self,
            error: None,
        };
        match limit {
            None => draw(&mut reading, view, surface),
            Some(limit) => draw_within(&mut reading, view, limit, surface),
        }
        reading.error.map_or(Ok(()), Err)
    }
}

/// A hierarchy of which blocks are read when the way down comes to them.
struct ReadingTree<'a, T, S> {
    tree: &'a mut T,
    blocks: TinBlocks<'a, S>,
    /// The first one: nothing is read after it.
    error: Option<HierarchyError>,
}

impl<T: StoredTree + BisectionTree, S: Read + Seek> DrawnTree for ReadingTree<'_, T, S> {
    type Tree = T;

    fn tree(&self) -> &T {
        self.tree
    }

    fn read(&mut self, block: usize) -> bool {
        if self.error.is_none() {
            self.error = self.blocks.read_into(self.tree, block).err();
        }
        self.error.is_none()
    }
}

impl QuadTin {
    /// Whether a `.mwt` file has all of this terrain, bit for bit, whatever its name.
    ///
    /// # Errors
    /// [`HierarchyError`] if the file cannot be read, is not a terrain, or is damaged.
    pub fn is_stored_in(&self, mut source: impl Read + Seek) -> Result<bool, HierarchyError> {
        let name = StreamedTin::open(&mut source, Limits::default())?.name;
        source.rewind()?;
        let mut compared = ComparedBytes {
            source: BufReader::new(source),
            is_same: true,
            buffer: Vec::new(),
        };
        match self.write(&name, &mut compared) {
            Err(_) if !compared.is_same => return Ok(false),
            done => done?,
        }
        // Nothing comes after it.
        let rest = compared.source.fill_buf()?;
        Ok(rest.is_empty())
    }

    /// Whether bytes begin as those of a `.mwt` file do.
    #[must_use]
    pub fn begins_bytes(start: &[u8]) -> bool {
        start.starts_with(&SIGNATURE.magic)
    }
}

/// What is written to it is compared with a source.
struct ComparedBytes<S> {
    source: BufReader<S>,
    is_same: bool,
    buffer: Vec<u8>,
}

impl<S: Read> Write for ComparedBytes<S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.buffer.resize(bytes.len(), 0);
        let read = self.source.read_exact(&mut self.buffer);
        match read {
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => return Err(error),
            _ => self.is_same = read.is_ok() && self.buffer == bytes,
        }
        match self.is_same {
            true => Ok(bytes.len()),
            // The rest need not be compared.
            false => Err(io::Error::other("the file differs")),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
