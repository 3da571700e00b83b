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

use super::extent::TinExtent;
use super::grid::GridTin;
use super::points::PointHierarchy;
use super::stored_tree::{StoredTree, TinBlock};
use super::tree::TinTree;
use crate::bits::{DecodeError, DecodeErrorKind};
use crate::limits::Limits;
use crate::lod::block_file::FRONT_BYTES;
use crate::lod::fields::FieldReader;

/// Bytes of a name.
const MOST_NAME: u32 = 1 << 16;

/// What a file says before its blocks.
pub(super) struct StoredHead {
    /// Without blocks.
    pub(super) tree: TinTree,
    pub(super) extent: TinExtent,
    pub(super) name: String,
    pub(super) blocks: Vec<TinBlock>,
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
