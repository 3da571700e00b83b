//! Reads fans as faces.

use super::known_faces::KnownFaces;
use super::model::Model;
use super::traversal::{FanTurn, Fans, Gap, Run};
use super::vertex_coder::VertexCoder;
use crate::bits::{DecodeError, DecodeErrorKind, RansDecoder};

/// The faces so far.
#[derive(Debug)]
pub(super) struct FanDecoder<V> {
    /// The roots that have faces which follow no others, rising, and how many of them are done.
    pub(super) more: Vec<u32>,
    pub(super) passed: usize,
    pub(super) faces: Vec<[u32; 3]>,
    model: Model,
    pub(super) at_vertices: V,
    pub(super) port: RansDecoder,
}

impl<V: VertexCoder> FanDecoder<V> {
    pub(super) fn new(at_vertices: V) -> Self {
        Self {
            more: Vec::new(),
            passed: 0,
            faces: Vec::new(),
            model: Model::new(),
            at_vertices,
            port: RansDecoder::new(1 + V::LANES),
        }
    }
}

impl<V: VertexCoder> Fans for FanDecoder<V> {
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
        let has_more = self.more.get(self.passed) == Some(&root);
        self.passed += usize::from(has_more);
        has_more
    }

    fn corner(&mut self, root: u32, _: usize, count: u32) -> Option<u32> {
        self.model.corner(&mut self.port, root, count, None)
    }

    #[inline]
    fn vertex(&mut self, vertex: u32, near: [u32; 3]) {
        self.at_vertices.code(&mut self.port, vertex, near);
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
