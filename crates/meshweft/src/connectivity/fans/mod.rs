//! Faces as fans: what the library writes.
//!
//! Vertices get numbers as they are met, and are the *root* in that order, as in the paper. At each root its
//! faces are written that have no smaller vertex. The faces that are known there make a path of neighbours, open at a
//! gap; from its end faces go on, each with a *new* vertex, until one closes the gap: this is one symbol,
//! and nearly all that is written. Otherwise the gap meets the front: a *turn* says where, by steps along the front
//! or by the number of the vertex. Faces that follow no others begin fans of their own, so any set of
//! triangles can be written, whatever its edges and directions.
//!
//! `traversal` is what both sides do; `encoder` says what comes, `decoder` is told; `known_faces` has the paths;
//! `model` says how likely each symbol is.

mod at_root;
mod decoder;
mod encoder;
mod known_faces;
mod model;
#[cfg(test)]
mod tests;
mod traversal;

use crate::bits::{DecodeError, DecodeErrorKind, RansDecoder, varint};
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};
use decoder::FanDecoder;
use encoder::FanEncoder;
use traversal::Traversal;

/// Faces as bytes, and the orders in which vertices and faces come back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FanCode {
    bytes: Vec<u8>,
    vertices: VertexOrder,
    faces: FaceOrder,
}

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
        let (face_count, vertex_count) = (faces.len(), faces.vertex_count());
        assert!(
            vertex_count == 0 || (first_vertex as usize) < vertex_count,
            "no vertex {first_vertex}"
        );

        // Faces with a repeated corner apart.
        let is_flat = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
        let numbered = || (0_u32..).zip(faces.as_slice());
        let (flat, proper): (Vec<_>, Vec<_>) = numbered().partition(|(_, face)| is_flat(face));
        let proper_faces: Vec<[u32; 3]> = proper.iter().map(|&(_, face)| *face).collect();
        let encoder = FanEncoder::new(Faces::of_checked(&proper_faces, vertex_count), first_vertex);
        let mut traversal = Traversal::new(encoder, proper.len(), vertex_count);
        traversal.go().expect("the faces are there");
        let FanEncoder {
            mut old,
            more,
            drawn,
            mut rotations,
            port,
            ..
        } = traversal.fans;

        // The numbers of the other vertices.
        let mut new = vec![u32::MAX; vertex_count];
        for (number, &vertex) in (0..).zip(&old) {
            new[vertex as usize] = number;
        }
        for vertex in 0..index32(vertex_count) {
            if new[vertex as usize] == u32::MAX {
                new[vertex as usize] = index32(old.len());
                old.push(vertex);
            }
        }
        let mut flat: Vec<([u32; 3], u32)> = flat
            .into_iter()
            .map(|(number, face)| (face.map(|vertex| new[vertex as usize]), number))
            .collect();
        flat.sort_unstable();

        // The bytes.
        let mut bytes = Vec::new();
        varint::write(&mut bytes, more.len() as u64);
        let mut last = 0;
        for root in more {
            varint::write(&mut bytes, u64::from(root - last));
            last = root;
        }
        varint::write(&mut bytes, flat.len() as u64);
        for vertex in flat.iter().flat_map(|(face, _)| face) {
            varint::write(&mut bytes, u64::from(*vertex));
        }
        bytes.extend(port.finish());

        // The orders.
        let proper_order = drawn.iter().map(|&place| proper[place as usize].0);
        let order = proper_order.chain(flat.iter().map(|&(_, number)| number));
        let order = Permutation::from_algorithm(order.collect());
        rotations.resize(face_count, 0);
        Self {
            bytes,
            vertices: Permutation::from_algorithm(old).into(),
            faces: FaceOrder::new(order, rotations).expect("a rotation for each face"),
        }
    }

    /// What is written.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The vertices in the order of their numbers.
    #[must_use]
    pub fn vertices(&self) -> &VertexOrder {
        &self.vertices
    }

    /// The faces in the order in which they come back.
    #[must_use]
    pub fn faces(&self) -> &FaceOrder {
        &self.faces
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
        // What stands apart.
        let mut rest = bytes;
        let said = face_count;
        let error = |rest: &[u8], kind| DecodeError {
            byte: bytes.len() - rest.len(),
            kind,
        };
        let number = |rest: &mut &[u8]| {
            let found = varint::read(rest);
            found.ok_or_else(|| error(rest, DecodeErrorKind::EndsEarly))
        };
        let count_of = |rest: &mut &[u8], what, most: usize| {
            let count = number(rest)?;
            let is_possible = count <= most as u64 && count <= rest.len() as u64;
            let too_many = DecodeErrorKind::TooMany { what, said };
            is_possible
                .then_some(count)
                .ok_or_else(|| error(rest, too_many))
        };
        let mut more = Vec::new();
        let mut last = 0_u64;
        for _ in 0..count_of(&mut rest, "fans", face_count)? {
            last = last.saturating_add(number(&mut rest)?);
            more.push(u32::try_from(last).unwrap_or(u32::MAX));
        }
        let mut flat = Vec::new();
        for _ in 0..count_of(&mut rest, "faces", face_count)? {
            let mut face = [0; 3];
            for corner in &mut face {
                let vertex = u32::try_from(number(&mut rest)?).unwrap_or(u32::MAX);
                if vertex as usize >= vertex_count {
                    return Err(error(rest, DecodeErrorKind::NoSuchVertex { vertex }));
                }
                *corner = vertex;
            }
            flat.push(face);
        }

        // Fans.
        let begins = bytes.len() - rest.len();
        let at = |mut error: DecodeError| {
            error.byte += begins;
            error
        };
        let decoder = FanDecoder::new(more, RansDecoder::new(rest));
        let mut traversal = Traversal::new(decoder, face_count - flat.len(), vertex_count);
        traversal.go().map_err(at)?;
        let FanDecoder {
            mut faces, port, ..
        } = traversal.fans;
        port.finish().map_err(at)?;
        faces.append(&mut flat);
        Ok(faces)
    }
}
