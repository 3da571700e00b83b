//! From a mesh to its vertex hierarchy.

use super::hierarchy::VertexHierarchy;
use super::measured::Measure;
use super::numbering;
use super::replay::Replay;
use super::sorted::SortedMesh;
use crate::attribute::Attribute;
use crate::error::MeshError;
use crate::index::MAX_FACES;
use crate::mesh::Mesh;
use crate::progress::{PartOfWork, Progress};
use crate::progressive::{AttributeWeights, Collapses};

/// Makes vertex hierarchies.
///
/// ```
/// use meshweft::Mesh;
/// use meshweft::lod::Camera;
/// use meshweft::lod::fast_mesh::{FastMesh, Front};
/// // A flat square of 8 by 8 cells.
/// let positions: Vec<[f32; 3]> = (0..81).map(|i| [(i % 9) as f32, (i / 9) as f32, 0.0]).collect();
/// let cell = |i: u32| [[i, i + 1, i + 9], [i + 9, i + 1, i + 10]];
/// let faces: Vec<_> = (0..72).filter(|i| i % 9 != 8).flat_map(cell).collect();
/// let mesh = Mesh::new(positions, faces)?;
///
/// let mut front = Front::new(FastMesh::default().build(&mesh, &[])?);
/// let camera = Camera {
///     eye: [4.0, 4.0, 30.0],
///     target: [4.0, 4.0, 0.0],
///     up: [0.0, 1.0, 0.0],
///     field_of_view: 45.0,
///     size: [800, 600],
/// };
/// front.update(&camera.view(1.0)?, 1.0);
/// assert!(front.face_count() < 20); // Still the whole square.
/// front.refine_fully();
/// assert_eq!(front.face_count(), 128);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FastMesh {
    /// What differences in attributes count when it is decided which point leaves next.
    pub weights: AttributeWeights,
}

impl FastMesh {
    /// The hierarchy of a mesh; `attributes` are of its vertices (others are not looked at).
    ///
    /// Vertices that agree in position and every attribute, byte for byte (−0 is 0), count as one. Any mesh will do: points where the
    /// surface is not a manifold never leave, see [`VertexHierarchy::cut_points`].
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the mesh has faces and no positions, or an attribute of vertices
    /// has another number of elements; [`MeshError::TooLarge`] from 2²⁸ vertices on.
    ///
    /// # Complexity
    /// Time O(faces), sorting apart; space about 400 bytes a vertex.
    pub fn build(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
    ) -> Result<VertexHierarchy, MeshError> {
        self.build_with(mesh, attributes, &())
    }

    /// The same, and says how far it is. Where `progress` stops it, the hierarchy is one of fewer levels: more vertices are roots.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn build_with(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
        progress: &dyn Progress,
    ) -> Result<VertexHierarchy, MeshError> {
        let limit = 1 << 28;
        if mesh.vertex_count() >= limit {
            return Err(MeshError::TooLarge {
                what: "vertices",
                limit,
                count: mesh.vertex_count(),
            });
        }
        let Some(sorted) = SortedMesh::new(mesh, attributes) else {
            return self.hierarchy(mesh, attributes, progress);
        };
        let mut hierarchy = self.hierarchy(&sorted.mesh, &sorted.attributes, progress)?;
        for vertex in &mut hierarchy.source_vertices {
            *vertex = sorted.old_vertex(*vertex);
        }
        for face in &mut hierarchy.flat_faces {
            *face = sorted.old_face(*face);
        }
        hierarchy.flat_faces.sort_unstable();
        Ok(hierarchy)
    }

    /// The hierarchy of a mesh as it is given: fast if near vertices are near in memory.
    fn hierarchy(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
        progress: &dyn Progress,
    ) -> Result<VertexHierarchy, MeshError> {
        let collapses = Collapses {
            weights: self.weights,
            ..Collapses::default()
        };
        let (removals, point_of) =
            collapses.build_balanced(mesh, attributes, &PartOfWork::new(progress, 0.0, 0.5))?;
        let slots = mesh.face_count() + removals.last_level();
        if slots > MAX_FACES {
            return Err(MeshError::TooLarge {
                what: "faces and places for them",
                limit: MAX_FACES,
                count: slots,
            });
        }
        let mut replay = Replay::new(mesh.positions(), &removals, point_of);
        let last = removals.last_level();
        for level in 0..last {
            let part = 0.5 + 0.2 * level as f64 / last as f64;
            if level % 4096 == 0 && progress.report(part).is_break() {
                break;
            }
            replay.collapse(removals.collapse(level));
        }
        for (measure, done) in [(Measure::Now, 0.7), (Measure::Larger, 0.85)] {
            if progress.report(done).is_continue() {
                replay.measure(measure);
            }
        }
        Ok(numbering::finish(replay))
    }
}
