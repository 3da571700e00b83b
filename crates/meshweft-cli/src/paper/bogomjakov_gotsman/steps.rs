//! A small mesh from which two vertices are removed, as in Fig. 6, and jumps of sequences.

use meshweft::operations::{Method, SequenceUpdate, collapse_history};
use meshweft::{Mesh, MeshError};

use crate::paper::irregular::Irregular;

/// Vertices of the mesh, on its boundary, and where its random numbers begin.
const VERTICES: usize = 40;
const BOUNDARY: usize = 12;
const SEED: u64 = 1;
/// Vertices that are removed.
const REMOVALS: usize = 2;

/// The faces of a level in the order of drawing.
pub(super) struct Step {
    pub(super) faces: Vec<[u32; 3]>,
    /// What leads to the next step.
    pub(super) next: Option<Removal>,
}

/// The vertex that leaves, its faces, and those that fill the hole.
pub(super) struct Removal {
    pub(super) vertex: u32,
    pub(super) star: Vec<[u32; 3]>,
    pub(super) hole: Vec<[u32; 3]>,
}

/// The mesh at full resolution.
pub(super) fn small_mesh() -> Mesh {
    Irregular::new(VERTICES, BOUNDARY, SEED).surface()
}

/// Its sequence by recursive cut, and what the smart update makes of it, removal by removal.
pub(super) fn steps() -> Result<Vec<Step>, MeshError> {
    let mesh = small_mesh();
    let history = collapse_history(&mesh, mesh.face_count() / 2)?;
    let order = Method::RecursiveCut.order(history.full_faces());
    let removals = REMOVALS.min(history.len());

    let mut levels = Vec::new();
    SequenceUpdate::Smart.at_levels(&history, &order, 0..=removals, |faces| {
        levels.push(faces.to_vec());
    })?;
    let step = |(level, faces)| {
        let next = (level < removals).then(|| {
            let record = history.record(level);
            let star = record.removed_faces.iter();
            Removal {
                vertex: record.removed_vertices[0],
                star: star.map(|&face| history.face(face)).collect(),
                hole: record
                    .inserted_faces
                    .map(|face| history.face(face))
                    .collect(),
            }
        });
        Step { faces, next }
    };
    Ok(levels.into_iter().enumerate().map(step).collect())
}

/// How often a sequence goes on to a face that has no edge in common with the one before.
pub(super) fn jumps(faces: &[[u32; 3]]) -> usize {
    faces
        .windows(2)
        .filter(|pair| is_jump(pair[0], pair[1]))
        .count()
}

/// Whether two faces have no edge in common.
pub(super) fn is_jump(a: [u32; 3], b: [u32; 3]) -> bool {
    a.iter().filter(|vertex| b.contains(vertex)).count() < 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_has_the_faces_that_the_last_one_left() {
        let sorted = |faces: &[[u32; 3]]| {
            let mut faces = faces.to_vec();
            faces.sort_unstable();
            faces
        };
        let steps = steps().unwrap();
        assert_eq!((steps.len(), steps[0].faces.len()), (3, 66));
        for pair in steps.windows(2) {
            let next = pair[0].next.as_ref().unwrap();
            assert!(next.star.iter().all(|face| face.contains(&next.vertex)));
            let mut expected = pair[0].faces.clone();
            expected.retain(|face| !face.contains(&next.vertex));
            expected.extend(&next.hole);
            assert_eq!(sorted(&expected), sorted(&pair[1].faces));
        }
        assert!(steps[2].next.is_none());
    }

    #[test]
    fn no_face_is_turned_over_seen_from_above() {
        let mesh = small_mesh();
        for face in steps().unwrap().iter().flat_map(|step| &step.faces) {
            let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize]);
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(twice > 0.0, "{face:?}: {twice}");
        }
    }

    #[test]
    fn a_jump_has_no_common_edge() {
        assert_eq!(jumps(&[[0, 1, 2], [2, 1, 3], [3, 4, 5], [3, 4, 1]]), 1);
        assert_eq!(jumps(&[]), 0);
    }
}
