//! What a hierarchy does to be in a `.mwt` file.

use std::io::{self, Write};

use super::extent::TinExtent;
use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::limits::Limits;
use crate::lod::block_file::Signature;
use crate::lod::fields::{FieldReader, is_sealed};

pub(super) const SIGNATURE: Signature = Signature {
    magic: *b"MWTN",
    version: 1,
    otherwise: DecodeErrorKind::NoTerrain,
};

/// A hierarchy that a file may have.
pub(super) trait StoredTree: Sized {
    /// Its number among kinds.
    const KIND: u64;
    /// A vertex takes at least this many bytes in its block.
    const LEAST_BYTES: u64;

    /// What the head says of it.
    fn put_fields(&self, head: &mut Vec<u8>);
    /// One without blocks, of a file of this length.
    fn from_fields(
        reader: &mut FieldReader<'_>,
        file_length: u64,
        limits: Limits,
    ) -> Result<Self, DecodeError>;
    fn vertex_count(&self) -> usize;
    fn block_count(&self) -> usize;
    /// The block of the corners, at which nothing is cut.
    fn corner_block(&self) -> usize;
    /// Whether a block is there.
    fn has_block(&self, block: usize) -> bool;
    /// The bytes of a block that is there, at the end of others.
    fn put_block(&self, block: usize, bytes: &mut Vec<u8>);
    /// Puts a block in its place.
    fn read_block(&mut self, block: usize, reader: &mut FieldReader<'_>)
    -> Result<(), DecodeError>;
}

/// Where a block is, and what it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TinBlock {
    pub(super) offset: u64,
    pub(super) length: u32,
    pub(super) checksum: u32,
}

/// Writes a `.mwt` file. Blocks are made twice, so that none has to be kept.
pub(super) fn write<T: StoredTree>(
    tree: &T,
    extent: TinExtent,
    name: &str,
    sink: &mut dyn Write,
) -> io::Result<()> {
    let mut head = Vec::new();
    varint::write(&mut head, T::KIND);
    tree.put_fields(&mut head);
    head.extend(extent.heights.map(f32::to_le_bytes).as_flattened());
    varint::write(&mut head, extent.faces);
    varint::write(&mut head, name.len() as u64);
    head.extend(name.as_bytes());

    let mut bytes = Vec::new();
    for block in 0..tree.block_count() {
        bytes.clear();
        tree.put_block(block, &mut bytes);
        varint::write(&mut head, bytes.len() as u64);
        head.extend(crc32(&bytes).to_le_bytes());
    }
    sink.write_all(&SIGNATURE.with_head(&head))?;
    for block in 0..tree.block_count() {
        bytes.clear();
        tree.put_block(block, &mut bytes);
        sink.write_all(&bytes)?;
    }
    Ok(())
}

impl TinBlock {
    /// Puts the block in its place; `bytes` are its own.
    pub(super) fn read_into<T: StoredTree>(
        self,
        tree: &mut T,
        block: usize,
        bytes: &[u8],
    ) -> Result<(), DecodeError> {
        let at = usize::try_from(self.offset).unwrap_or(usize::MAX);
        if !is_sealed(bytes, self.checksum) {
            return Err(DecodeError::damaged(at));
        }
        let mut reader = FieldReader::new(bytes, at);
        tree.read_block(block, &mut reader)?;
        reader.finish()
    }
}

/// Refuses vertices that are more than is allowed, or more than a file of this length can have: what is allocated for them is in
/// proportion to it.
pub(super) fn check_count<T: StoredTree>(
    reader: &FieldReader<'_>,
    vertices: u64,
    most: usize,
    file_length: u64,
    limits: Limits,
) -> Result<(), DecodeError> {
    let limit = limits.vertices.min(most);
    if vertices > limit as u64 {
        let (what, said) = ("vertices", vertices);
        return Err(reader.error(DecodeErrorKind::AboveLimit { what, said, limit }));
    }
    match file_length < T::LEAST_BYTES * vertices {
        true => Err(reader.damaged()),
        false => Ok(()),
    }
}
