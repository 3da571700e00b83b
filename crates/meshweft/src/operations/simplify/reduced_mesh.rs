//! What is left of a mesh whose object was simplified.

use super::gathered::{GatheredMesh, MeshFace};
use crate::files::{MeshEntry, SelectedFace};
use crate::index::index32;
use crate::progressive::Walk;

/// What is to be left of a mesh.
pub(in crate::operations) struct ReducedMesh {
    /// Its number in the file.
    pub(in crate::operations) mesh: usize,
    /// In the order of the file.
    pub(in crate::operations) faces: Vec<SelectedFace>,
    /// See [`SelectedFaces::corner_sources`](crate::files::SelectedFaces::corner_sources).
    pub(super) corner_sources: Vec<[u32; 3]>,
    /// For each vertex the one that stands for it, if any does.
    pub(super) fine_to_coarse: Vec<Option<u32>>,
}

/// What is left of each mesh at the level of a walk.
pub(super) fn selected(
    entries: &[MeshEntry],
    meshes: &[usize],
    gathered: &GatheredMesh,
    walk: &Walk<'_>,
) -> Vec<ReducedMesh> {
    let mut all = Vec::with_capacity(meshes.len());
    // The faces of a mesh are one after the other.
    let mut rest = gathered.faces.as_slice();
    for &mesh in meshes {
        let entry = &entries[mesh];
        let first = index32(gathered.faces.len() - rest.len());
        let (own, others) = rest.split_at(entry.mesh.face_count());
        rest = others;

        // Where each face of the mesh is in the walk.
        let mut place_of = vec![0; own.len()];
        for (place, MeshFace { face, .. }) in (first..).zip(own) {
            place_of[*face as usize] = place;
        }
        let mesh_walk = MeshWalk {
            entry,
            gathered,
            walk,
            place_of,
        };
        all.push(mesh_walk.reduced(mesh));
    }
    all
}

/// A mesh of an object that was simplified.
struct MeshWalk<'a> {
    entry: &'a MeshEntry,
    gathered: &'a GatheredMesh,
    walk: &'a Walk<'a>,
    place_of: Vec<u32>,
}

impl MeshWalk<'_> {
    /// What is left of the mesh with this number.
    fn reduced(&self, mesh: usize) -> ReducedMesh {
        let all = self.entry.mesh.faces();
        let mut reduced = ReducedMesh {
            mesh,
            faces: Vec::new(),
            corner_sources: Vec::new(),
            fine_to_coarse: (0..index32(self.entry.mesh.vertex_count()))
                .map(Some)
                .collect(),
        };
        for record in 0..self.entry.record_count() {
            let faces = self.entry.faces_of(record);
            // A polygon is as it was if all its faces are.
            let is_whole = faces.len() > 1 && faces.clone().all(|face| self.is_unchanged(face));
            for face in faces {
                let place = self.place_of[face];
                if is_whole {
                    reduced.push(face, all[face], own_corners(face));
                } else if self.walk.has(place) {
                    let corners = [0, 1, 2].map(|slot| self.corner(face, slot));
                    let vertices = corners.map(|(vertex, _)| vertex);
                    reduced.push(face, vertices, corners.map(|(_, source)| source));
                }
            }
        }

        // Files cannot do without: the mesh has a face without an area then.
        if reduced.faces.is_empty() {
            reduced.push(0, [all[0][0]; 3], [0; 3]);
        }
        reduced
    }

    /// Whether a face is there, and no corner of it has moved.
    fn is_unchanged(&self, face: usize) -> bool {
        let place = self.place_of[face];
        let full = self.walk.mesh().faces()[place as usize];
        self.walk.has(place) && self.walk.face(place) == full
    }

    /// The vertex at a corner, and a corner of the source that has what is to be stored there.
    fn corner(&self, face: usize, slot: usize) -> (u32, u32) {
        let place = self.place_of[face];
        let side = self.walk.face(place)[slot];
        if self.gathered.mesh.faces()[place as usize][slot] == side {
            return (self.entry.mesh.faces()[face][slot], own_corners(face)[slot]);
        }
        let side = self.gathered.sides[side as usize];
        (side.vertex, side.corner)
    }
}

impl ReducedMesh {
    /// Vertices that are used stand for themselves, and others are stood for by those only. `before` has the
    /// faces of the full mesh, whose other vertices stay.
    pub(super) fn settle_fine_to_coarse(&mut self, before: &[[u32; 3]]) {
        let mut was_used = vec![false; self.fine_to_coarse.len()];
        for &vertex in before.as_flattened() {
            was_used[vertex as usize] = true;
        }
        let mut is_used = vec![false; self.fine_to_coarse.len()];
        for vertex in self.faces.iter().flat_map(|face| face.corners) {
            is_used[vertex as usize] = true;
        }
        for (vertex, coarse) in (0_u32..).zip(&mut self.fine_to_coarse) {
            let stays = is_used[vertex as usize] || !was_used[vertex as usize];
            *coarse = match stays {
                true => Some(vertex),
                false => coarse.filter(|&to| is_used[to as usize]),
            };
        }
    }

    fn push(&mut self, face: usize, corners: [u32; 3], sources: [u32; 3]) {
        let face = index32(face);
        self.faces.push(SelectedFace { face, corners });
        self.corner_sources.push(sources);
    }
}

/// The numbers of the corners of a face.
fn own_corners(face: usize) -> [u32; 3] {
    [0, 1, 2].map(|slot| index32(3 * face + slot))
}
