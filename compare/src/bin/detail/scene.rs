//! A mesh with all its levels of detail.

use std::path::Path;
use std::time::Instant;

use meshweft::files::Document;
use meshweft::geometry::{Ball, vertex_normals};
use meshweft::lod::Camera;
use meshweft::lod::fast_mesh::{FastMesh, Front, VertexHierarchy};
use meshweft::operations::CameraPath;
use meshweft::{Limits, Mesh};

use crate::SIZE;

/// What is walked around.
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) document: Document,
    pub(crate) hierarchy: VertexHierarchy,
    /// The full mesh: every vertex of the hierarchy, by its number there.
    pub(crate) full: Mesh,
    /// What rivals take: the file's mesh in the order for a cache. On the dragon the p99.9 of meshoptimizer's errors is more than
    /// twice as large where it gets the full mesh above.
    pub(crate) for_rivals: Mesh,
    pub(crate) normals: Vec<[f32; 3]>,
    pub(crate) ball: Ball,
    pub(crate) build_seconds: f64,
}

impl Scene {
    /// The meshes of a file as one; `None` if that has fewer faces.
    pub(crate) fn open(file: &Path, least_faces: usize) -> Result<Option<Self>, String> {
        let document = Document::open(file, Limits::default()).map_err(|it| it.to_string())?;
        let mesh = compare::read_as_one(file)?;
        if mesh.face_count() < least_faces {
            return Ok(None);
        }
        let start = Instant::now();
        let hierarchy = FastMesh::default().build(&mesh, &[]);
        let hierarchy = hierarchy.map_err(|it| it.to_string())?;
        let build_seconds = start.elapsed().as_secs_f64();

        // All of it, by the hierarchy's numbers.
        let mut front = Front::new(hierarchy.clone());
        front.refine_fully();
        let faces: Vec<[u32; 3]> = front.faces().map(|(_, corners)| corners).collect();
        let sources = hierarchy.source_vertices().iter();
        let positions: Vec<_> = sources.map(|&it| mesh.positions()[it as usize]).collect();
        let points = positions.iter().map(|point| point.map(f64::from));
        let ball = Ball::around(points).ok_or_else(|| format!("{}: no faces", file.display()))?;
        Ok(Some(Self {
            name: compare::mesh_name(file),
            document,
            hierarchy,
            for_rivals: compare::in_greedy_order(&mesh, 11),
            normals: vertex_normals(&positions, &faces),
            full: Mesh::new(positions, faces).map_err(|it| it.to_string())?,
            ball,
            build_seconds,
        }))
    }

    /// The coarsest front.
    pub(crate) fn front(&self) -> Front {
        Front::new(self.hierarchy.clone())
    }

    /// The cameras of a path.
    pub(crate) fn cameras(
        &self,
        path: &CameraPath,
        frames: usize,
    ) -> impl Iterator<Item = Camera> + use<> {
        let (path, ball) = (path.clone(), self.ball);
        (0..frames).map(move |frame| path.camera(ball, frame, frames, SIZE))
    }

    /// The faces of a front.
    pub(crate) fn drawn(front: &Front) -> Vec<[u32; 3]> {
        front.faces().map(|(_, corners)| corners).collect()
    }
}
