//! Other people's analyzers and orders.
//!
//! All rely on indices in range, which a [`Mesh`] vouches for.

use meshopt::ffi;
use meshweft::Mesh;
use meshweft::cache::BatchModel;

/// In units of a mesh's extent: no error is above.
const ANY_ERROR: f32 = 1e10;

/// How many vertices meshoptimizer's analyzer counts as transformed.
#[must_use]
pub fn vertices_transformed(mesh: &Mesh, model: BatchModel) -> u64 {
    // SAFETY: the faces of a mesh are consecutive indices below its vertex count, and the sizes
    // are those that the function asks for: no model has others.
    let statistics = unsafe {
        ffi::meshopt_analyzeVertexCache(
            mesh.faces().as_ptr().cast(),
            mesh.face_count() * 3,
            mesh.vertex_count(),
            model.cache_size(),
            model.batch_vertices(),
            model.batch_faces(),
        )
    };
    u64::from(statistics.vertices_transformed)
}

/// How many bytes of vertex records meshoptimizer's analyzer counts as fetched.
///
/// # Panics
/// If `vertex_size` is not from 1 to 256.
#[must_use]
pub fn bytes_fetched(mesh: &Mesh, vertex_size: usize) -> u64 {
    assert!((1..=256).contains(&vertex_size));
    // SAFETY: the faces of a mesh are consecutive indices below its vertex count, and the record
    // size is in the range that the function asks for.
    let statistics = unsafe {
        ffi::meshopt_analyzeVertexFetch(
            mesh.faces().as_ptr().cast(),
            mesh.face_count() * 3,
            mesh.vertex_count(),
            vertex_size,
        )
    };
    u64::from(statistics.bytes_fetched)
}

/// An order by meshoptimizer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meshopt {
    /// Its main optimizer, which does not ask for the cache's size.
    VertexCache,
    /// The one that favours strips.
    Strip,
    /// Tipsify for a FIFO cache of this size.
    Fifo(u32),
}

impl Meshopt {
    /// The faces in its order.
    ///
    /// # Panics
    /// If the cache has less than three entries.
    #[must_use]
    pub fn ordered(self, mesh: &Mesh) -> Vec<[u32; 3]> {
        let (index_count, vertex_count) = (mesh.face_count() * 3, mesh.vertex_count());
        let mut ordered = vec![[0_u32; 3]; mesh.face_count()];
        let (to, from) = (ordered.as_mut_ptr().cast(), mesh.faces().as_ptr().cast());
        // SAFETY: `from` points to `index_count` indices, which are below `vertex_count` in every
        // mesh, `to` to room for as many, and the two do not overlap.
        unsafe {
            match self {
                Self::VertexCache => {
                    ffi::meshopt_optimizeVertexCache(to, from, index_count, vertex_count);
                }
                Self::Strip => {
                    ffi::meshopt_optimizeVertexCacheStrip(to, from, index_count, vertex_count);
                }
                Self::Fifo(size) => {
                    assert!(size >= 3, "a face needs three entries");
                    ffi::meshopt_optimizeVertexCacheFifo(to, from, index_count, vertex_count, size);
                }
            }
        }
        ordered
    }
}

/// The faces that meshoptimizer's `simplify` leaves when asked for this many, at its defaults and with any
/// error allowed. It may stop at more of them.
///
/// # Panics
/// If the mesh has no positions.
#[must_use]
pub fn simplified(mesh: &Mesh, face_count: usize) -> Vec<[u32; 3]> {
    simplify(mesh, face_count.min(mesh.face_count()), ANY_ERROR)
}

/// The faces that meshoptimizer's `simplify` leaves when asked for as few as this error allows, in parts of the mesh's extent.
///
/// # Panics
/// If the mesh has no positions.
#[must_use]
pub fn simplified_within(mesh: &Mesh, error: f32) -> Vec<[u32; 3]> {
    simplify(mesh, 0, error)
}

fn simplify(mesh: &Mesh, face_count: usize, error: f32) -> Vec<[u32; 3]> {
    assert_eq!(mesh.positions().len(), mesh.vertex_count(), "no positions");
    let mut faces = vec![[0_u32; 3]; mesh.face_count()];
    // SAFETY: the first pointer is to room for as many indices as there are, the second to these
    // indices, which are below the number of vertices in every mesh, the third to as many positions,
    // 12 bytes each; the result is not asked for its error.
    let index_count = unsafe {
        ffi::meshopt_simplify(
            faces.as_mut_ptr().cast(),
            mesh.faces().as_ptr().cast(),
            mesh.face_count() * 3,
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
            face_count * 3,
            error,
            0,
            std::ptr::null_mut(),
        )
    };
    faces.truncate(index_count / 3);
    faces
}

