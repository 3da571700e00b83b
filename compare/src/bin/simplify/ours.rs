//! The mesh with fewer faces by the library.

use meshweft::Mesh;
use meshweft::order::Effort;
use meshweft::progressive::{Collapses, Walk};

/// The mesh at each of these numbers of faces; `None` where it cannot have as few.
pub(crate) fn ours(mesh: &Mesh, face_counts: &[usize], effort: Effort) -> Vec<Option<Mesh>> {
    let settings = Collapses {
        effort,
        faces: face_counts.iter().copied().min().unwrap_or(0),
        // meshoptimizer takes small parts away too.
        drop_parts: true,
        ..Collapses::default()
    };
    let Ok(progressive) = settings.build(mesh, &[]) else {
        return vec![None; face_counts.len()];
    };
    let mut walk = Walk::new(&progressive);
    let mut faces = Vec::new();
    let levels = face_counts.iter().map(|&count| {
        let level = progressive.level_of_faces(count);
        walk.go_to(level);
        walk.emit(&mut faces);
        let is_reached = progressive.face_count(level) <= count;
        is_reached.then(|| Mesh::new(mesh.positions(), faces.as_slice()).ok())?
    });
    levels.collect()
}
