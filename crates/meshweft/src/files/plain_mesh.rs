//! A new mesh for the formats that are made of positions and faces alone: OBJ, OFF, STL.

use super::error::FileErrorKind;
use super::format::Format;
use super::new_mesh::{NewMesh, NewVertices, PolygonCorners, nothing_to_share, vertex_count};
use crate::attribute::{AttributeInfo, Domain, Semantic, Values};
use crate::faces::Faces;

/// The positions and faces of a new mesh, all indices in range.
pub(super) struct PlainMesh<'a> {
    pub(super) positions: &'a [[f32; 3]],
    pub(super) faces: &'a [[u32; 3]],
    pub(super) polygons: PolygonCorners<'a>,
}

impl<'a> PlainMesh<'a> {
    /// What a file of this format stores of the mesh: all there is of it.
    ///
    /// # Errors
    /// The mesh shares vertices, faces name vertices that are not there, something else is stored with it, or
    /// the positions are not floats of 32 bits.
    pub(super) fn new(mesh: &NewMesh<'a>, format: Format) -> Result<Self, FileErrorKind> {
        let (faces, polygons) = (mesh.faces, mesh.checked_polygons()?);
        let attributes = match mesh.vertices {
            NewVertices::Shared(mesh) => return Err(nothing_to_share(mesh)),
            NewVertices::Stored(attributes) => attributes,
            NewVertices::Positions(positions) => {
                Faces::new(faces, positions.len()).map_err(FileErrorKind::Order)?;
                return Ok(Self {
                    positions,
                    faces,
                    polygons,
                });
            }
        };

        // Of each semantic there is one attribute, and one is the position.
        vertex_count(attributes, faces)?;
        let is_other = |info: &AttributeInfo| {
            info.semantic != Semantic::Position
                || info.morph_target.is_some()
                || info.domain != Domain::Vertex
        };
        if let Some(other) = attributes.iter().find(|other| is_other(&other.info)) {
            let text = format!(
                "{format} files are made of positions and faces alone: leave {} out, or create a .glb or a \
                 .ply",
                other.info.semantic
            );
            return Err(FileErrorKind::unsupported(text));
        }
        match attributes.first().map(|position| &position.values) {
            Some(Values::F32(values)) => Ok(Self {
                positions: values.as_chunks().0,
                faces,
                polygons,
            }),
            _ => Err(FileErrorKind::unsupported(
                "POSITION has 64-bit floats: convert them to 32-bit floats, or create a .ply",
            )),
        }
    }

    /// Refuses positions that a text format has no numbers for.
    ///
    /// # Errors
    /// One is not finite.
    pub(super) fn check_finite(&self, format: Format) -> Result<(), FileErrorKind> {
        let is_finite = |position: &[f32; 3]| position.iter().all(|x| x.is_finite());
        match self.positions.iter().position(|p| !is_finite(p)) {
            None => Ok(()),
            Some(vertex) => Err(FileErrorKind::unsupported(format!(
                "POSITION of vertex {vertex} is not finite, which {format} files have no number for: repair \
                 it, or create a .ply, which keeps it"
            ))),
        }
    }
}
