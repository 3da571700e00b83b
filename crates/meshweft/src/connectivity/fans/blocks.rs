//! Faces and what belongs to their vertices as bytes, in blocks that are read one by one.
//!
//! A stream has the number of faces that name a vertex twice, then blocks, each with its length before it:
//! blocks of fans, as long as faces are left; blocks of the vertices that have none; blocks of the faces that name a
//! vertex twice.

use super::decoder::FanDecoder;
use super::encoder::FanEncoder;
use super::flat_faces::{self, FlatFaces};
use super::traversal::{Fans, Traversal};
use super::vertex_coder::VertexCoder;
use crate::bits::{DecodeError, DecodeErrorKind, varint};
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// A block ends with the first root after which it has more faces, or vertices, than this.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BlockSize(pub(crate) usize);

/// Room is made for no more than this at once, so that bytes that say much get little.
const MOST_RESERVED: usize = 4096;

impl BlockSize {
    /// Everything in one block of each kind.
    pub(crate) const WHOLE: Self = Self(usize::MAX);
}

/// Faces as bytes, and the orders in which vertices and faces come back.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Blocks {
    pub(crate) bytes: Vec<u8>,
    pub(crate) vertices: VertexOrder,
    pub(crate) faces: FaceOrder,
    /// About how many bits the faces take, and what belongs to the vertices.
    pub(crate) bits: [f64; 2],
}

impl Blocks {
    /// Writes faces and what belongs to their vertices; the traversal begins with a vertex, if it has faces.
    pub(crate) fn write<V: VertexCoder>(
        faces: Faces<'_>,
        first_vertex: u32,
        block_size: BlockSize,
        at_vertices: V,
    ) -> Self {
        let vertex_count = faces.vertex_count();

        // Faces with a repeated corner apart.
        let numbered = || (0_u32..).zip(faces.as_slice());
        let (flat, proper): (Vec<_>, Vec<_>) =
            numbered().partition(|(_, face)| flat_faces::is_flat(**face));
        let proper_faces: Vec<[u32; 3]> = proper.iter().map(|&(_, face)| *face).collect();
        let mut bytes = Vec::new();
        varint::write(&mut bytes, flat.len() as u64);

        // Blocks of fans.
        let proper_faces = Faces::of_checked(&proper_faces, vertex_count);
        let encoder = FanEncoder::new(proper_faces, first_vertex, at_vertices);
        let mut traversal = Traversal::new(encoder, proper.len(), vertex_count);
        let mut block = Vec::new();
        while !traversal.is_complete() {
            let first_root = traversal.root();
            traversal
                .go(block_size.0)
                .expect("faces that were checked are there");
            let encoder = &mut traversal.fans;
            encoder.settle();
            varint::write(&mut block, encoder.more.len() as u64);
            let mut last = first_root;
            for root in encoder.more.drain(..) {
                varint::write(&mut block, u64::from(root - last));
                last = root;
            }
            block.extend(encoder.port.finish());
            append(&mut bytes, &mut block);
        }

        // The other vertices get the last numbers.
        let mut encoder = traversal.fans;
        let met = encoder.old.len();
        let rest = (0..index32(vertex_count)).filter(|&vertex| encoder.is_new(vertex));
        let rest: Vec<u32> = rest.collect();
        encoder.old.extend(rest);
        if V::LANES > 0 {
            let mut vertex = index32(met);
            while (vertex as usize) < vertex_count {
                let end = vertex_count.min((vertex as usize).saturating_add(block_size.0));
                for vertex in vertex..index32(end) {
                    encoder.code_vertex(vertex, [vertex.saturating_sub(1); 3]);
                }
                encoder.settle();
                block.extend(encoder.port.finish());
                append(&mut bytes, &mut block);
                vertex = index32(end);
            }
        }

        // Faces with a repeated corner.
        let vertices = Permutation::from_algorithm(encoder.old);
        let new = vertices.inverse();
        let new = new.new_to_old();
        let renumbered = flat.into_iter().map(|(number, face)| {
            let (face, rotation) = flat_faces::in_place(face.map(|vertex| new[vertex as usize]));
            (face, number, rotation)
        });
        let mut flat: Vec<([u32; 3], u32, u8)> = renumbered.collect();
        flat.sort_unstable();
        let mut flat_faces = FlatFaces::new();
        for some in flat.chunks(block_size.0) {
            for &(face, ..) in some {
                let coded = flat_faces.code(&mut encoder.port, face, vertex_count);
                coded.expect("faces that were checked are there");
            }
            block.extend(encoder.port.finish());
            append(&mut bytes, &mut block);
        }

        // The orders.
        let [of_faces, of_vertices @ ..] = encoder.port.bits_of_lanes();
        let proper_order = encoder.drawn.iter().map(|&place| proper[place as usize].0);
        let order = proper_order.chain(flat.iter().map(|&(_, number, _)| number));
        let order = Permutation::from_algorithm(order.collect());
        let mut rotations = encoder.rotations;
        rotations.extend(flat.iter().map(|&(.., rotation)| rotation));
        Self {
            bits: [of_faces, of_vertices.iter().sum()],
            bytes,
            vertices: vertices.into(),
            faces: FaceOrder::new(order, rotations).expect("a rotation for each face"),
        }
    }
}

