//! A vertex hierarchy as bytes, in blocks that are read when they are needed.
//!
//! | part | bytes |
//! |---|---|
//! | magic `MWLD`, version 1 | 5 |
//! | length of the head, CRC-32 of the head | 4 + 4, little-endian |
//! | head: numbers, see [`StoredCounts`], faces at full detail, the ball around all points, then for each block its length, its CRC-32 and the largest error in it, then what attributes are, and a name: see [`stored_rows`] | |
//! | block 0: the roots and the faces that never leave | |
//! | blocks 1, 2 …: 64 points each, from coarse to fine | |
//!
//! Numbers are varints, seven bits a byte, lowest first; positions, errors and radii are `f32`, the ball is four `f64`, little-endian. In a block each
//! field has all its points one after the other, and last come the rows of their vertices. Points and half-edges are stored as
//! differences with a sign from that to which they belong, plus one: 0 stands for none.

use std::ops::Range;

use super::full_detail::FullDetail;
use super::hierarchy::{HierarchyNode, VertexHierarchy};
use super::missing::{BLOCK_POINTS, MissingBlocks};
use super::rows::{VertexRows, size_of};
use super::stored_rows;
use crate::attribute::AttributeInfo;
use crate::bits::{DecodeError, DecodeErrorKind, crc32, varint};
use crate::index::index32;
use crate::limits::Limits;
use crate::lod::block_file::{FRONT_BYTES, Signature};
use crate::lod::cone::PackedCone;
use crate::lod::fields::{FieldReader, is_sealed, put_difference, put_f32s};
use crate::topology::half_edges::{HalfEdge, HalfEdges, NONE};

pub(super) const SIGNATURE: Signature = Signature {
    magic: *b"MWLD",
    version: 1,
    otherwise: DecodeErrorKind::NoHierarchy,
};
/// A point takes more bytes than this in its block.
const LEAST_BYTES: u64 = 28;

/// What a file has in all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StoredCounts {
    pub(super) points: u32,
    pub(super) roots: u32,
    pub(super) root_faces: u32,
    /// With those that are not the first at their points.
    pub(super) vertices: u32,
    pub(super) cut_points: u32,
    pub(super) flat_faces: u32,
}

/// Where a block is, and what it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BlockEntry {
    pub(super) offset: u64,
    pub(super) length: u32,
    pub(super) checksum: u32,
    pub(super) largest_error: f32,
}

/// What stands before the blocks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Head {
    pub(super) counts: StoredCounts,
    pub(super) full: FullDetail,
    /// That of the roots, then those of the other points.
    pub(super) blocks: Vec<BlockEntry>,
    /// What the rows of vertices are.
    pub(super) layouts: Vec<AttributeInfo>,
    /// That of the mesh.
    pub(super) name: String,
}

impl VertexHierarchy {
    /// The hierarchy as bytes, as a `.mwl` file has it.
    ///
    /// # Complexity
    /// Time O(vertices), about 50 bytes each and those of attributes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut blocks = vec![self.root_block()];
        let mut errors = vec![f32::INFINITY];
        let points = self.leaving_points();
        for first in points.clone().step_by(BLOCK_POINTS as usize) {
            let last = first.saturating_add(BLOCK_POINTS).min(points.end);
            blocks.push(self.block(first..last));
            let errors_there = (first..last).map(|point| self.nodes[point as usize].error);
            errors.push(errors_there.fold(0.0, f32::max));
        }

        let mut head = Vec::new();
        for number in [
            self.nodes.len(),
            self.roots as usize,
            self.root_faces as usize,
            self.source_vertices.len(),
            self.cut_points,
            self.flat_faces.len(),
            self.face_count(),
        ] {
            varint::write(&mut head, number as u64);
        }
        head.extend(
            self.full
                .ball_numbers()
                .map(f64::to_le_bytes)
                .as_flattened(),
        );
        for (block, error) in blocks.iter().zip(errors) {
            varint::write(&mut head, block.len() as u64);
            head.extend(crc32(block).to_le_bytes());
            head.extend(error.to_le_bytes());
        }
        stored_rows::write(&mut head, &self.rows.layouts, &self.name);

