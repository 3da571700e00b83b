//! What facets store: positions, a normal, and in binary files two bytes of anything.

use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::files::error::Problem;
use crate::files::rewrite::{PlacedFace, StoredMesh};

pub(super) fn position() -> AttributeInfo {
    AttributeInfo::new(Semantic::Position, Domain::Vertex, 3, ComponentType::F32)
}

pub(super) fn normal() -> AttributeInfo {
    AttributeInfo::new(Semantic::Normal, Domain::Face, 3, ComponentType::F32)
}

/// The two bytes that the format calls the attribute of a facet.
pub(super) fn attribute_bytes() -> AttributeInfo {
    let name = Semantic::Other("attribute".to_owned());
    AttributeInfo::new(name, Domain::Face, 1, ComponentType::U16)
}

/// The position of each vertex, from the corners that stand there.
pub(super) fn positions(
    stored: &StoredMesh<'_>,
    mut of_facet: impl FnMut(&PlacedFace) -> Result<[[f32; 3]; 3], Problem>,
) -> Result<Vec<f32>, Problem> {
    let mesh = &stored.entry.mesh;
    // Each vertex is a corner of some facet, as vertices are made of corners.
    let mut positions = vec![[0.0; 3]; mesh.vertex_count()];
    for (facet, face) in stored.faces().zip(mesh.faces()) {
        let corners = of_facet(&facet)?;
        for (corner, &vertex) in face.iter().enumerate() {
            positions[vertex as usize] = corners[(corner + facet.rotation) % 3];
        }
    }
    Ok(positions.into_flattened())
}
