//! How meshlets are made.

/// How meshlets are made: grown by the vertex with which most faces come and most vertices are finished, the nearest of
/// them, and that with the most similar normals.
///
/// ```
/// use meshweft::Mesh;
/// use meshweft::culling::{Eye, Meshlets, Ranges};
/// // A roof, once around a ridge: left and right.
/// let positions = [[0.0, 1.0, 0.0], [0.0, 1.0, 9.0], [-9.0, 0.0, 0.0], [9.0, 0.0, 0.0]];
/// let mesh = Mesh::new(positions, [[0, 2, 1], [0, 1, 3]])?;
/// let meshlets = Meshlets { face_limit: 1, ..Meshlets::default() }.build(&mesh);
/// assert_eq!((meshlets.len(), meshlets.local_faces(1)), (2, &[[0, 1, 2]][..]));
/// // From the right and below the ridge, the left side is not seen.
/// let mut ranges = Ranges::default();
/// meshlets.visible_ranges(Eye::at([90.0, 0.5, 4.0]), &mut ranges);
/// assert_eq!(ranges.face_count(), 1);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meshlets {
    /// Most vertices, 3 to 256.
    pub vertex_limit: u32,
    /// Most faces, 1 to 512.
    pub face_limit: u32,
    /// How much similar normals count against a small extent, from 0 to 1. Larger ones let cones leave out more faces, and
    /// meshlets have more vertices together. Where ranges are drawn, 1 is best, with
    /// [`by_visibility`](super::MeshletMesh::by_visibility).
    pub cone_weight: f32,
}

impl Meshlets {
    /// Of up to 128 vertices and 256 faces: for shaders that compute or load much for a vertex and give few numbers to the
    /// next stage.
    pub const LARGE: Self = Self {
        vertex_limit: 128,
        face_limit: 256,
        cone_weight: 0.25,
    };
}

impl Default for Meshlets {
    /// Up to 64 vertices and 96 faces: a compact meshlet is full in both, as two warps.
    fn default() -> Self {
        Self {
            vertex_limit: 64,
            face_limit: 96,
            cone_weight: 0.25,
        }
    }
}
