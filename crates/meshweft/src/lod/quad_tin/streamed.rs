//! A terrain in a file of which only what is needed is read.

use std::io::{Read, Seek};

use super::descent::TinSurface;
use super::hierarchy::QuadTin;
use super::limited::TinLimit;
use super::stored::{SIGNATURE, StoredHead, TinBlock};
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
        self.draw_by(surface, |tin, surface| tin.draw(view, surface))
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
        self.draw_by(surface, |tin, surface| {
            tin.draw_within(limit, view, surface)
        })
    }

    /// Draws until nothing is missing: each time a level deeper, or all.
    fn draw_by(
        &mut self,
        surface: &mut TinSurface,
        draw: impl Fn(&QuadTin, &mut TinSurface),
    ) -> Result<(), HierarchyError> {
        loop {
            draw(&self.tin, surface);
            if surface.missing.is_empty() {
                return Ok(());
            }
            let mut missing = std::mem::take(&mut surface.missing);
            missing.sort_unstable();
            missing.dedup();
            for block in missing {
                self.read(block)?;
            }
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
        let entry = self.blocks[block];
        let bytes = self.file.read(block, entry.offset, entry.length)?;
        self.tin.tree.read_block(block, entry, bytes)?;
        Ok(())
    }
}

impl QuadTin {
    /// Whether a `.mwt` file has all of this terrain, bit for bit. Blocks are read one after the other, and none is kept.
    ///
    /// # Errors
    /// [`HierarchyError`] if the file cannot be read, is not a terrain, or is damaged.
    pub fn is_stored_in(&self, source: impl Read + Seek) -> Result<bool, HierarchyError> {
        let mut stored = StreamedTin::open(source, Limits::default())?;
        let [own, other] = [&self.grid, &stored.tin.grid];
        let is_same_head = own.blocks == other.blocks
            && own.spacing.map(f64::to_bits) == other.spacing.map(f64::to_bits)
            && [own.errors, own.radii] == [other.errors, other.radii]
            && self.extent.is_same(&stored.tin.extent);
        if !is_same_head {
            return Ok(false);
        }
        for block in 0..stored.blocks.len() {
            if stored.tin.grid.nodes[block].is_none() {
                stored.read(block)?;
            }
            let found = stored.tin.grid.nodes[block].take();
            let is_same = self.grid.nodes[block]
                .as_ref()
                .zip(found)
                .is_some_and(|(own, found)| {
                    let mut vertices = self.grid.blocks.vertices(block);
                    vertices.all(|(inside, _)| own[inside].is_same(&found[inside]))
                });
            if !is_same {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether bytes begin as those of a `.mwt` file do.
    #[must_use]
    pub fn begins_bytes(start: &[u8]) -> bool {
        start.starts_with(&SIGNATURE.magic)
    }
}
