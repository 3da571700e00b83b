//! The hierarchy of a grid in a file.
//!
//! Its fields are columns and rows, two varints; how far columns and rows are apart, two `f64`; and the scales of errors and of radii
//! ([`LengthScale`]), two varints with a sign.
//!
//! Blocks are those of [`GridBlocks`](super::grid::GridBlocks), the finest level first, each with its vertices in their order: all
//! heights, all errors, all radii. A byte says how heights are stored: 0, as `f32`; 1, as whole numbers, each the difference from
//! the one before, with a sign, plus one, as a varint. A void is NaN, or 0. Errors and radii are codes of 16 bits; the highest bit
//! of an error says that the first triangle of the vertex is void, that of a radius the second one.

use super::grid::{BLOCK_NODES, GridNode, GridTin};
use super::rounded::LengthScale;
use super::stored_tree::{StoredTree, check_count};
use crate::bits::{DecodeError, varint};
use crate::height_grid::{HeightGrid, is_spacing};
use crate::limits::Limits;
use crate::lod::fields::FieldReader;

/// Most vertices: four faces begin at each, and have numbers.
pub(super) const MOST_PLACES: usize = 1 << 30;

impl StoredTree for GridTin {
    const KIND: u64 = 0;
    const LEAST_BYTES: u64 = 5;

    fn put_fields(&self, head: &mut Vec<u8>) {
        for number in self.blocks.square.size {
            varint::write(head, number.into());
        }
        head.extend(self.spacing.map(f64::to_le_bytes).as_flattened());
        for scale in [self.errors, self.radii] {
            varint::write(head, varint::zigzag(scale.number().into()));
        }
    }

    fn from_fields(
        reader: &mut FieldReader<'_>,
        file_length: u64,
        limits: Limits,
    ) -> Result<Self, DecodeError> {
        let most = HeightGrid::MOST + 1;
        let size = [reader.below(most)?, reader.below(most)?];
        if size.iter().any(|&it| it < 2) {
            return Err(reader.damaged());
        }
        let places = u64::from(size[0]) * u64::from(size[1]);
        check_count::<Self>(reader, places, MOST_PLACES, file_length, limits)?;
        let spacing = [reader.f64()?, reader.f64()?];
        if !is_spacing(size, spacing) {
            return Err(reader.damaged());
        }
        let mut scales = [LengthScale::up_to(1.0); 2];
        for scale in &mut scales {
            let number = i32::try_from(varint::unzigzag(reader.number()?)).ok();
            *scale = number
                .and_then(LengthScale::from_number)
                .ok_or_else(|| reader.damaged())?;
        }
        Ok(Self::new(size, spacing, scales))
    }

    fn vertex_count(&self) -> usize {
        let [columns, rows] = self.blocks.square.size;
        columns as usize * rows as usize
    }

    fn block_count(&self) -> usize {
        self.blocks.count
    }

    fn corner_block(&self) -> usize {
        self.blocks.count - 1
    }

    fn has_block(&self, block: usize) -> bool {
        self.nodes[block].is_some()
    }

    fn put_block(&self, block: usize, bytes: &mut Vec<u8>) {
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

    fn read_block(
        &mut self,
        block: usize,
        reader: &mut FieldReader<'_>,
    ) -> Result<(), DecodeError> {
        let mut nodes = vec![GridNode::EMPTY; BLOCK_NODES].into_boxed_slice();
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
        self.nodes[block] = Some(nodes);
        Ok(())
    }
}

/// Whether a height is stored as a whole number; not so a zero with a sign.
fn is_whole(height: f32) -> bool {
    let is_zero = height == 0.0 && height.is_sign_negative();
    height.fract() == 0.0 && height.abs() < 16_777_216.0 && !is_zero
}
