//! A terrain as bytes, in blocks that are read when they are needed: `.mwt` files.
//!
//! Before the blocks stand magic `MWTN`, version 1 and the head, as in [`block_file`](crate::lod::block_file). The head has
//!
//! | field | bytes |
//! |---|---|
//! | kind: 0, a grid | varint |
//! | columns, rows | 2 varints |
//! | distance of columns, of rows | 2 `f64` |
//! | scales of errors and of radii: see [`LengthScale`] | 2 varints with a sign |
//! | lowest and highest height | 2 `f32` |
//! | faces at full detail | varint |
//! | name: its length, and bytes | varint, UTF-8 |
//! | of each block: its length, its CRC-32 | varint, 4 |
//!
//! Blocks are those of [`GridBlocks`](super::grid::GridBlocks), the finest level first, each with its vertices in their order: all
//! heights, all errors, all radii. A byte says how heights are stored: 0, as `f32`; 1, as whole numbers, each the difference from
//! the one before, with a sign, plus one, as a varint. A void is NaN, or 0. Errors and radii are codes of 16 bits; the highest bit
//! of an error says that the first triangle of the vertex is void, that of a radius the second one. All is little-endian.

use std::io::{self, Write};

use super::extent::TinExtent;
use super::grid::{GridNode, GridTin};
use super::rounded::LengthScale;
use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::height_grid::HeightGrid;
use crate::limits::Limits;
use crate::lod::block_file::{FRONT_BYTES, Signature};
use crate::lod::fields::{FieldReader, is_sealed};

pub(super) const SIGNATURE: Signature = Signature {
    magic: *b"MWTN",
    version: 1,
    otherwise: DecodeErrorKind::NoTerrain,
};

/// A grid, by its number among kinds of terrains.
const GRID: u64 = 0;
/// A vertex takes at least this many bytes in its block.
const LEAST_BYTES: u64 = 5;
/// Bytes of a name.
const MOST_NAME: u32 = 1 << 16;

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
    pub(super) tin: GridTin,
    pub(super) extent: TinExtent,
    pub(super) name: String,
    pub(super) blocks: Vec<TinBlock>,
}

impl GridTin {
    /// Writes a `.mwt` file. Blocks are made twice, so that none has to be kept.
    pub(super) fn write(
        &self,
        extent: TinExtent,
        name: &str,
        sink: &mut dyn Write,
    ) -> io::Result<()> {
        let mut head = Vec::new();
        let [columns, rows] = self.blocks.square.size;
        for number in [GRID, columns.into(), rows.into()] {
            varint::write(&mut head, number);
        }
        head.extend(self.spacing.map(f64::to_le_bytes).as_flattened());
        for scale in [self.errors, self.radii] {
            varint::write(&mut head, varint::zigzag(scale.number().into()));
        }
        head.extend(extent.heights.map(f32::to_le_bytes).as_flattened());
        varint::write(&mut head, extent.faces);
        varint::write(&mut head, name.len() as u64);
        head.extend(name.as_bytes());

        let mut bytes = Vec::new();
        for block in 0..self.blocks.count {
            self.put_block(block, &mut bytes);
            varint::write(&mut head, bytes.len() as u64);
            head.extend(crc32(&bytes).to_le_bytes());
        }
        sink.write_all(&SIGNATURE.with_head(&head))?;
        for block in 0..self.blocks.count {
            self.put_block(block, &mut bytes);
            sink.write_all(&bytes)?;
        }
        Ok(())
    }

    /// The bytes of a block that is there.
    fn put_block(&self, block: usize, bytes: &mut Vec<u8>) {
        bytes.clear();
        let stored = self.nodes[block].as_deref().unwrap_or_default();
        let nodes = || {
            self.blocks
                .vertices(block)
                .map(|(inside, _)| stored[inside])
        };

        let is_whole = nodes().all(|it| it.height.is_nan() || is_whole(it.height));
        bytes.push(is_whole.into());
        match is_whole {
            false => nodes().for_each(|it| bytes.extend(it.height.to_le_bytes())),
            true => {
                let mut before = 0;
                for node in nodes() {
                    if node.height.is_nan() {
                        varint::write(bytes, 0);
                        continue;
                    }
                    #[expect(clippy::cast_possible_truncation, reason = "a whole number")]
                    let height = node.height as i64;
                    varint::write(bytes, 1 + varint::zigzag(height - before));
                    before = height;
                }
            }
        }
        nodes().for_each(|it| bytes.extend(it.error.to_le_bytes()));
        nodes().for_each(|it| bytes.extend(it.radius.to_le_bytes()));
    }

