//! An object with fewer faces: which faces and vertices of its meshes stay.

use super::gathered::{GatheredMesh, MeshFace};
use super::levels::{LevelFigures, figures};
use super::options::SimplifyOptions;
use super::removals::Removals;
use crate::files::{Document, MeshEntry, SelectedFace};
use crate::geometry::double::{Bounds, widened};
use crate::geometry::{Distances, Surface, deviation};
use crate::index::index32;
use crate::progressive::{Collapses, StopReason, Walk};

/// What is to be left of an object.
pub(super) struct Reduced {
    /// What is left of each mesh that has faces, in their order; empty if all stays.
    pub(super) meshes: Vec<ReducedMesh>,
    pub(super) faces_before: usize,
    pub(super) faces_after: usize,
    pub(super) stop: StopReason,
    /// The error of the last removal, as an estimate.
    pub(super) estimated_error: f32,
    /// How far the result is from the object, if that was measured.
    pub(super) distances: Option<Distances>,
    /// The diagonal of the bounding box.
    pub(super) diagonal: f64,
    pub(super) removals: Option<Removals>,
    pub(super) levels: Vec<LevelFigures>,
}

/// What is to be left of a mesh.
pub(super) struct ReducedMesh {
    /// Its number in the file.
    pub(super) mesh: usize,
    /// In the order of the file.
    pub(super) faces: Vec<SelectedFace>,
    /// See [`SelectedFaces::corner_sources`](crate::files::SelectedFaces::corner_sources).
    pub(super) corner_sources: Vec<[u32; 3]>,
    /// For each vertex the one that stands for it, if any does.
    pub(super) fine_to_coarse: Vec<Option<u32>>,
}

/// How far one object is to go.
pub(super) struct Goal {
    /// It stops at this number of faces.
    pub(super) faces: usize,
    /// From how many points of either surface the error is measured.
    pub(super) samples: usize,
}

impl Reduced {
    /// Simplifies the meshes of an object together; those without faces are not among `meshes`.
    ///
    /// # Errors
    /// Why they cannot be simplified.
    ///
    /// # Complexity
    /// That of [`Collapses::build`] and [`deviation`].
    pub(super) fn new(
        document: &Document,
        meshes: &[usize],
        options: &SimplifyOptions,
        goal: &Goal,
    ) -> Result<Self, String> {
        let gathered = GatheredMesh::new(document, meshes)?;
        let source = &gathered.mesh;
        let diagonal = diagonal(source.positions(), source.faces());

        // All levels down to what was asked for.
        let has_other_faces = meshes
            .iter()
            .any(|&mesh| document.meshes()[mesh].has_other_faces);
        let error = options
            .error
            .map_or(f32::INFINITY, |limit| limit.of_diagonal(diagonal));
        let collapses = Collapses {
            effort: options.ordering.effort,
            lock_border: options.lock_border || has_other_faces,
            drop_parts: options.drop_parts,
            // A face never has corners of two parts of a texture.
            cross_seams: false,
            faces: match options.with_removals || options.levels > 0 {
                true => 0,
                false => goal.faces,
            },
            error,
            weights: options.weights,
        };
        let progressive = collapses
            .build(source, &gathered.attributes)
            .map_err(|error| error.to_string())?;

        // The level, which has a face left.
        let mut level = progressive.level_of_faces(goal.faces);
        while level > 0 && progressive.face_count(level) == 0 {
            level -= 1;
        }
        let mut walk = Walk::new(&progressive);
        walk.go_to(level);
        let mut reduced = Self {
            meshes: Vec::new(),
            faces_before: source.face_count(),
            faces_after: progressive.face_count(level),
            stop: match progressive.face_count(level) <= goal.faces {
                true => StopReason::Faces,
                false => progressive.stop(),
            },
            estimated_error: progressive.error(level),
            distances: None,
            diagonal,
            removals: options
                .with_removals
                .then(|| Removals::new(&progressive, &gathered)),
            levels: match options.levels {
                0 => Vec::new(),
                count => figures(&progressive, count),
            },
        };
        if level == 0 {
            return Ok(reduced);
        }

        reduced.meshes = selected(document.meshes(), meshes, &gathered, &walk);
        let coarse = progressive.fine_to_coarse(level);
        for (number, &side) in gathered.sides.iter().enumerate().rev() {
            let place = meshes.binary_search(&(side.mesh as usize));
            if let Ok(place) = place {
                let vertex = coarse[number].map(|to| gathered.sides[to as usize].vertex);
                reduced.meshes[place].fine_to_coarse[side.vertex as usize] = vertex;
            }
        }
        for mesh in &mut reduced.meshes {
            mesh.settle_fine_to_coarse(document.meshes()[mesh.mesh].mesh.faces());
        }
        if goal.samples > 0 {
            let mut left = Vec::new();
            walk.emit(&mut left);
            let surfaces = [source.faces(), &left];
            let [full, left] = surfaces.map(|faces| Surface::new(source.positions(), faces));
            reduced.distances = Some(deviation(&full, &left, goal.samples).two_sided);
        }
        Ok(reduced)
    }
}

/// What is left of each mesh at the level of a walk.
fn selected(
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
    fn settle_fine_to_coarse(&mut self, before: &[[u32; 3]]) {
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

/// The diagonal of the bounding box of all corners.
fn diagonal(positions: &[[f32; 3]], faces: &[[u32; 3]]) -> f64 {
    let mut bounds = Bounds::default();
    for &vertex in faces.as_flattened() {
        bounds.add(widened(positions[vertex as usize]));
    }
    bounds.diagonal()
}
