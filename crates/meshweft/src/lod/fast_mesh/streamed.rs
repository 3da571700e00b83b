//! A front of a file of which only what is needed is read.

use std::fmt;
use std::io::{self, Read, Seek, SeekFrom};

use super::budget::FrameBudget;
use super::changes::FrontChanges;
use super::front::Front;
use super::hierarchy::VertexHierarchy;
use super::loader::BlockLoader;
use super::stored::{FRONT_BYTES, Head, MAGIC};
use crate::bits::{DecodeError, DecodeErrorKind};
use crate::limits::Limits;
use crate::lod::view::CameraView;

/// A [`Front`] of a `.mwl` file: points are read in blocks when a view needs one of them.
///
/// Memory is taken for all points, but a system gives it only as blocks are read.
#[derive(Debug)]
pub struct StreamedFront<S> {
    front: Front,
    file: BlockFile<S>,
}

/// A file with its table of blocks.
#[derive(Debug)]
struct BlockFile<S> {
    source: S,
    head: Head,
    buffer: Vec<u8>,
    length: u64,
    bytes_read: u64,
}

/// Why a hierarchy could not be read from a file.
#[derive(Debug)]
#[non_exhaustive]
pub enum HierarchyError {
    /// The file could not be read.
    Read(io::Error),
    /// What was read is not a hierarchy, or is damaged.
    Decode(DecodeError),
}

/// What to do about damage.
const CURE: &str = "copy it again, or build it again from the mesh with `meshweft lod build`";

impl fmt::Display for HierarchyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => error.fmt(f),
            Self::Decode(DecodeError { byte, kind }) => match kind {
                DecodeErrorKind::NoHierarchy => {
                    write!(
                        f,
                        "byte {byte}: this is not a .mwl file: give one that `meshweft lod build` wrote"
                    )
                }
                DecodeErrorKind::EndsEarly => write!(
                    f,
                    "byte {byte}: the file is cut, or has more bytes than it should: {CURE}"
                ),
                DecodeErrorKind::Unknown { what, found } => write!(
                    f,
                    "byte {byte}: {what} {found} is not known. A later version of meshweft may have written the file: update \
                     meshweft. Otherwise {CURE}"
                ),
                DecodeErrorKind::AboveLimit { what, said, limit } => write!(
                    f,
                    "byte {byte}: the file has {said} {what}, and {limit} are allowed: if you trust it, raise the limit"
                ),
                _ => write!(f, "byte {byte}: the file is damaged: {CURE}"),
            },
        }
    }
}

impl std::error::Error for HierarchyError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read(error) => Some(error),
            Self::Decode(error) => Some(error),
        }
    }
}

impl From<io::Error> for HierarchyError {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

impl From<DecodeError> for HierarchyError {
    fn from(error: DecodeError) -> Self {
        Self::Decode(error)
    }
}

impl<S: Read + Seek> BlockFile<S> {
    /// Reads the head.
    fn open(mut source: S, limits: Limits) -> Result<Self, HierarchyError> {
        let length = source.seek(SeekFrom::End(0))?;
        source.rewind()?;
        let mut front = [0; FRONT_BYTES];
        let in_file = usize::try_from(length)
            .unwrap_or(usize::MAX)
            .min(FRONT_BYTES);
        source.read_exact(&mut front[..in_file])?;
        let (head_length, checksum) = Head::length(&front)?;
        let before_blocks = FRONT_BYTES as u64 + head_length as u64;
        if before_blocks > length {
            return Err(DecodeError::ends_early(in_file).into());
        }
        let mut buffer = vec![0; head_length];
        source.read_exact(&mut buffer)?;
        let head = Head::from_bytes(&buffer, checksum, length, limits)?;
        Ok(Self {
            source,
            head,
            buffer,
            length,
            bytes_read: before_blocks,
        })
    }

    /// Reads a block of all; the first one is that of the roots.
    fn read(&mut self, block: usize) -> Result<(), HierarchyError> {
        let entry = self.head.blocks[block];
        self.buffer.resize(entry.length as usize, 0);
        let seek = self.source.seek(SeekFrom::Start(entry.offset));
        let read = seek.and_then(|_| self.source.read_exact(&mut self.buffer));
        read.map_err(|error| {
            let place = format!("block {block}, from byte {}", entry.offset);
            io::Error::new(error.kind(), format!("{place}: {error}"))
        })?;
        self.bytes_read += u64::from(entry.length);
        Ok(())
    }
}

impl<S: Read + Seek> BlockLoader for BlockFile<S> {
    type Error = HierarchyError;

    fn load(
        &mut self,
        block: usize,
        hierarchy: &mut VertexHierarchy,
    ) -> Result<(), HierarchyError> {
        self.read(1 + block)?;
        self.head.put_block(block, &self.buffer, hierarchy)?;
        Ok(())
    }
}

impl<S: Read + Seek> StreamedFront<S> {
    /// The coarsest mesh of a file: the table of blocks and the roots are read.
    ///
    /// # Errors
    /// [`HierarchyError`] if the file cannot be read, is not a hierarchy, or is damaged.
    pub fn open(source: S, limits: Limits) -> Result<Self, HierarchyError> {
        let mut file = BlockFile::open(source, limits)?;
        file.read(0)?;
        let hierarchy = file.head.hierarchy(&file.buffer)?;
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
        [self.file.length, self.file.bytes_read]
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
        start.starts_with(&MAGIC)
    }

    /// The whole hierarchy from the bytes of a `.mwl` file.
    ///
    /// # Errors
    /// [`HierarchyError`] if they are not a hierarchy, are cut, have changed, or have more than is allowed.
    ///
    /// # Complexity
    /// Time O(vertices), space about five times the bytes.
    pub fn from_bytes(bytes: &[u8], limits: Limits) -> Result<Self, HierarchyError> {
        let mut file = BlockFile::open(io::Cursor::new(bytes), limits)?;
        file.read(0)?;
        let mut hierarchy = file.head.hierarchy(&file.buffer)?;
        for block in 0..file.head.blocks.len() - 1 {
            file.load(block, &mut hierarchy)?;
        }
        Ok(hierarchy)
    }
}
