//! Bytes as a mesh.

use super::mesh_code::{HAS_POLYGONS, IS_LOSSLESS, KEEPS};
use super::options::Tier;
use super::polygons::{PolygonOrder, PolygonPiece, diagonals};
use super::positions::{Coordinate, Exact, OnLattice, Positions};
use super::source_order::{OrderReader, SourceOrder};
use crate::bits::{DecodeError, DecodeErrorKind, varint};
#[cfg(feature = "default-tier")]
use crate::connectivity::MixedModel;
use crate::connectivity::{BlockReader, FanModel, TableModel};
use crate::geometry::Lattice;
use crate::limits::Limits;

/// Decodes a mesh while its bytes arrive.
///
/// Vertices and faces come block by block, and a face never before its vertices. What was not taken stays; beyond
/// that, the decoder needs at most 64 KiB and 256 bytes for each vertex of the buffer that minimum-time rendering needs,
/// where a push brings no more than one block. Where the order of the source is stored, it comes after all faces, and takes
/// five bytes a face and four a vertex.
/// Polygons come before it; they are passed over unless the decoder was made [with polygons](Self::with_polygons).
///
/// ```
/// use meshweft::compression::{CodeOptions, MeshCode, MeshDecoder};
/// use meshweft::{Limits, Mesh};
///
/// let mesh = Mesh::new(vec![[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2]])?;
/// let code = MeshCode::new(&mesh, &CodeOptions::default())?;
/// let mut decoder = MeshDecoder::new(Limits::default());
/// let (mut positions, mut faces) = (Vec::new(), Vec::new());
/// for some in code.bytes().chunks(5) {
///     decoder.push(some)?;
///     positions.extend(decoder.take_positions());
///     faces.extend(decoder.take_faces());
/// }
/// decoder.finish()?;
/// assert_eq!((positions.len(), faces), (3, vec![[0, 1, 2]]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct MeshDecoder {
    limits: Limits,
    /// Bytes of the block that is not complete yet.
    waiting: Vec<u8>,
    /// Bytes before them.
    passed: usize,
    reader: Option<MeshBlocks>,
    polygons: PolygonPiece,
    order: OrderReader,
    positions: Vec<[f32; 3]>,
    error: Option<DecodeError>,
}

/// The blocks, by how positions are stored and faces are coded.
#[derive(Debug)]
struct MeshBlocks {
    reader: TierReader,
    frame: PositionFrame,
}

/// How numbers become coordinates.
#[derive(Debug, Clone, Copy)]
enum PositionFrame {
    Lossless,
    OnLattice { lattice: Lattice, origin: [i64; 3] },
}

type PositionReader<C, M> = BlockReader<Positions<'static, C, M>>;

#[derive(Debug)]
enum TierReader {
    FastLossless(PositionReader<Exact, TableModel>),
    FastOnLattice(PositionReader<OnLattice, TableModel>),
    #[cfg(feature = "default-tier")]
    Lossless(PositionReader<Exact, MixedModel>),
    #[cfg(feature = "default-tier")]
    OnLattice(PositionReader<OnLattice, MixedModel>),
}

/// Does the same with any.
macro_rules! with_reader {
    ($of:expr, $reader:ident => $do:expr) => {
        match $of {
            TierReader::FastLossless($reader) => $do,
            TierReader::FastOnLattice($reader) => $do,
            #[cfg(feature = "default-tier")]
            TierReader::Lossless($reader) => $do,
            #[cfg(feature = "default-tier")]
            TierReader::OnLattice($reader) => $do,
        }
    };
}

impl PositionFrame {
    fn coordinates(&self, numbers: [u32; 3]) -> [f32; 3] {
        match self {
            Self::Lossless => numbers.map(Exact::coordinate),
            Self::OnLattice { lattice, origin } => [0, 1, 2]
                .map(|axis| lattice.coordinate(origin[axis].saturating_add(numbers[axis].into()))),
        }
    }
}

