//! A mesh that was stored, from all its bytes.

use super::mesh_code::MeshCode;
use super::mesh_decoder::MeshDecoder;
use super::polygons::PolygonOrder;
use super::source_order::SourceOrder;
use crate::bits::DecodeError;
use crate::limits::Limits;
use crate::mesh::Mesh;

/// A mesh in the order in which it is stored.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DecodedMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// Its polygons, unless all are triangles.
    pub polygons: Option<PolygonOrder>,
    /// What of the order of the source is stored.
    pub order: SourceOrder,
}

impl DecodedMesh {
    /// The mesh in the order of the source as far as that is stored, and where the faces of each polygon start in it, unless
    /// all are triangles.
    #[must_use]
    pub fn restore(self) -> (Mesh, Option<Vec<u32>>) {
        let Some(polygons) = self.polygons else {
            return (self.order.restore(self.mesh), None);
        };
        let polygons = match self.order.faces() {
            Some(order) => polygons.follow(order),
            None => polygons,
        };
        let mesh = self.mesh.with_face_order(polygons.faces());
        let mesh = match self.order.vertices() {
            Some(order) => mesh.with_vertex_order(order),
            None => mesh,
        };
        (mesh, Some(polygons.starts().to_vec()))
    }
}

impl MeshCode {
    /// The mesh, from all its bytes, in the order of the source as far as that is stored.
    ///
    /// # Errors
    /// As [`MeshDecoder::push`], or bytes are missing or left over.
    ///
    /// # Complexity
    /// Time and space O(vertices + faces), which the limits bound: a regular mesh takes less than a bit for a
    /// thousand faces.
    pub fn decode(bytes: &[u8], limits: Limits) -> Result<Mesh, DecodeError> {
        let stored = decode(bytes, MeshDecoder::new(limits))?;
        Ok(stored.order.restore(stored.mesh))
    }

    /// The mesh in the order of the stream, and what of its polygons and of the order of the source is stored.
    ///
    /// # Errors
    /// As [`decode`](Self::decode).
    pub fn decode_stored(bytes: &[u8], limits: Limits) -> Result<DecodedMesh, DecodeError> {
        decode(bytes, MeshDecoder::with_polygons(limits))
    }
}

/// The mesh from all its bytes.
fn decode(bytes: &[u8], mut decoder: MeshDecoder) -> Result<DecodedMesh, DecodeError> {
    let used = decoder.push(bytes)?;
    decoder.finish()?;
    if used < bytes.len() {
        return Err(DecodeError::damaged(used));
    }
    let (positions, faces) = (decoder.take_positions(), decoder.take_faces());
    let mesh = Mesh::new(positions, faces).map_err(|_| DecodeError::damaged(used))?;
    Ok(DecodedMesh {
        mesh,
        polygons: decoder.take_polygons(),
        order: decoder.take_source_order().unwrap_or_default(),
    })
}
