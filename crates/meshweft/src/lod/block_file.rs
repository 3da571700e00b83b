//! Files of a head and blocks, of which only what is needed is read.
//!
//! | part | bytes |
//! |---|---|
//! | magic, version | 5 |
//! | length of the head, CRC-32 of the head | 4 + 4, little-endian |
//! | head, which says where the blocks are | |
//! | blocks | |

use std::io::{self, Read, Seek, SeekFrom};

use super::fields::{FieldReader, is_sealed};
use super::hierarchy_error::HierarchyError;
use crate::bits::{DecodeError, DecodeErrorKind, crc32};
use crate::index::index32;

/// Magic, version, length and checksum of the head.
pub(super) const FRONT_BYTES: usize = 13;

/// What files of a kind begin with.
#[derive(Debug)]
pub(super) struct Signature {
    pub(super) magic: [u8; 4],
    pub(super) version: u8,
    /// What is wrong with a file that begins otherwise.
    pub(super) otherwise: DecodeErrorKind,
}

impl Signature {
    /// What comes before the head, and the head.
    pub(super) fn with_head(&self, head: &[u8]) -> Vec<u8> {
        let mut bytes = self.magic.to_vec();
        bytes.push(self.version);
        bytes.extend(index32(head.len()).to_le_bytes());
        bytes.extend(crc32(head).to_le_bytes());
        bytes.extend(head);
        bytes
    }

    /// How long the head is, by the bytes before it, and its checksum.
    pub(super) fn head_length(
        &self,
        front: &[u8; FRONT_BYTES],
    ) -> Result<(usize, u32), DecodeError> {
        let mut reader = FieldReader::new(front, 0);
        if reader.bytes()? != self.magic {
            let kind = self.otherwise.clone();
            return Err(DecodeError { byte: 0, kind });
        }
        let [version] = reader.bytes()?;
        if version != self.version {
            let (what, found) = ("version", version.into());
            return Err(DecodeError {
                byte: self.magic.len(),
                kind: DecodeErrorKind::Unknown { what, found },
            });
        }
        let length = u32::from_le_bytes(reader.bytes()?) as usize;
        Ok((length, u32::from_le_bytes(reader.bytes()?)))
    }
}

/// A file of which the head was read.
#[derive(Debug)]
pub(super) struct BlockFile<S> {
    source: S,
    buffer: Vec<u8>,
    length: u64,
    bytes_read: u64,
}

impl<S: Read + Seek> BlockFile<S> {
    /// Reads the head, whose checksum is right.
    pub(super) fn open(
        mut source: S,
        signature: &Signature,
    ) -> Result<(Self, Vec<u8>), HierarchyError> {
        let length = source.seek(SeekFrom::End(0))?;
        source.rewind()?;
        let mut front = [0; FRONT_BYTES];
        let in_file = usize::try_from(length)
            .unwrap_or(usize::MAX)
            .min(FRONT_BYTES);
        source.read_exact(&mut front[..in_file])?;
        let (head_length, checksum) = signature.head_length(&front)?;
        let before_blocks = FRONT_BYTES as u64 + head_length as u64;
        if before_blocks > length {
            return Err(DecodeError::ends_early(in_file).into());
        }
        let mut head = vec![0; head_length];
        source.read_exact(&mut head)?;
        if !is_sealed(&head, checksum) {
            return Err(DecodeError::damaged(FRONT_BYTES).into());
        }
        let file = Self {
            source,
            buffer: Vec::new(),
            length,
            bytes_read: before_blocks,
        };
        Ok((file, head))
    }

    /// The bytes of a block.
    pub(super) fn read(
        &mut self,
        block: usize,
        offset: u64,
        length: u32,
    ) -> Result<&[u8], HierarchyError> {
        self.buffer.resize(length as usize, 0);
        let seek = self.source.seek(SeekFrom::Start(offset));
        let read = seek.and_then(|_| self.source.read_exact(&mut self.buffer));
        read.map_err(|error| {
            let place = format!("block {block}, from byte {offset}");
            io::Error::new(error.kind(), format!("{place}: {error}"))
        })?;
        self.bytes_read += u64::from(length);
        Ok(&self.buffer)
    }
}

impl<S> BlockFile<S> {
    /// How many bytes the file has.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// How many bytes it has, and how many were read.
    pub(super) fn bytes(&self) -> [u64; 2] {
        [self.length, self.bytes_read]
    }
}
