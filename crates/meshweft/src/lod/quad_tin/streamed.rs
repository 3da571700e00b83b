//! A terrain in a file of which only what is needed is read.

use std::io::{self, BufRead, BufReader, Read, Seek, Write};

use super::descent::TinSurface;
use super::hierarchy::QuadTin;
use super::limited::TinLimit;
use super::stored::StoredHead;
use super::stored_tree::{SIGNATURE, TinBlock};
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