/// Appends a block with its length before it, and empties it.
fn append(bytes: &mut Vec<u8>, block: &mut Vec<u8>) {
    varint::write(bytes, block.len() as u64);
    bytes.append(block);
}

/// Reads what [`Blocks`] are, block by block.
#[derive(Debug)]
pub(crate) struct BlockReader<V: VertexCoder> {
    traversal: Traversal<FanDecoder<V>>,
    block_size: BlockSize,
    face_count: usize,
    vertex_count: usize,
    /// How many faces name a vertex twice, once that was read, and how many of them were read.
    flat: Option<usize>,
    flat_read: usize,
    flat_faces: FlatFaces,
    /// Vertices without faces that were read.
    apart_read: usize,
}

impl<V: VertexCoder> BlockReader<V> {
    pub(crate) fn new(
        face_count: usize,
        vertex_count: usize,
        block_size: BlockSize,
        at_vertices: V,
    ) -> Self {
        Self {
            traversal: Traversal::new(FanDecoder::new(at_vertices), face_count, vertex_count),
            block_size,
            face_count,
            vertex_count,
            flat: None,
            flat_read: 0,
            flat_faces: FlatFaces::new(),
            apart_read: 0,
        }
    }

    /// The faces that were read since they were last taken.
    pub(crate) fn faces(&mut self) -> &mut Vec<[u32; 3]> {
        &mut self.traversal.fans.faces
    }

    /// What belongs to the vertices.
    pub(crate) fn at_vertices(&mut self) -> &mut V {
        &mut self.traversal.fans.at_vertices
    }

    /// How many vertices and faces there are.
    pub(crate) fn counts(&self) -> [usize; 2] {
        [self.vertex_count, self.face_count]
    }

    /// Whether everything was read.
    pub(crate) fn is_complete(&self) -> bool {
        self.flat == Some(self.flat_read) && self.traversal.is_complete() && self.apart_left() == 0
    }

    fn apart_left(&self) -> usize {
        match V::LANES {
            0 => 0,
            _ => {
                let met = self.traversal.known.vertex_count() as usize;
                self.vertex_count - met - self.apart_read
            }
        }
    }