impl MeshDecoder {
    /// A decoder that refuses meshes with more vertices or faces than the limits allow.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            waiting: Vec::new(),
            passed: 0,
            reader: None,
            polygons: PolygonPiece::default(),
            order: OrderReader::new([None; 2]),
            positions: Vec::new(),
            error: None,
        }
    }

    /// A decoder that also gives the polygons of the mesh. It keeps all faces until the end, and then needs about 40 bytes a
    /// face.
    #[must_use]
    pub fn with_polygons(limits: Limits) -> Self {
        let mut decoder = Self::new(limits);
        decoder.polygons.ask(diagonals::read);
        decoder
    }

    /// Takes the next bytes; returns how many of them belong to the mesh: all, unless it is complete.
    ///
    /// # Errors
    /// What was read is damaged, is not a mesh, or is above the limits. Then the decoder gives the same error for
    /// all that comes.
    pub fn push(&mut self, bytes: &[u8]) -> Result<usize, DecodeError> {
        if let Some(error) = &self.error {
            return Err(error.clone());
        }

        // Where nothing waits, nothing is copied but the bytes of the last block.
        let mut waiting = std::mem::take(&mut self.waiting);
        let before = waiting.len();
        let next = match before {
            0 => bytes,
            _ => {
                append(&mut waiting, bytes);
                &waiting
            }
        };
        let used = self.read_all(next)?;
        self.passed += used;
        if self.is_complete() {
            return Ok(used - before);
        }
        match before {
            0 => append(&mut waiting, &bytes[used..]),
            _ => drop(waiting.drain(..used)),
        }
        self.waiting = waiting;
        Ok(bytes.len())
    }

    /// Reads all pieces that are complete; returns their length.
    fn read_all(&mut self, bytes: &[u8]) -> Result<usize, DecodeError> {
        let mut used = 0;
        while !self.is_complete() {
            match self.read(&bytes[used..]) {
                Ok(Some(length)) => used += length,
                Ok(None) => break,
                Err(mut error) => {
                    error.byte += self.passed + used;
                    self.error = Some(error.clone());
                    return Err(error);
                }
            }
        }
        Ok(used)
    }

    /// Reads the next piece; returns its length, or `None` if it is not complete.
    fn read(&mut self, bytes: &[u8]) -> Result<Option<usize>, DecodeError> {
        let Some(reader) = &mut self.reader else {
            let mut rest = bytes;
            let read = read_beginning(&mut rest, self.limits).map_err(|kind| DecodeError {
                byte: bytes.len() - rest.len(),
                kind,
            })?;
            return Ok(read.map(|(reader, has_polygons, order)| {
                (self.reader, self.order) = (Some(reader), order);
                if has_polygons {
                    self.polygons.expect();
                }
                bytes.len() - rest.len()
            }));
        };
        let MeshBlocks { reader, frame } = reader;
        if with_reader!(&*reader, reader => reader.is_complete()) {
            let [vertex_count, _] = with_reader!(&*reader, reader => reader.counts());
            return match self.polygons.is_complete() {
                false => self.polygons.read_piece(bytes, vertex_count),
                true => self.order.read_piece(bytes),
            };
        }
        let (positions, polygons) = (&mut self.positions, &mut self.polygons);
        let read = with_reader!(reader, reader => {
            let taken = reader.faces().len();
            let read = reader.read_piece(bytes)?;
            polygons.keep(&reader.faces()[taken..]);
            let numbers = std::mem::take(&mut reader.at_vertices().read);
            add(positions, numbers, |numbers| frame.coordinates(numbers));
            read
        });
        Ok(read)
    }

    /// Whether the whole mesh was read.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        let reader = self.reader.as_ref();
        let is_complete =
            |reader: &MeshBlocks| with_reader!(&reader.reader, reader => reader.is_complete());
        reader.is_some_and(is_complete) && self.polygons.is_complete() && self.order.is_complete()
    }

    /// How many vertices and faces the mesh has, once that was read.
    #[must_use]
    pub fn counts(&self) -> Option<[usize; 2]> {
        let reader = self.reader.as_ref()?;
        Some(with_reader!(&reader.reader, reader => reader.counts()))
    }

    /// The positions that were read since they were last taken, in the order of the vertices.
    pub fn take_positions(&mut self) -> Vec<[f32; 3]> {
        std::mem::take(&mut self.positions)
    }

    /// The faces that were read since they were last taken.
    pub fn take_faces(&mut self) -> Vec<[u32; 3]> {
        match &mut self.reader {
            Some(reader) => {
                with_reader!(&mut reader.reader, reader => std::mem::take(reader.faces()))
            }
            None => Vec::new(),
        }
    }

    /// What of the order of the source is stored, once everything was read. What was taken does not come again.
    pub fn take_source_order(&mut self) -> Option<SourceOrder> {
        self.is_complete().then(|| self.order.take())
    }

    /// The polygons, once everything was read; none if all faces are triangles, or if the decoder was not made
    /// [with them](Self::with_polygons). What was taken does not come again.
    pub fn take_polygons(&mut self) -> Option<PolygonOrder> {
        self.is_complete().then(|| self.polygons.take()).flatten()
    }

    /// # Errors
    /// The mesh is not complete.
    pub fn finish(&self) -> Result<(), DecodeError> {
        match (&self.error, self.is_complete()) {
            (Some(error), _) => Err(error.clone()),
            (None, true) => Ok(()),
            (None, false) => Err(DecodeError {
                byte: self.passed + self.waiting.len(),
                kind: DecodeErrorKind::EndsEarly,
            }),
        }
    }
}