        let mut bytes = SIGNATURE.with_head(&head);
        for block in blocks {
            bytes.extend(block);
        }
        bytes
    }

    /// The roots with the links of their faces, and what belongs to no block.
    fn root_block(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for root in 0..self.roots {
            put_difference(&mut bytes, root, self.nodes[root as usize].first_child);
            put_f32s(&mut bytes, self.positions[root as usize]);
        }
        for half_edge in 0..3 * self.root_faces {
            varint::write(&mut bytes, self.edges.start(half_edge).into());
            put_difference(&mut bytes, half_edge, self.edges.twin(half_edge));
        }
        let mut before = 0;
        for &point in &self.side_points {
            varint::write(&mut bytes, u64::from(point - before));
            before = point;
        }
        let others = &self.source_vertices[self.nodes.len()..];
        for &source in self.source_vertices[..self.roots as usize]
            .iter()
            .chain(others)
        {
            varint::write(&mut bytes, source.into());
        }
        for &face in &self.flat_faces {
            varint::write(&mut bytes, face.into());
        }
        self.put_rows(&mut bytes, 0..self.roots);
        bytes
    }

    /// Some points that may leave.
    fn block(&self, points: Range<u32>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let nodes = || points.clone().zip(&self.nodes[points.start as usize..]);
        for (point, node) in nodes() {
            for other in [node.parent, node.first_child, node.next_sibling] {
                put_difference(&mut bytes, point, other);
            }
        }
        for (point, node) in nodes() {
            put_f32s(&mut bytes, self.positions[point as usize]);
            put_f32s(&mut bytes, [node.error, node.radius]);
            bytes.extend(node.cone.to_bits().to_le_bytes());
            varint::write(&mut bytes, self.source_vertices[point as usize].into());
        }
        for point in points.clone() {
            let edge = self.edge(point);
            let is_there = u8::from(edge.forth != NONE) | u8::from(edge.back != NONE) << 1;
            #[expect(clippy::cast_possible_truncation, reason = "four bits")]
            bytes.push(self.needs[point as usize] as u8 | is_there << 4);
            for (corner, sides) in edge.stored() {
                put_difference(&mut bytes, point, self.edges.start(corner));
                for side in sides {
                    put_difference(&mut bytes, side, self.edges.twin(side));
                }
            }
        }
        self.put_rows(&mut bytes, points);
        bytes
    }
}

impl Head {
    /// The head of a file of this length from its bytes.
    pub(super) fn from_bytes(
        bytes: &[u8],
        file_length: u64,
        limits: Limits,
    ) -> Result<Self, DecodeError> {
        let mut reader = FieldReader::new(bytes, FRONT_BYTES);
        let most = u32::try_from(limits.vertices)
            .unwrap_or(u32::MAX)
            .min(MOST_POINTS);
        let mut count = |what, limit: u32| {
            let said = reader.number()?;
            match u32::try_from(said).ok().filter(|&it| it <= limit) {
                Some(count) => Ok(count),
                None => Err(reader.error(DecodeErrorKind::AboveLimit {
                    what,
                    said,
                    limit: limit as usize,
                })),
            }
        };
        let points = count("points", most)?;
        let counts = StoredCounts {
            points,
            roots: count("roots", points)?,
            root_faces: count("faces", MOST_POINTS)?,
            vertices: count("vertices", most)?,
            cut_points: count("points", points)?,
            flat_faces: count("faces", MOST_POINTS)?,
        };
        let slots = counts.root_faces + 2 * (points - counts.roots);
        let faces = reader.below(1 + slots)?;
        let mut ball = [0.0; 4];
        for number in &mut ball {
            *number = reader.f64()?;
        }
        let full = FullDetail::from_numbers(faces, ball);
        let full = full.ok_or_else(|| reader.damaged())?;
        if counts.vertices < counts.points {
            return Err(reader.damaged());
        }

        // The blocks, which fill the rest of the file.
        let mut offset = (FRONT_BYTES + bytes.len()) as u64;
        let mut blocks = Vec::new();
        for _ in 0..1 + (points - counts.roots).div_ceil(BLOCK_POINTS) {
            let length = reader.below(u32::MAX)?;
            let entry = BlockEntry {
                offset,
                length,
                checksum: u32::from_le_bytes(reader.bytes()?),
                largest_error: reader.length()?,
            };
            blocks.push(entry);
            offset += u64::from(length);
        }
        if offset != file_length {
            return Err(reader.error(DecodeErrorKind::EndsEarly));
        }
        let (layouts, name) = stored_rows::read(&mut reader)?;
        // What is allocated for all points and vertices is in proportion to the file.
        let least =
            LEAST_BYTES * u64::from(points - counts.roots) + u64::from(counts.vertices - points);
        let sizes: u64 = layouts.iter().map(|info| size_of(info) as u64).sum();
        let rows = sizes.saturating_mul(counts.vertices.into());
        let is_long = sizes > MOST_ROW;
        if is_long || file_length < (least + u64::from(counts.root_faces)).saturating_add(rows) {
            return Err(reader.damaged());
        }
        reader.finish()?;
        Ok(Self {
            counts,
            full,
            blocks,
            layouts,
            name,
        })
    }
}

