//! A document as one mesh with all its levels of detail.

use super::options::LodError;
use crate::files::Document;
use crate::geometry::Ball;
use crate::geometry::double::widened;
use crate::index::index32;
use crate::lod::fast_mesh::{FastMesh, VertexHierarchy};
use crate::mesh::Mesh;
use crate::operations::plain_meshes::plain_meshes;

/// What is walked around.
pub(super) struct Loaded {
    pub(super) hierarchy: VertexHierarchy,
    /// The smallest that has all vertices of the hierarchy in it.
    pub(super) ball: Ball,
    /// How many faces there are at full detail.
    pub(super) face_count: usize,
}

/// Joins the meshes of a document, and makes the hierarchy of all. Positions and faces count, as the file stores them.
pub(super) fn load(document: &Document) -> Result<Loaded, LodError> {
    let file = || document.path().to_owned();
    let mesh = joined(document)?;
    let hierarchy = FastMesh::default().build(&mesh, &[]);
    let hierarchy = hierarchy.map_err(|error| LodError::Mesh {
        file: file(),
        error,
    })?;

    let used = hierarchy.source_vertices().iter();
    let used = used.map(|&vertex| widened(mesh.positions()[vertex as usize]));
    let face_count = mesh.face_count() - hierarchy.flat_faces().len();
    match Ball::around(used) {
        Some(ball) if face_count > 0 => Ok(Loaded {
            hierarchy,
            ball,
            face_count,
        }),
        _ => Err(no_faces(document)),
    }
}

/// That there is nothing to draw.
pub(super) fn no_faces(document: &Document) -> LodError {
    let file = document.path().to_owned();
    LodError::NoFaces { file }
}

/// All meshes as one, the vertices of each after those of the one before.
pub(super) fn joined(document: &Document) -> Result<Mesh, LodError> {
    let file = || document.path().to_owned();
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for (name, mesh) in plain_meshes(document)? {
        if mesh.face_count() == 0 {
            continue;
        }
        if mesh.positions().len() != mesh.vertex_count() {
            return Err(LodError::NoPositions {
                file: file(),
                mesh: name,
            });
        }
        let is_finite = |&vertex: &u32| {
            let position = mesh.positions()[vertex as usize];
            position.iter().all(|x| x.is_finite())
        };
        let mut corners = mesh.faces().as_flattened().iter();
        if !corners.all(is_finite) {
            return Err(LodError::NotFinite {
                file: file(),
                mesh: name,
            });
        }

        // What does not fit is refused by `Mesh::new`, which sees all positions.
        let first = index32(positions.len().min(u32::MAX as usize));
        let moved = |face: &[u32; 3]| face.map(|vertex| vertex.saturating_add(first));
        faces.extend(mesh.faces().iter().map(moved));
        positions.extend_from_slice(mesh.positions());
    }
    Mesh::new(positions, faces).map_err(|error| LodError::Mesh {
        file: file(),
        error,
    })
}
