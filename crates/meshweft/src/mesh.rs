//! A triangle mesh, checked once.

use crate::error::MeshError;
use crate::faces::Faces;
#[cfg(feature = "files")]
use crate::permutation::renumber;
use crate::permutation::{FaceOrder, VertexOrder};

/// Vertices and faces whose indices are in range.
///
/// Every input whose indices are in range is valid: isolated vertices, faces that name a vertex
/// twice, repeated faces, non-manifold edges and vertices, any orientation, no faces at all.
///
/// ```
/// use meshweft::Mesh;
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::new(&positions, &[[0, 1, 2]])?;
/// assert_eq!((mesh.vertex_count(), mesh.face_count()), (3, 1));
/// assert_eq!(
///     Mesh::new(&positions, &[[0, 1, 3]]).unwrap_err().to_string(),
///     "face 0, corner 2: index 3 is past the last vertex (2)"
/// );
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// One entry a vertex, or empty if only the connectivity is known.
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    vertex_count: usize,
}

impl Mesh {
    /// A mesh of these vertex positions and faces.
    ///
    /// # Errors
    /// [`MeshError::IndexOutOfRange`] for the first index that names no vertex,
    /// [`MeshError::TooLarge`] beyond 2³² − 1 vertices or (2³² − 1) / 3 faces.
    ///
    /// # Complexity
    /// Time O(faces); no memory beyond the two arrays.
    pub fn new(
        positions: impl Into<Vec<[f32; 3]>>,
        faces: impl Into<Vec<[u32; 3]>>,
    ) -> Result<Self, MeshError> {
        let positions = positions.into();
        let vertex_count = positions.len();
        Self::checked(positions, vertex_count, faces.into())
    }

    /// A mesh without positions, which is enough to order it for a vertex cache.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn connectivity_only(
        vertex_count: usize,
        faces: impl Into<Vec<[u32; 3]>>,
    ) -> Result<Self, MeshError> {
        Self::checked(Vec::new(), vertex_count, faces.into())
    }

    fn checked(
        positions: Vec<[f32; 3]>,
        vertex_count: usize,
        faces: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        Faces::new(&faces, vertex_count)?;
        Ok(Self {
            positions,
            faces,
            vertex_count,
        })
    }

    /// The position of each vertex; empty if the mesh was made without positions.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The three vertices of each face.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The faces and the vertex count, in the form that orders, metrics and cuts take.
    #[must_use]
    pub fn as_faces(&self) -> Faces<'_> {
        Faces::of_checked(&self.faces, self.vertex_count)
    }

    /// How many vertices there are, used or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many faces there are.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The position at each corner of each face, widened: what is measured of a surface leaves out vertices that no face
    /// uses.
    ///
    /// # Panics
    /// When a position is asked for, if there are faces but no positions.
    pub(crate) fn corner_positions(&self) -> impl Iterator<Item = [f64; 3]> + Clone {
        let vertices = self.faces.as_flattened().iter();
        vertices.map(|&vertex| self.positions[vertex as usize].map(f64::from))
    }

    /// The same mesh with its faces drawn in another order.
    ///
    /// # Panics
    /// If the order has another number of faces.
    #[must_use]
    pub fn with_face_order(&self, order: &FaceOrder) -> Self {
        Self {
            positions: self.positions.clone(),
            faces: order.apply(&self.faces),
            vertex_count: self.vertex_count,
        }
    }

    /// As [`with_face_order`](Self::with_face_order), without a copy of the positions.
    #[cfg(feature = "files")]
    pub(crate) fn into_face_order(self, order: &FaceOrder) -> Self {
        Self {
            faces: order.apply(&self.faces),
            ..self
        }
    }

    /// As [`with_vertex_order`](Self::with_vertex_order), but renumbers the faces in place.
    #[cfg(feature = "files")]
    pub(crate) fn into_vertex_order(mut self, order: &VertexOrder) -> Self {
        if !self.positions.is_empty() {
            self.positions = order.permutation().apply(&self.positions);
        }
        order.renumber_in_place(&mut self.faces);
        self
    }

    /// The faces of a mesh without positions get the new numbers of their vertices.
    #[cfg(feature = "files")]
    pub(crate) fn renumber_faces(&mut self, old_to_new: &[u32]) {
        debug_assert!(self.positions.is_empty(), "positions would stay");
        renumber(&mut self.faces, old_to_new);
    }

    /// The same mesh with its vertices stored in another order and the faces renumbered to match.
    ///
    /// # Panics
    /// If the order has another number of vertices.
    #[must_use]
    pub fn with_vertex_order(&self, order: &VertexOrder) -> Self {
        assert_eq!(
            order.len(),
            self.vertex_count,
            "vertex order of another length"
        );
        Self {
            positions: match self.positions.is_empty() {
                true => Vec::new(),
                false => order.permutation().apply(&self.positions),
            },
            faces: order.renumber(&self.faces),
            vertex_count: self.vertex_count,
        }
    }
}

impl<'a> From<&'a Mesh> for Faces<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        mesh.as_faces()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::permutation::Permutation;

    #[test]
    fn no_vertices_and_no_faces_is_a_mesh() {
        let mesh = Mesh::connectivity_only(0, []).unwrap();
        assert_eq!(mesh.with_face_order(&FaceOrder::identity(0)), mesh);
        assert_eq!(mesh.with_vertex_order(&VertexOrder::identity(0)), mesh);
        assert_eq!(
            Mesh::connectivity_only(0, [[0, 0, 0]])
                .unwrap_err()
                .to_string(),
            "face 0, corner 0: index 0, but the mesh has no vertices"
        );
    }

    #[test]
    fn vertex_order_moves_positions_and_renumbers() {
        let positions = [[0.0; 3], [1.0; 3], [2.0; 3]];
        let mesh = Mesh::new(positions, [[0, 1, 2]]).unwrap();
        let order = VertexOrder::from(Permutation::new(vec![1, 2, 0]).unwrap());
        let moved = mesh.with_vertex_order(&order);
        assert_eq!(moved.positions(), [[1.0; 3], [2.0; 3], [0.0; 3]]);
        assert_eq!(moved.faces(), [[2, 0, 1]]);
    }
}