    /// Puts a block in its place; `bytes` are its own.
    pub(super) fn read_block(
        &mut self,
        block: usize,
        entry: TinBlock,
        bytes: &[u8],
    ) -> Result<(), DecodeError> {
        let at = usize::try_from(entry.offset).unwrap_or(usize::MAX);
        if !is_sealed(bytes, entry.checksum) {
            return Err(DecodeError::damaged(at));
        }
        let mut reader = FieldReader::new(bytes, at);
        let mut nodes = vec![GridNode::EMPTY; super::grid::BLOCK_NODES].into_boxed_slice();
        let places: Vec<usize> = self.blocks.vertices(block).map(|it| it.0).collect();
        let [kind] = reader.bytes()?;
        let mut before = 0_i64;
        for &place in &places {
            let height = match kind {
                0 => reader.f32s::<1>()?[0],
                1 => match reader.number()?.checked_sub(1) {
                    None => f32::NAN,
                    Some(difference) => {
                        before = before.wrapping_add(varint::unzigzag(difference));
                        before as f32
                    }
                },
                _ => return Err(reader.damaged()),
            };
            if height.is_infinite() {
                return Err(reader.damaged());
            }
            nodes[place].height = height;
        }
        for &place in &places {
            nodes[place].error = u16::from_le_bytes(reader.bytes()?);
        }
        for &place in &places {
            nodes[place].radius = u16::from_le_bytes(reader.bytes()?);
        }
        reader.finish()?;
        self.nodes[block] = Some(nodes);
        Ok(())
    }

    /// A grid without blocks, and where these are, from the head of a file of this length.
    pub(super) fn from_head(
        head: &[u8],
        file_length: u64,
        limits: Limits,
    ) -> Result<StoredHead, DecodeError> {
        let mut reader = FieldReader::new(head, FRONT_BYTES);
        let kind = reader.number()?;
        if kind != GRID {
            let (what, found) = ("kind of terrain", kind);
            return Err(reader.error(DecodeErrorKind::Unknown { what, found }));
        }

        // The grid.
        let size = [
            reader.below(HeightGrid::MOST + 1)?,
            reader.below(HeightGrid::MOST + 1)?,
        ];
        if size.iter().any(|&it| it < 2) {
            return Err(reader.damaged());
        }
        let places = u64::from(size[0]) * u64::from(size[1]);
        let limit = limits.vertices.min(super::hierarchy::MOST_VERTICES);
        if places > limit as u64 {
            let (what, said) = ("places", places);
            return Err(reader.error(DecodeErrorKind::AboveLimit { what, said, limit }));
        }
        let spacing = [reader.f64()?, reader.f64()?];
        if !spacing.iter().all(|&it| it > 0.0 && it.is_finite()) {
            return Err(reader.damaged());
        }
        let mut scales = [LengthScale::up_to(1.0); 2];
        for scale in &mut scales {
            let number = i32::try_from(varint::unzigzag(reader.number()?)).ok();
            *scale = number
                .and_then(LengthScale::from_number)
                .ok_or_else(|| reader.damaged())?;
        }
        let heights = reader.f32s()?;
        let faces = reader.number()?;
        let name = reader.below(MOST_NAME)?;
        let name = reader.slice(name as usize)?.to_vec();
        let name = String::from_utf8(name).map_err(|_| reader.damaged())?;
        if faces > 2 * places
            || !(heights[0] <= heights[1] && heights.iter().all(|it| it.is_finite()))
        {
            return Err(reader.damaged());
        }

        // The blocks, which fill the rest of the file: what is allocated for them is in proportion to it.
        if file_length < LEAST_BYTES * places {
            return Err(reader.damaged());
        }
        let tin = Self::new(size, spacing, scales);
        let mut offset = (FRONT_BYTES + head.len()) as u64;
        let mut blocks = Vec::new();
        for _ in 0..tin.blocks.count {
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
        Ok(StoredHead {
            tin,
            extent: TinExtent { heights, faces },
            name,
            blocks,
        })
    }
}

fn is_whole(height: f32) -> bool {
    height.fract() == 0.0
        && height.abs() < 16_777_216.0
        && (height != 0.0 || height.is_sign_positive())
}

/// Where a head has the checksums of blocks, and how long these are, as far as it can be read.
#[cfg(test)]
pub(super) fn block_places(head: &[u8]) -> Option<Vec<(usize, usize)>> {
    let mut reader = FieldReader::new(head, 0);
    for _ in 0..3 {
        reader.number().ok()?;
    }
    reader.bytes::<16>().ok()?;
    reader.number().ok()?;
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
