//! The order of the source, which is stored on request.
//!
//! After the blocks, for each face where it was in the source and which of its corners was first, then for each vertex
//! where it was: as steps from the place after that of the one before.

use super::options::KeepOrder;
use crate::bits::{
    AdaptiveTable, DecodeError, DecodeErrorKind, Lane, NumberCoder, Port, RansDecoder, RansEncoder,
    varint,
};
use crate::index::index32;
use crate::mesh::Mesh;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// How many places a block has.
const BLOCK_SIZE: usize = 4096;

/// The way from a mesh as it is stored to the order of its source, as far as that is stored too.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SourceOrder {
    faces: Option<FaceOrder>,
    vertices: Option<VertexOrder>,
}

impl SourceOrder {
    /// The order of the faces, with the corner that came first.
    #[must_use]
    pub fn faces(&self) -> Option<&FaceOrder> {
        self.faces.as_ref()
    }

    /// The order of the vertices.
    #[must_use]
    pub fn vertices(&self) -> Option<&VertexOrder> {
        self.vertices.as_ref()
    }

    /// The mesh with its faces, its vertices or both as they were in the source.
    ///
    /// # Panics
    /// If the mesh has another number of faces or vertices.
    #[must_use]
    pub fn restore(&self, mesh: Mesh) -> Mesh {
        let mesh = match &self.faces {
            Some(order) => mesh.with_face_order(order),
            None => mesh,
        };
        match &self.vertices {
            Some(order) => mesh.with_vertex_order(order),
            None => mesh,
        }
    }
}

/// What both sides know of the last places.
#[derive(Debug)]
struct SourcePlaces {
    count: u32,
    /// Where the next one is expected.
    next: u32,
    /// Steps, by how many bits the last one had.
    steps: Vec<NumberCoder>,
    last_bits: usize,
    /// Of faces: which corner was first, by the same of the face before.
    turns: [AdaptiveTable; 3],
    last_turn: usize,
}

impl SourcePlaces {
    fn new(count: usize) -> Self {
        Self {
            count: u32::try_from(count).unwrap_or(u32::MAX),
            next: 0,
            steps: vec![NumberCoder::NEW; u32::BITS as usize + 1],
            last_bits: 0,
            turns: [AdaptiveTable::EVEN; 3],
            last_turn: 0,
        }
    }

    /// A place that was read, or the one that was given; `None` if none was written so.
    fn place(&mut self, port: &mut impl Port, place: u32) -> Option<u32> {
        // The nearest ways around all places: 0, 1 back, 1 on, 2 back …
        let count = u64::from(self.count);
        let on = (u64::from(place) + count - u64::from(self.next)) % count;
        let back = count - on;
        let step = if on < back { 2 * on } else { 2 * back - 1 };
        let step = index32(usize::try_from(step).unwrap_or(0));

        let step = self.steps[self.last_bits].code(port, step);
        self.last_bits = (u32::BITS - step.leading_zeros()) as usize;
        let far = u64::from(step.div_ceil(2));
        let on = match step % 2 {
            0 => far,
            _ => count.checked_sub(far)?,
        };
        let place = (u64::from(self.next) + on) % count;
        let place = u32::try_from(place).ok().filter(|_| step < self.count)?;
        self.next = (place + 1) % self.count;
        Some(place)
    }

    /// How far a face that was read, or given, is turned.
    fn turn(&mut self, port: &mut impl Port, turn: u8) -> Option<u8> {
        let table = &mut self.turns[self.last_turn];
        let symbol = port.code(Lane::ALL[0], table, turn.into());
        table.see(symbol);
        self.last_turn = symbol;
        u8::try_from(symbol).ok().filter(|&turn| turn < 3)
    }
}

/// Appends the blocks of what is kept; returns about how many bytes they take.
pub(super) fn write(
    bytes: &mut Vec<u8>,
    faces: &FaceOrder,
    vertices: &VertexOrder,
    keep: KeepOrder,
) -> f64 {
    let begin = bytes.len();
    let [keeps_faces, keeps_vertices] = keep.parts();
    let orders = [
        (keeps_faces, faces.new_to_old(), Some(faces)),
        (keeps_vertices, vertices.new_to_old(), None),
    ];
    for (_, new_to_old, turned) in orders.into_iter().filter(|&(keeps, ..)| keeps) {
        let mut places = SourcePlaces::new(new_to_old.len());
        let mut port = RansEncoder::new(1);
        let mut new = 0;
        for some in new_to_old.chunks(BLOCK_SIZE) {
            for &old in some {
                places.place(&mut port, old);
                if let Some(faces) = turned {
                    places.turn(&mut port, faces.rotation(new));
                }
                new += 1;
            }
            let block = port.finish();
            varint::write(bytes, block.len() as u64);
            bytes.extend(block);
        }
    }
    (bytes.len() - begin) as f64
}

