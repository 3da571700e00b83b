//! The hierarchy over points in a file.
//!
//! Its field is the number of vertices, a varint.
//!
//! Blocks are 512 vertices each, in the order of their numbers: all positions, three `f32` each; all errors and all radii, `f32`;
//! of each vertex whether it is no point of the input, a bit each, the lowest of a byte first; and of each vertex where the four triangles around it are cut: 0, nowhere; otherwise twice the difference of that vertex from this one, and which
//! side of its diamond the triangle is, as a varint.

use std::ops::Range;

use super::point_input::MOST_VERTICES;
use super::points::{BLOCK_VERTICES, CORNERS, PointHierarchy, PointNode, UnreadPoints};
use super::stored_tree::{StoredTree, check_count};
use super::triangle::NONE;
use crate::bits::{DecodeError, varint};
use crate::limits::Limits;
use crate::lod::fields::{FieldReader, put_f32s};

impl PointHierarchy {
    /// The vertices of a block.
    fn block(&self, block: usize) -> Range<usize> {
        let first = block * BLOCK_VERTICES;
        first..(first + BLOCK_VERTICES).min(self.nodes.len())
    }
}

impl StoredTree for PointHierarchy {
    const KIND: u64 = 1;
    const LEAST_BYTES: u64 = 24;

    fn put_fields(&self, head: &mut Vec<u8>) {
        varint::write(head, self.nodes.len() as u64);
    }

    fn from_fields(
        reader: &mut FieldReader<'_>,
        file_length: u64,
        limits: Limits,
    ) -> Result<Self, DecodeError> {
        let vertices = reader.number()?;
        check_count::<Self>(reader, vertices, MOST_VERTICES, file_length, limits)?;
        match usize::try_from(vertices) {
            Ok(vertices) if vertices >= CORNERS as usize => Ok(Self::unread(vertices)),
            _ => Err(reader.damaged()),
        }
    }

    fn vertex_count(&self) -> usize {
        self.nodes.len()
    }

    fn block_count(&self) -> usize {
        self.nodes.len().div_ceil(BLOCK_VERTICES)
    }

    fn corner_block(&self) -> usize {
        0
    }

    fn has_block(&self, block: usize) -> bool {
        !self.unread.blocks.get(block).is_some_and(|&it| it)
    }

    fn put_block(&self, block: usize, bytes: &mut Vec<u8>) {
        let vertices = self.block(block);
        let nodes = &self.nodes[vertices.clone()];
        nodes.iter().for_each(|it| put_f32s(bytes, it.position));
        nodes.iter().for_each(|it| put_f32s(bytes, [it.error]));
        nodes.iter().for_each(|it| put_f32s(bytes, [it.radius]));
        for eight in self.is_steiner[vertices.clone()].chunks(8) {
            let bits = eight.iter().rev().map(|&it| u8::from(it));
            bytes.push(bits.fold(0, |byte, bit| byte << 1 | bit));
        }
        for (vertex, node) in vertices.zip(nodes) {
            for child in node.children {
                // A child has a larger number, so no difference is 0.
                let difference = match child {
                    NONE => 0,
                    _ => u64::from(child) - 2 * vertex as u64,
                };
                varint::write(bytes, difference);
            }
        }
    }

    fn read_block(
        &mut self,
        block: usize,
        reader: &mut FieldReader<'_>,
    ) -> Result<(), DecodeError> {
        let vertices = self.block(block);
        let count = self.nodes.len() as u64;
        let nodes = &mut self.nodes[vertices.clone()];
        for node in nodes.iter_mut() {
            node.position = reader.f32s()?;
            if !node.position.iter().all(|it| it.is_finite()) {
                return Err(reader.damaged());
            }
        }
        for node in nodes.iter_mut() {
            node.error = reader.length()?;
        }
        for node in nodes.iter_mut() {
            node.radius = reader.length()?;
        }
        for eight in self.is_steiner[vertices.clone()].chunks_mut(8) {
            let [mut byte] = reader.bytes()?;
            for it in eight {
                *it = byte & 1 == 1;
                byte >>= 1;
            }
            if byte != 0 {
                return Err(reader.damaged());
            }
        }
        for (vertex, node) in vertices.zip(nodes) {
            for child in &mut node.children {
                let difference = reader.number()?;
                let found = difference.saturating_add(2 * vertex as u64);
                *child = match (difference, u32::try_from(found)) {
                    (0, _) => NONE,
                    (2.., Ok(child)) if found < 2 * count => child,
                    _ => return Err(reader.damaged()),
                };
                let is_used = self.unread.is_used.get_mut(*child as usize);
                if is_used.is_some_and(|it| std::mem::replace(it, true)) {
                    return Err(reader.damaged());
                }
            }
        }
        if let Some(is_unread) = self.unread.blocks.get_mut(block) {
            *is_unread = false;
        }
        Ok(())
    }
}

impl PointHierarchy {
    /// One of which no block was read.
    fn unread(vertices: usize) -> Self {
        // The first two triangles are cut at the vertex after the corners.
        let mut is_used = vec![false; 2 * vertices];
        let first = 2 * CORNERS as usize;
        is_used
            .iter_mut()
            .skip(first)
            .take(2)
            .for_each(|it| *it = true);
        Self {
            nodes: vec![PointNode::EMPTY; vertices],
            sources: Vec::new(),
            is_steiner: vec![false; vertices],
            counts: Default::default(),
            unread: UnreadPoints {
                blocks: vec![true; vertices.div_ceil(BLOCK_VERTICES)],
                is_used,
            },
        }
    }
}
