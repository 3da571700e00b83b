//! What is stored with the vertices of a hierarchy besides their places: attached to it, and read from it.

use super::hierarchy::VertexHierarchy;
use super::rows::{VertexRows, is_of_rows, size_of};
use crate::attribute::{Attribute, AttributeInfo, Values};
use crate::error::MeshError;

impl VertexHierarchy {
    /// The same hierarchy with what is stored with its vertices: `attributes` are of the mesh that it was built of. Those of corners and
    /// of faces, and the positions, are not looked at. Each vertex keeps every bit of the one of the input that
    /// [it stands for](Self::source_vertices). Give [`FastMesh::build`](super::FastMesh::build) the same attributes, so that vertices
    /// that differ in one stay apart.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if there are fewer elements than the mesh has vertices.
    ///
    /// # Complexity
    /// Time and space O(bytes of the attributes).
    pub fn with_attributes(self, attributes: &[Attribute]) -> Result<Self, MeshError> {
        let kept = attributes.iter().filter(|it| is_of_rows(&it.info));
        let kept: Vec<&Attribute> = kept.collect();
        let needed = self.source_vertices.iter().max();
        let needed = needed.map_or(0, |&last| last as usize + 1);
        if let Some(short) = kept.iter().find(|it| it.len() < needed) {
            return Err(MeshError::LengthMismatch {
                what: "attribute of vertices",
                expected: needed,
                found: short.len(),
            });
        }

        let layouts = kept.iter().map(|it| it.info.clone()).collect();
        let mut rows = VertexRows::zeros(layouts, self.vertex_count());
        let mut start = 0;
        for attribute in kept {
            let size = size_of(&attribute.info);
            let bytes = attribute.values.to_le_bytes();
            for (vertex, &source) in (0..).zip(&self.source_vertices) {
                let element = &bytes[source as usize * size..][..size];
                rows.row_mut(vertex)[start..][..size].copy_from_slice(element);
            }
            start += size;
        }
        Ok(Self { rows, ..self })
    }

    /// What is stored with the vertices, besides their positions.
    #[must_use]
    pub fn attributes(&self) -> &[AttributeInfo] {
        &self.rows.layouts
    }

    /// What is stored with some vertices: the values of the attribute of this number, in the order of `vertices`. Those of vertices that
    /// were not read yet are 0.
    ///
    /// # Panics
    /// If there is no such attribute, or no such vertex.
    ///
    /// # Complexity
    /// Time and space O(vertices given).
    #[must_use]
    pub fn attribute(&self, number: usize, vertices: &[u32]) -> Attribute {
        let info = self.rows.layouts[number].clone();
        let start: usize = self.rows.layouts[..number].iter().map(size_of).sum();
        let size = size_of(&info);
        let mut bytes = Vec::with_capacity(vertices.len() * size);
        for &vertex in vertices {
            bytes.extend_from_slice(&self.rows.row(vertex)[start..][..size]);
        }
        let values = Values::from_le_bytes(info.component_type, &bytes);
        Attribute::new(info, values)
    }

    /// The same hierarchy with a name, that of its mesh.
    #[must_use]
    pub fn with_name(self, name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..self
        }
    }

    /// What its mesh is called; empty if it has no name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }
}