/// From so many points on, places in a front would not have a bit to spare.
const MOST_POINTS: u32 = 1 << 28;
/// Bytes of the attributes of a vertex.
const MOST_ROW: u64 = 1 << 24;

impl Head {
    /// The hierarchy without the points that may leave: they are read when they are needed. `bytes` are those of block 0.
    pub(super) fn hierarchy(&self, bytes: &[u8]) -> Result<VertexHierarchy, DecodeError> {
        let StoredCounts {
            points,
            roots,
            root_faces,
            vertices,
            ..
        } = self.counts;
        let entry = self.blocks[0];
        let at = usize::try_from(entry.offset).unwrap_or(usize::MAX);
        if !is_sealed(bytes, entry.checksum) {
            return Err(DecodeError::damaged(at));
        }

        let mut reader = FieldReader::new(bytes, at);
        let leaving = points - roots;
        let faces = root_faces + 2 * leaving;
        let mut nodes = Vec::new();
        let mut positions = Vec::new();
        for root in 0..roots {
            nodes.push(HierarchyNode {
                first_child: reader.difference(root, roots..points)?,
                ..HierarchyNode::ROOT
            });
            positions.push(reader.f32s()?);
        }
        let mut edges = Vec::new();
        for half_edge in 0..3 * root_faces {
            edges.push(HalfEdge {
                start: reader.below(vertices)?,
                twin: reader.difference(half_edge, 0..3 * root_faces)?,
            });
        }
        let mut side_points = Vec::new();
        let mut before = 0;
        for _ in points..vertices {
            before += reader.below(points - before)?;
            side_points.push(before);
        }
        let mut source_vertices = vec![NONE; vertices as usize];
        for vertex in (0..roots).chain(points..vertices) {
            source_vertices[vertex as usize] = reader.below(u32::MAX)?;
        }
        let mut flat_faces = Vec::new();
        for _ in 0..self.counts.flat_faces {
            flat_faces.push(reader.below(u32::MAX)?);
        }

        nodes.resize(points as usize, HierarchyNode::ROOT);
        positions.resize(points as usize, [0.0; 3]);
        let none = HalfEdge {
            start: NONE,
            twin: NONE,
        };
        edges.resize(3 * faces as usize, none);
        let errors = self.blocks[1..].iter().map(|block| block.largest_error);
        let mut hierarchy = VertexHierarchy {
            nodes,
            positions,
            roots,
            root_faces,
            side_points,
            edges: HalfEdges::from_edges(edges),
            needs: vec![0; points as usize],
            source_vertices,
            flat_faces,
            cut_points: self.counts.cut_points as usize,
            full: self.full,
            missing: MissingBlocks::new(roots, errors),
            rows: VertexRows::zeros(self.layouts.clone(), vertices as usize),
            name: self.name.clone(),
        };
        hierarchy.read_rows(&mut reader, 0..roots)?;
        reader.finish()?;
        Ok(hierarchy)
    }

