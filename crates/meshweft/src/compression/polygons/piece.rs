//! The polygons while a stream is read.

use super::PolygonOrder;
use crate::bits::{DecodeError, varint};

/// What is stored of the polygons, or as much of it as is still to be passed over.
#[derive(Debug, Default)]
pub(in crate::compression) struct PolygonPiece {
    left: PolygonsLeft,
    /// What reads them, if somebody asked for them: what nobody asks for is not part of a small program.
    read: Option<ReadPolygons>,
    /// All faces, if they are read.
    faces: Vec<[u32; 3]>,
    found: Option<PolygonOrder>,
}

/// Reads the polygons of faces from all bytes that are stored of them.
type ReadPolygons = fn(&[u8], &[[u32; 3]], usize) -> Result<PolygonOrder, DecodeError>;

/// How much of the polygons is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum PolygonsLeft {
    #[default]
    Nothing,
    Unknown,
    Bytes(usize),
}

impl PolygonPiece {
    /// Polygons are to be read.
    pub(in crate::compression) fn ask(&mut self, read: ReadPolygons) {
        self.read = Some(read);
    }

    /// The stream has some.
    pub(in crate::compression) fn expect(&mut self) {
        self.left = PolygonsLeft::Unknown;
    }

    /// What was read; nothing of it is left.
    pub(in crate::compression) fn take(&mut self) -> Option<PolygonOrder> {
        self.found.take()
    }

    pub(in crate::compression) fn is_complete(&self) -> bool {
        self.left == PolygonsLeft::Nothing
    }

    /// Faces that were read.
    pub(in crate::compression) fn keep(&mut self, faces: &[[u32; 3]]) {
        if !self.is_complete() && self.read.is_some() {
            self.faces.extend(faces);
        }
    }

    /// Reads the next piece; returns its length, or `None` if not all of it is there.
    pub(in crate::compression) fn read_piece(
        &mut self,
        bytes: &[u8],
        vertex_count: usize,
    ) -> Result<Option<usize>, DecodeError> {
        let mut rest = bytes;
        let length = match self.left {
            PolygonsLeft::Nothing => 0,
            PolygonsLeft::Bytes(length) => length,
            PolygonsLeft::Unknown => match varint::read(&mut rest) {
                Some(length) => usize::try_from(length).unwrap_or(usize::MAX),
                None if bytes.len() < varint::LONGEST => return Ok(None),
                None => return Err(DecodeError::damaged(0)),
            },
        };
        let begins = bytes.len() - rest.len();
        match (self.read, rest.get(..length)) {
            (Some(read), Some(block)) => {
                let faces = std::mem::take(&mut self.faces);
                let found = read(block, &faces, vertex_count).map_err(|error| DecodeError {
                    byte: begins + error.byte,
                    ..error
                })?;
                self.found = Some(found);
            }
            (Some(_), None) => return Ok(None),
            (None, Some(_)) => {}
            // Passed over as it comes.
            (None, None) => {
                self.left = PolygonsLeft::Bytes(length - rest.len());
                return Ok(Some(bytes.len()).filter(|_| !bytes.is_empty()));
            }
        }
        self.left = PolygonsLeft::Nothing;
        Ok(Some(begins + length))
    }
}
