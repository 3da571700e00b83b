//! Faces as fans: what the library writes.
//!
//! Vertices get numbers as they are met, and are the *root* in that order, as in the paper. At each root its
//! faces are written that have no smaller vertex. The faces that are known there make a path of neighbours, open at a
//! gap; from its end faces go on, each with a *new* vertex, until one closes the gap: this is one symbol,
//! and nearly all that is written. Otherwise the gap meets the front: a *turn* says where, by steps along the front
//! or by the number of the vertex. Faces that follow no others begin fans of their own, so any set of
//! triangles can be written, whatever its edges and directions. Only those that name a vertex twice come after all others,
//! each as a difference to the one before (`flat_faces`).
//!
//! `traversal` is what both sides do; `encoder` says what comes, `decoder` is told; `known_faces` has the paths;
//! `model` says how likely each symbol is.

mod at_root;
mod blocks;
mod decoder;
mod encoder;
mod fan_model;
mod flat_faces;
mod known_faces;
mod lazy_tables;
#[cfg(feature = "default-tier")]
mod mixed_model;
mod model;
#[cfg(test)]
mod tests;
mod traversal;
mod vertex_coder;

use crate::bits::{DecodeError, DecodeErrorKind};
use crate::faces::Faces;
use crate::permutation::{FaceOrder, VertexOrder};
pub(crate) use blocks::{BlockReader, BlockSize, Blocks};
pub(crate) use fan_model::{FanModel, Outlook};
#[cfg(feature = "default-tier")]
pub(crate) use mixed_model::MixedModel;
pub(crate) use model::TableModel;
pub(crate) use vertex_coder::VertexCoder;

/// Faces as bytes, and the orders in which vertices and faces come back.
#[derive(Debug, Clone, PartialEq)]
pub struct FanCode(Blocks);

impl FanCode {
    /// The code of any faces; the traversal begins with a vertex, if it has faces.
    ///
    /// Faces that name a vertex twice are written after the others, and vertices that no other face names get the
    /// last numbers. A mesh that was decoded gives the same bytes again if it begins with vertex 0.
    ///
    /// # Panics
    /// If there are vertices, and `first_vertex` is not one of them.
    ///
    /// # Complexity
    /// Time O(vertices + faces log valence); space about 60 bytes a face.
    ///
    /// ```
    /// use meshweft::connectivity::FanCode;
    /// // A fan of six faces around vertex 3.
    /// let ring = [0, 1, 2, 4, 5, 6];
    /// let faces: Vec<[u32; 3]> = (0..6).map(|i| [3, ring[i], ring[(i + 1) % 6]]).collect();
    /// let code = FanCode::new(&faces, 0);
    /// let decoded = FanCode::decode(code.bytes(), 6, 7)?;
    /// assert_eq!(decoded, code.vertices().renumber(&code.faces().apply(&faces)));
    /// # Ok::<(), meshweft::bits::DecodeError>(())
    /// ```
    #[must_use]
    pub fn new<'a>(faces: impl Into<Faces<'a>>, first_vertex: u32) -> Self {
        let faces = faces.into();
        assert!(
            faces.vertex_count() == 0 || (first_vertex as usize) < faces.vertex_count(),
            "no vertex {first_vertex}"
        );
        Self(Blocks::write(faces, first_vertex, BlockSize::WHOLE, ()))
    }

    /// What is written.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.0.bytes
    }

    /// The vertices in the order of their numbers.
    #[must_use]
    pub fn vertices(&self) -> &VertexOrder {
        &self.0.vertices
    }

    /// The faces in the order in which they come back.
    #[must_use]
    pub fn faces(&self) -> &FaceOrder {
        &self.0.faces
    }

    /// The faces. How many there are, and how many vertices, is not part of the bytes.
    ///
    /// # Errors
    /// The bytes end early, are damaged or have other counts. Every vertex of every face is below the number
    /// of vertices.
    ///
    /// # Complexity
    /// Time and space O(faces + vertices), which the caller should limit: a regular mesh takes less than a
    /// bit for a thousand faces.
    pub fn decode(
        bytes: &[u8],
        face_count: usize,
        vertex_count: usize,
    ) -> Result<Vec<[u32; 3]>, DecodeError> {
        let mut reader = BlockReader::new(face_count, vertex_count, BlockSize::WHOLE, ());
        let mut at = 0;
        while !reader.is_complete() {
            let read = reader.read_piece(&bytes[at..]);
            let read = read.map_err(|error| DecodeError {
                byte: at + error.byte,
                ..error
            })?;
            at += read.ok_or(DecodeError {
                byte: bytes.len(),
                kind: DecodeErrorKind::EndsEarly,
            })?;
        }
        match at == bytes.len() {
            true => Ok(std::mem::take(reader.faces())),
            false => Err(DecodeError::damaged(at)),
        }
    }
}