/// The faces that meshoptimizer's `simplifyWithAttributes` leaves when asked for this many, with any error
/// allowed; `prunes` lets parts of the mesh leave as a whole. It may stop at more faces. `weights` has what a
/// difference of 1 in each of the `N` attributes of a vertex counts.
///
/// # Panics
/// If the mesh has no positions, or another number of vertices has attributes.
#[must_use]
pub fn simplified_with_attributes<const N: usize>(
    mesh: &Mesh,
    attributes: &[[f32; N]],
    weights: &[f32; N],
    face_count: usize,
    prunes: bool,
) -> Vec<[u32; 3]> {
    const { assert!(N <= 32) };
    let options = match prunes {
        true => meshopt::SimplifyOptions::Prune,
        false => meshopt::SimplifyOptions::None,
    };
    assert_eq!(mesh.positions().len(), mesh.vertex_count(), "no positions");
    assert_eq!(attributes.len(), mesh.vertex_count(), "a row a vertex");
    let mut faces = vec![[0_u32; 3]; mesh.face_count()];
    // SAFETY: the first pointer is to room for as many indices as there are, the second to these
    // indices, which are below the number of vertices in every mesh, then as many positions, 12 bytes each,
    // and as many rows of N attributes; there are N weights, at most 32, no locks, and the result is not asked
    // for its error.
    let index_count = unsafe {
        ffi::meshopt_simplifyWithAttributes(
            faces.as_mut_ptr().cast(),
            mesh.faces().as_ptr().cast(),
            mesh.face_count() * 3,
            mesh.positions().as_ptr().cast(),
            mesh.vertex_count(),
            size_of::<[f32; 3]>(),
            attributes.as_ptr().cast(),
            size_of::<[f32; N]>(),
            weights.as_ptr(),
            N,
            std::ptr::null(),
            face_count.min(mesh.face_count()) * 3,
            ANY_ERROR,
            options.bits(),
            std::ptr::null_mut(),
        )
    };
    faces.truncate(index_count / 3);
    faces
}

/// The faces in the order of Tom Forsyth's *Linear-Speed Vertex Cache Optimisation* (2006), by the
/// `forsyth` crate at its defaults.
///
/// # Panics
/// If the crate refuses the faces.
#[must_use]
pub fn forsyth(faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    if faces.is_empty() {
        return Vec::new();
    }
    let ordered = forsyth::order_triangles(faces.as_flattened()).expect("faces in range");
    ordered
        .chunks_exact(3)
        .map(|c| [c[0], c[1], c[2]])
        .collect()
}

/// A meshlet: its vertices by their numbers in the mesh, and its faces by the places of their vertices in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RivalMeshlet {
    /// The vertices.
    pub vertices: Vec<u32>,
    /// The faces.
    pub faces: Vec<[u8; 3]>,
}

/// Meshoptimizer's meshlets of a mesh, each after its own pass inside.
///
/// # Panics
/// If the mesh has no positions, or a limit is one that meshoptimizer refuses.
#[must_use]
pub fn meshlets(
    mesh: &Mesh,
    vertex_limit: usize,
    face_limit: usize,
    cone_weight: f32,
) -> Vec<RivalMeshlet> {
    assert!((3..=256).contains(&vertex_limit) && (1..=512).contains(&face_limit));
    let vertices = vertex_data(mesh);
    let indices = mesh.faces().as_flattened();
    let made = meshopt::build_meshlets(indices, &vertices, vertex_limit, face_limit, cone_weight);
    let meshlet = |meshlet: meshopt::Meshlet<'_>| RivalMeshlet {
        vertices: meshlet.vertices.to_vec(),
        faces: meshlet.triangles.as_chunks().0.to_vec(),
    };
    made.iter().map(meshlet).collect()
}

/// Meshoptimizer's cone of a meshlet: apex, axis, cutoff.
///
/// # Panics
/// If the mesh has no positions.
#[must_use]
pub fn cone(mesh: &Mesh, meshlet: &RivalMeshlet) -> ([f32; 3], [f32; 3], f32) {
    let view = meshopt::Meshlet {
        vertices: &meshlet.vertices,
        triangles: meshlet.faces.as_flattened(),
    };
    let bounds = meshopt::compute_meshlet_bounds(view, &vertex_data(mesh));
    (bounds.cone_apex, bounds.cone_axis, bounds.cone_cutoff)
}

fn vertex_data(mesh: &Mesh) -> meshopt::VertexDataAdapter<'_> {
    assert_eq!(mesh.positions().len(), mesh.vertex_count(), "no positions");
    let bytes = meshopt::typed_to_bytes(mesh.positions());
    let adapter = meshopt::VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0);
    adapter.expect("positions of 12 bytes each")
}