    /// Puts a block of points into the hierarchy; `bytes` are its own.
    pub(super) fn put_block(
        &self,
        block: usize,
        bytes: &[u8],
        hierarchy: &mut VertexHierarchy,
    ) -> Result<(), DecodeError> {
        let entry = self.blocks[1 + block];
        let at = usize::try_from(entry.offset).unwrap_or(usize::MAX);
        if !is_sealed(bytes, entry.checksum) {
            return Err(DecodeError::damaged(at));
        }
        let StoredCounts {
            points,
            roots,
            vertices,
            ..
        } = self.counts;
        let half_edges = index32(hierarchy.edges.len());
        let first = roots + index32(block) * BLOCK_POINTS;
        let there = first..(first + BLOCK_POINTS).min(points);

        let mut reader = FieldReader::new(bytes, at);
        for point in there.clone() {
            let parent = reader.difference(point, 0..points)?;
            let first_child = reader.difference(point, roots..points)?;
            let next_sibling = reader.difference(point, roots..points)?;
            if parent == NONE {
                return Err(reader.damaged());
            }
            hierarchy.nodes[point as usize] = HierarchyNode {
                parent,
                first_child,
                next_sibling,
                ..HierarchyNode::ROOT
            };
        }
        for point in there.clone() {
            hierarchy.positions[point as usize] = reader.f32s()?;
            let (error, radius) = (reader.length()?, reader.length()?);
            let node = &mut hierarchy.nodes[point as usize];
            (node.error, node.radius) = (error, radius);
            node.cone = PackedCone::from_bits(u32::from_le_bytes(reader.bytes()?));
            hierarchy.source_vertices[point as usize] = reader.below(u32::MAX)?;
        }
        for point in there.clone() {
            let [flags] = reader.bytes()?;
            if flags >= 0x40 {
                return Err(reader.damaged());
            }
            hierarchy.needs[point as usize] = (flags % 16).into();
            hierarchy.put_edge(point, [flags & 0x10 != 0, flags & 0x20 != 0]);
            for (corner, sides) in hierarchy.edge(point).stored() {
                let start = reader.difference(point, 0..vertices)?;
                if start == NONE {
                    return Err(reader.damaged());
                }
                hierarchy.edges.set_start(corner, start);
                for side in sides {
                    let twin = reader.difference(side, 0..half_edges)?;
                    hierarchy.edges.set_twin(side, twin);
                }
            }
        }
        hierarchy.read_rows(&mut reader, there)?;
        reader.finish()?;
        hierarchy.missing.read(block);
        Ok(())
    }
}

/// Gives the blocks and the head of damaged bytes the checksums that they should have, as far as the head can be read.
#[cfg(test)]
pub(crate) fn reseal(bytes: &mut [u8]) {
    let Some((front, rest)) = bytes.split_first_chunk_mut::<FRONT_BYTES>() else {
        return;
    };
    let Ok((length, _)) = SIGNATURE.head_length(front) else {
        return;
    };
    let Some((head, mut blocks)) = rest.split_at_mut_checked(length) else {
        return;
    };
    let mut reader = FieldReader::new(head, 0);
    let mut places = Vec::new();
    let mut counts = [0; 6];
    for count in &mut counts {
        match reader.number() {
            Ok(found) => *count = found,
            Err(_) => return,
        }
    }
    if reader.number().is_err() || reader.bytes::<32>().is_err() {
        return;
    }
    let leaving = counts[0].saturating_sub(counts[1]);
    for _ in 0..=leaving.div_ceil(BLOCK_POINTS.into()) {
        let Ok(length) = reader.number() else { break };
        places.push((head.len() - reader.left(), length));
        if reader.bytes::<8>().is_err() {
            break;
        }
    }
    for (place, length) in places {
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        let Some((block, rest)) = std::mem::take(&mut blocks).split_at_mut_checked(length) else {
            break;
        };
        if let Some(sum) = head.get_mut(place..place + 4) {
            sum.copy_from_slice(&crc32(block).to_le_bytes());
        }
        blocks = rest;
    }
    front[9..].copy_from_slice(&crc32(head).to_le_bytes());
}