    /// Reads the next block, or what is before the first, from the front of bytes; returns how many bytes it has, or
    /// `None` if not all of them are there.
    ///
    /// # Errors
    /// The bytes are damaged or have other counts. The reader must not be used any more.
    pub(crate) fn read_piece(&mut self, bytes: &[u8]) -> Result<Option<usize>, DecodeError> {
        let mut rest = bytes;
        let number = match varint::read(&mut rest) {
            Some(number) => usize::try_from(number).unwrap_or(usize::MAX),
            None if bytes.len() < varint::LONGEST => return Ok(None),
            None => return Err(DecodeError::damaged(0)),
        };
        if self.flat.is_none() {
            self.traversal.leave_out(number)?;
            self.flat = Some(number);
            return Ok(Some(bytes.len() - rest.len()));
        }

        // A whole block.
        let begins = bytes.len() - rest.len();
        let Some(block) = rest.get(..number) else {
            return Ok(None);
        };
        self.reserve();
        let read = match (self.traversal.is_complete(), self.apart_left()) {
            (false, _) => self.read_fans(block),
            (true, 0) => self.read_flat(block),
            (true, left) => self.read_apart(block, left),
        };
        read.map_err(|error| DecodeError {
            byte: begins + error.byte,
            ..error
        })?;
        Ok(Some(begins + number))
    }

    /// Makes room for what the next block has: grown as it comes, it would be up to twice as large.
    fn reserve(&mut self) {
        let most = self.block_size.0.min(MOST_RESERVED);
        let flat_left = self.flat.map_or(0, |flat| flat - self.flat_read);
        let left = self.vertex_count - self.traversal.known.vertex_count() as usize;
        let [faces, vertices] = match (self.traversal.is_complete(), self.apart_left()) {
            // The last root may have some more faces; a surface with a border has more than half as many vertices.
            (false, _) => {
                let faces = self.traversal.faces_left().min(most + most / 64);
                [faces, left.min(faces / 2 + most / 16)]
            }
            (true, 0) => [flat_left.min(most), 0],
            (true, apart) => [0, apart.min(most)],
        };
        let fans = &mut self.traversal.fans;
        fans.faces.reserve(faces);
        fans.at_vertices.expect(vertices);
    }

    fn read_fans(&mut self, block: &[u8]) -> Result<(), DecodeError> {
        // The roots that have fans of their own.
        let mut rest = block;
        let first_root = u64::from(self.traversal.root());
        let fans = &mut self.traversal.fans;
        fans.more.clear();
        fans.passed = 0;
        let damaged = |rest: &[u8]| DecodeError::damaged(block.len() - rest.len());
        let count = varint::read(&mut rest).ok_or_else(|| damaged(rest))?;
        let mut last = first_root;
        for _ in 0..count {
            let step = varint::read(&mut rest).ok_or_else(|| damaged(rest))?;
            last = last.saturating_add(step);
            fans.more.push(u32::try_from(last).unwrap_or(u32::MAX));
        }

        // The fans.
        let begins = block.len() - rest.len();
        fans.port.begin(rest);
        let read = self.traversal.go(self.block_size.0);
        let fans = &mut self.traversal.fans;
        fans.settle();
        let read = read.and_then(|()| match fans.passed == fans.more.len() {
            true => fans.port.finish(),
            false => Err(fans.port.error(DecodeErrorKind::Damaged)),
        });
        read.map_err(|error| DecodeError {
            byte: begins + error.byte,
            ..error
        })
    }

    fn read_apart(&mut self, block: &[u8], left: usize) -> Result<(), DecodeError> {
        let fans = &mut self.traversal.fans;
        fans.port.begin(block);
        let first = self.vertex_count - left;
        let count = left.min(self.block_size.0);
        for vertex in index32(first)..index32(first + count) {
            fans.vertex(vertex, [vertex.saturating_sub(1); 3]);
            fans.check()?;
        }
        fans.settle();
        self.apart_read += count;
        fans.port.finish()
    }

    fn read_flat(&mut self, block: &[u8]) -> Result<(), DecodeError> {
        let left = self.flat.map_or(0, |flat| flat - self.flat_read);
        let fans = &mut self.traversal.fans;
        fans.port.begin(block);
        for _ in 0..left.min(self.block_size.0) {
            let face = self
                .flat_faces
                .code(&mut fans.port, [0; 3], self.vertex_count);
            let face = face.map_err(|kind| fans.port.error(kind))?;
            fans.check()?;
            fans.faces.push(face);
            self.flat_read += 1;
        }
        fans.port.finish()
    }
}
