//! A terrain as bytes, in blocks that are read when they are needed: `.mwt` files.
//!
//! Before the blocks stand magic `MWTN`, version 1 and the head, as in [`block_file`](crate::lod::block_file). The head has
//!
//! | field | bytes |
//! |---|---|
//! | kind: 0, over a grid; 1, over points | varint |
//! | fields of the kind: see [`stored_grid`](super::stored_grid) and [`stored_points`](super::stored_points) | |
//! | lowest and highest height | 2 `f32` |
//! | faces at full detail | varint |
//! | name: its length, and bytes | varint, UTF-8 |
//! | of each block: its length, its CRC-32 | varint, 4 |
//!
//! All is little-endian; varints have seven bits a byte, lowest first.

use std::io::{self, Write};

use super::extent::TinExtent;
use super::grid::GridTin;
use super::points::PointHierarchy;
use super::tree::TinTree;
use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::limits::Limits;
use crate::lod::block_file::{FRONT_BYTES, Signature};
use crate::lod::fields::{FieldReader, is_sealed};

pub(super) const SIGNATURE: Signature = Signature {
    magic: *b"MWTN",
    version: 1,
    otherwise: DecodeErrorKind::NoTerrain,
};

/// Bytes of a name.
const MOST_NAME: u32 = 1 << 16;

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
    checksum: u32,
}

/// What a file says before its blocks.
pub(super) struct StoredHead {
    /// Without blocks.
    pub(super) tree: TinTree,
    pub(super) extent: TinExtent,
    pub(super) name: String,
    pub(super) blocks: Vec<TinBlock>,
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

impl StoredHead {
    /// The head of a file of this length from its bytes.
    pub(super) fn from_bytes(
        head: &[u8],
        file_length: u64,
        limits: Limits,
    ) -> Result<Self, DecodeError> {
        let mut reader = FieldReader::new(head, FRONT_BYTES);
        let tree = match reader.number()? {
            GridTin::KIND => TinTree::Grid(GridTin::from_fields(&mut reader, file_length, limits)?),
            PointHierarchy::KIND => TinTree::Points(PointHierarchy::from_fields(
                &mut reader,
                file_length,
                limits,
            )?),
            found => {
                let what = "kind of terrain";
                return Err(reader.error(DecodeErrorKind::Unknown { what, found }));
            }
        };

        // What it is in all.
        let heights: [f32; 2] = reader.f32s()?;
        let faces = reader.number()?;
        let name = reader.below(MOST_NAME)?;
        let name = reader.slice(name as usize)?.to_vec();
        let name = String::from_utf8(name).map_err(|_| reader.damaged())?;
        let are_finite = heights.iter().all(|it| it.is_finite());
        if faces > 2 * tree.vertex_count() as u64 || !are_finite || heights[0] > heights[1] {
            return Err(reader.damaged());
        }

        // The blocks, which fill the rest of the file.
        let mut offset = (FRONT_BYTES + head.len()) as u64;
        let mut blocks = Vec::new();
        for _ in 0..tree.block_count() {
            let length = reader.below(u32::MAX)?;
            let checksum = u32::from_le_bytes(reader.bytes()?);
            blocks.push(TinBlock {
                offset,
                length,
                checksum,
            });
            offset += u64::from(length);
        }
        if offset != file_length {
            return Err(reader.error(DecodeErrorKind::EndsEarly));
        }
        reader.finish()?;
        Ok(Self {
            tree,
            extent: TinExtent { heights, faces },
            name,
            blocks,
        })
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

/// Where a head has the checksums of blocks, and how long these are, as far as it can be read.
#[cfg(test)]
pub(super) fn block_places(head: &[u8]) -> Option<Vec<(usize, usize)>> {
    let mut reader = FieldReader::new(head, 0);
    if reader.number().ok()? == GridTin::KIND {
        reader.number().ok()?;
        reader.number().ok()?;
        reader.bytes::<16>().ok()?;
        reader.number().ok()?;
    }
    reader.number().ok()?;
    reader.bytes::<8>().ok()?;
    reader.number().ok()?;
    let name = reader.number().ok()?;
    reader.slice(usize::try_from(name).ok()?).ok()?;
    let mut places = Vec::new();
    while let Ok(length) = reader.number() {
        let at = head.len() - reader.left();
        if reader.bytes::<4>().is_err() {
            break;
        }
        places.push((at, usize::try_from(length).ok()?));
    }
    Some(places)
}
