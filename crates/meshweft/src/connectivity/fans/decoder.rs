//! Reads fans as faces.

use super::known_faces::KnownFaces;
use super::model::Model;
use super::traversal::{FanTurn, Fans, Gap, Run};
use crate::bits::{DecodeError, DecodeErrorKind, RansDecoder};

/// The faces so far.
pub(super) struct FanDecoder<'a> {
    /// The roots that have faces which follow no others, rising.
    more: std::vec::IntoIter<u32>,
    pub(super) faces: Vec<[u32; 3]>,
    model: Model,
    pub(super) port: RansDecoder<'a>,
}

impl<'a> FanDecoder<'a> {
    pub(super) fn new(more: Vec<u32>, port: RansDecoder<'a>) -> Self {
        Self {
            more: more.into_iter(),
            faces: Vec::new(),
            model: Model::new(),
            port,
        }
    }
}

impl Fans for FanDecoder<'_> {
    fn begin_part(&mut self) {}

    fn begin_root(&mut self, _: u32) {}

    #[inline]
    fn run(&mut self, gap: &Gap) -> Run {
        let any = Run {
            new: 0,
            is_end: false,
        };
        self.model.run(&mut self.port, gap, any)
    }

    #[inline]
    fn turn(&mut self, gap: &Gap, _: &KnownFaces) -> FanTurn {
        self.model.turn(&mut self.port, gap, 0)
    }

    fn known(&mut self, gap: &Gap, count: u32) -> u32 {
        self.model.known(&mut self.port, gap.root, count, 0)
    }

    #[inline]
    fn has_more(&mut self, root: u32) -> bool {
        let has_more = self.more.as_slice().first() == Some(&root);
        if has_more {
            self.more.next();
        }
        has_more
    }

    fn corner(&mut self, root: u32, _: usize, count: u32) -> Option<u32> {
        self.model.corner(&mut self.port, root, count, None)
    }

    #[inline]
    fn face(&mut self, face: [u32; 3]) {
        self.faces.push(face);
    }

    #[inline]
    fn check(&self) -> Result<(), DecodeError> {
        self.port.check()
    }

    fn error(&self, kind: DecodeErrorKind) -> DecodeError {
        self.port.error(kind)
    }
}
