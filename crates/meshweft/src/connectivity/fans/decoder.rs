//! Reads fans as faces.

use super::fan_model::FanModel;
use super::known_faces::KnownFaces;
use super::traversal::{FanTurn, Fans, Gap, Run};
use super::vertex_coder::{VertexCoder, beyond, outlook};
use crate::bits::{DecodeError, DecodeErrorKind, RansDecoder};

/// The faces so far.
#[derive(Debug)]
pub(super) struct FanDecoder<V: VertexCoder> {
    /// The roots that have faces which follow no others, rising, and how many of them are done.
    pub(super) more: Vec<u32>,
    pub(super) passed: usize,
    pub(super) faces: Vec<[u32; 3]>,
    model: V::Model,
    pub(super) at_vertices: V,
    pub(super) port: RansDecoder,
}

impl<V: VertexCoder> FanDecoder<V> {
    pub(super) fn new(at_vertices: V) -> Self {
        Self {
            more: Vec::new(),
            passed: 0,
            faces: Vec::new(),
            model: V::Model::new(),
            at_vertices,
            port: RansDecoder::new(1 + V::LANES),
        }
    }
}

impl<V: VertexCoder> FanDecoder<V> {
    pub(super) fn settle(&mut self) {
        self.at_vertices.settle(&mut self.port);
    }
}

impl<V: VertexCoder> Fans for FanDecoder<V> {
    fn begin_part(&mut self) {}

    fn begin_root(&mut self, _: u32) {}

    #[inline]
    fn run(&mut self, gap: &Gap, known: &KnownFaces) -> Run {
        let outlook = outlook(&self.at_vertices, gap, known);
        self.model.run(&mut self.port, gap, outlook, Run::ONE)
    }

    #[inline]
    fn turn(&mut self, gap: &Gap, known: &KnownFaces) -> FanTurn {
        let beyond = beyond(&self.at_vertices, gap, known);
        self.model.turn(&mut self.port, gap, beyond, 0)
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