/// Reads what [`write()`] wrote, block by block.
#[derive(Debug)]
pub(super) struct OrderReader {
    /// Of the faces, then of the vertices, where each is kept.
    parts: [Option<OrderPart>; 2],
}

/// An order while it is read.
#[derive(Debug)]
struct OrderPart {
    places: SourcePlaces,
    has_turns: bool,
    old_to_new: Vec<u32>,
    /// How far the face at each place of the source is turned back.
    turns: Vec<u8>,
    read: usize,
}

/// Stands for a place that was not read yet.
const NONE: u32 = u32::MAX;

impl OrderReader {
    pub(super) fn new([faces, vertices]: [Option<usize>; 2]) -> Self {
        let part = |count: usize, has_turns| OrderPart {
            places: SourcePlaces::new(count),
            has_turns,
            old_to_new: Vec::new(),
            turns: Vec::new(),
            read: 0,
        };
        Self {
            parts: [
                faces.map(|count| part(count, true)),
                vertices.map(|count| part(count, false)),
            ],
        }
    }

    pub(super) fn is_complete(&self) -> bool {
        self.parts.iter().flatten().all(OrderPart::is_complete)
    }

    /// Reads the next block; returns how many bytes it has, or `None` if not all of them are there.
    pub(super) fn read_piece(&mut self, bytes: &[u8]) -> Result<Option<usize>, DecodeError> {
        let Some(part) = self.parts.iter_mut().flatten().find(|it| !it.is_complete()) else {
            return Ok(Some(0));
        };
        let mut rest = bytes;
        let length = match varint::read(&mut rest) {
            Some(length) => usize::try_from(length).unwrap_or(usize::MAX),
            None if bytes.len() < varint::LONGEST => return Ok(None),
            None => return Err(DecodeError::damaged(0)),
        };
        let begins = bytes.len() - rest.len();
        let Some(block) = rest.get(..length) else {
            return Ok(None);
        };
        let read = part.read_block(block);
        read.map_err(|error| DecodeError {
            byte: begins + error.byte,
            ..error
        })?;
        Ok(Some(begins + length))
    }

    /// What was read; nothing of it is left.
    pub(super) fn take(&mut self) -> SourceOrder {
        let [faces, vertices] = std::mem::take(&mut self.parts);
        let faces = faces.map(|part| {
            let permutation = Permutation::from_algorithm(part.old_to_new);
            FaceOrder::new(permutation, part.turns).expect("a rotation for each face")
        });
        let vertices = vertices.map(|part| Permutation::from_algorithm(part.old_to_new).into());
        SourceOrder { faces, vertices }
    }
}

impl OrderPart {
    fn is_complete(&self) -> bool {
        self.read == self.places.count as usize
    }

    fn read_block(&mut self, block: &[u8]) -> Result<(), DecodeError> {
        let count = self.places.count as usize;
        self.old_to_new.resize(count, NONE);
        self.turns.resize(if self.has_turns { count } else { 0 }, 0);
        let mut port = RansDecoder::new(1);
        port.begin(block);
        for _ in 0..(count - self.read).min(BLOCK_SIZE) {
            // A place that is free.
            let place = self.places.place(&mut port, 0);
            port.check()?;
            let damaged = || port.error(DecodeErrorKind::Damaged);
            let old = place.ok_or_else(damaged)? as usize;
            if self.old_to_new[old] != NONE {
                return Err(damaged());
            }
            self.old_to_new[old] = index32(self.read);

            // How it is turned back.
            if self.has_turns {
                let turn = self.places.turn(&mut port, 0);
                let turn = turn.ok_or_else(|| port.error(DecodeErrorKind::Damaged))?;
                self.turns[old] = (3 - turn) % 3;
            }
            self.read += 1;
        }
        port.finish()
    }
}