/// Appends bytes to those that wait. Grown by half, not to twice as much: this is most of what a decoder keeps.
fn append(waiting: &mut Vec<u8>, bytes: &[u8]) {
    if waiting.capacity() - waiting.len() < bytes.len() {
        waiting.reserve_exact(bytes.len().max(waiting.len() / 2));
    }
    waiting.extend_from_slice(bytes);
}

/// Appends positions that were read as numbers: where none wait, in the memory of the numbers.
fn add(
    positions: &mut Vec<[f32; 3]>,
    read: Vec<[u32; 3]>,
    position: impl FnMut([u32; 3]) -> [f32; 3],
) {
    let read = read.into_iter().map(position);
    match positions.is_empty() {
        true => *positions = read.collect(),
        false => positions.extend(read),
    }
}

/// What is before the blocks, and whether polygons follow them, or `None` if it is not complete.
fn read_beginning(
    bytes: &mut &[u8],
    limits: Limits,
) -> Result<Option<(MeshBlocks, bool, OrderReader)>, DecodeErrorKind> {
    // How it is coded.
    let Some(&[tier, flags]) = bytes.first_chunk() else {
        return Ok(None);
    };
    let unknown = |what, found: u8| DecodeErrorKind::Unknown {
        what,
        found: found.into(),
    };
    let tier = Tier::ALL.get(usize::from(tier));
    let tier = *tier.ok_or(unknown("tier", bytes[0]))?;
    if flags & !(IS_LOSSLESS | KEEPS[0] | KEEPS[1] | HAS_POLYGONS) != 0 {
        return Err(unknown("kind of stream", flags));
    }

    // How much there is.
    let mut rest = &bytes[2..];
    let is_cut = |rest: &[u8]| rest.len() < varint::LONGEST;
    let mut counts = [0; 2];
    let (most, names) = ([limits.vertices, limits.faces], ["vertices", "faces"]);
    for ((count, limit), what) in counts.iter_mut().zip(most).zip(names) {
        let said = match varint::read(&mut rest) {
            Some(said) => said,
            None if is_cut(rest) => return Ok(None),
            None => return Err(DecodeErrorKind::Damaged),
        };
        let allowed = usize::try_from(said).ok().filter(|&said| said <= limit);
        *count = allowed.ok_or(DecodeErrorKind::AboveLimit { what, said, limit })?;
    }
    let [vertices, faces] = counts;
    let kept = |flag, count| (flags & flag != 0).then_some(count);
    let kept = [kept(KEEPS[0], faces), kept(KEEPS[1], vertices)];

    // Where positions are.
    let mut frame = PositionFrame::Lossless;
    if flags & IS_LOSSLESS == 0 {
        let Some((step, mut after)) = rest.split_first_chunk() else {
            return Ok(None);
        };
        let lattice = Lattice::new(f64::from_le_bytes(*step)).ok_or(DecodeErrorKind::Damaged)?;
        let mut origin = [0; 3];
        for multiple in &mut origin {
            match varint::read(&mut after) {
                Some(number) => *multiple = varint::unzigzag(number),
                None if is_cut(after) => return Ok(None),
                None => return Err(DecodeErrorKind::Damaged),
            }
        }
        rest = after;
        frame = PositionFrame::OnLattice { lattice, origin };
    }

    // What reads them.
    let counts = [faces, vertices];
    let reader = match (tier, frame) {
        (Tier::Fast, PositionFrame::Lossless) => TierReader::FastLossless(reader_of(counts)),
        (Tier::Fast, PositionFrame::OnLattice { .. }) => {
            TierReader::FastOnLattice(reader_of(counts))
        }
        #[cfg(feature = "default-tier")]
        (Tier::Default, PositionFrame::Lossless) => TierReader::Lossless(reader_of(counts)),
        #[cfg(feature = "default-tier")]
        (Tier::Default, PositionFrame::OnLattice { .. }) => {
            TierReader::OnLattice(reader_of(counts))
        }
    };
    *bytes = rest;
    let reader = MeshBlocks { reader, frame };
    let has_polygons = flags & HAS_POLYGONS != 0;
    Ok(Some((reader, has_polygons, OrderReader::new(kept))))
}

fn reader_of<C: Coordinate, M: FanModel>([faces, vertices]: [usize; 2]) -> PositionReader<C, M> {
    BlockReader::new(faces, vertices, C::BLOCK_SIZE, Positions::new(None))
}
