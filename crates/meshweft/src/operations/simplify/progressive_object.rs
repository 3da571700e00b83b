//! The meshes of an object as one progressive mesh.

use std::collections::BTreeMap;

use super::gathered::GatheredMesh;
use super::reduced_mesh::{ReducedMesh, selected};
use crate::files::{Document, MeshEntry};
use crate::geometry::double::{Bounds, dot, sub, widened};
use crate::geometry::{Distances, Surface, deviation};
use crate::index::index32;
use crate::progressive::{Collapses, ProgressiveMesh, Walk};

/// An object at all its resolutions.
pub(in crate::operations) struct ProgressiveObject {
    pub(super) gathered: GatheredMesh,
    pub(in crate::operations) progressive: ProgressiveMesh,
    /// The diagonal of the bounding box.
    pub(in crate::operations) diagonal: f64,
}

impl ProgressiveObject {
    /// Simplifies the meshes of an object together; those without faces are not among `meshes`. The settings may depend on
    /// the diagonal; borders are locked where the object has faces elsewhere.
    ///
    /// # Errors
    /// Why they cannot be simplified.
    ///
    /// # Complexity
    /// That of [`Collapses::build`].
    pub(in crate::operations) fn new(
        document: &Document,
        meshes: &[usize],
        settings: impl FnOnce(f64) -> Collapses,
    ) -> Result<Self, String> {
        let gathered = GatheredMesh::new(document, meshes)?;
        let source = &gathered.mesh;
        let diagonal = diagonal(source.positions(), source.faces());
        let entries = document.meshes();
        let mut collapses = settings(diagonal);
        collapses.lock_border |= meshes.iter().any(|&mesh| entries[mesh].has_other_faces);
        let progressive = collapses
            .build(source, &gathered.attributes)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            gathered,
            progressive,
            diagonal,
        })
    }

    /// What is left of each of its meshes at the level of a walk.
    pub(in crate::operations) fn reduced_meshes(
        &self,
        entries: &[MeshEntry],
        meshes: &[usize],
        walk: &Walk<'_>,
    ) -> Vec<ReducedMesh> {
        let gathered = &self.gathered;
        let mut reduced = selected(entries, meshes, gathered, walk);
        let coarse = self.progressive.fine_to_coarse(walk.level());
        for (number, &side) in gathered.sides.iter().enumerate().rev() {
            let place = meshes.binary_search(&(side.mesh as usize));
            if let Ok(place) = place {
                let vertex = coarse[number].map(|to| gathered.sides[to as usize].vertex);
                reduced[place].fine_to_coarse[side.vertex as usize] = vertex;
            }
        }
        for mesh in &mut reduced {
            mesh.settle_fine_to_coarse(entries[mesh.mesh].mesh.faces());
        }
        reduced
    }

    /// How far vertices are from the center of their bounding box at most, by a number that their mesh has.
    ///
    /// Time O(vertices log meshes).
    pub(in crate::operations) fn radii(
        &self,
        number_of: impl Fn(usize) -> usize,
    ) -> BTreeMap<usize, f64> {
        let sides = self.gathered.sides.iter();
        let sides = sides.zip(self.gathered.mesh.positions());
        let places = sides.map(|(side, &position)| (side.mesh as usize, widened(position)));
        let places = places.filter(|(_, position)| position.iter().all(|x| x.is_finite()));
        let places = places.map(|(mesh, position)| (number_of(mesh), position));

        let mut bounds: BTreeMap<usize, Bounds> = BTreeMap::new();
        for (number, position) in places.clone() {
            bounds.entry(number).or_default().add(position);
        }
        let mut radii = BTreeMap::new();
        for (number, position) in places {
            let from_center = sub(position, bounds[&number].center());
            let radius: &mut f64 = radii.entry(number).or_default();
            *radius = radius.max(dot(from_center, from_center).sqrt());
        }
        radii
    }

    /// How far the level of a walk is from the object; `samples` is the number of points of both surfaces.
    ///
    /// Of several parts (materials, primitives) each is also measured on its own: where two lie in one plane, their border is
    /// seen and the surface does not move. The greatest distance is that of any.
    ///
    /// # Complexity
    /// That of [`deviation`], twice.
    pub(in crate::operations) fn distances(&self, walk: &Walk<'_>, samples: usize) -> Distances {
        let all: Vec<u32> = (0..index32(self.gathered.faces.len())).collect();
        let mut distances = self.distances_of(&all, walk, samples);
        let parts = self.parts();
        if parts.len() > 1 {
            for faces in parts.values() {
                let share = samples as u128 * faces.len() as u128;
                let share = share.div_ceil(all.len() as u128);
                let share = usize::try_from(share).unwrap_or(usize::MAX);
                let is_left = faces.iter().any(|&face| walk.has(face));
                distances.max = distances.max.max(match is_left {
                    true => self.distances_of(faces, walk, share).max,
                    // It left as a whole, which is not farther than was estimated.
                    false => f64::from(self.progressive.error(walk.level())),
                });
            }
        }
        distances
    }

    /// How far what is left of some faces is from these.
    fn distances_of(&self, faces: &[u32], walk: &Walk<'_>, samples: usize) -> Distances {
        let source = &self.gathered.mesh;
        let full = faces.iter().map(|&face| source.faces()[face as usize]);
        let left = faces.iter().filter(|&&face| walk.has(face));
        let left = left.map(|&face| walk.face(face));
        let (full, left): (Vec<_>, Vec<_>) = (full.collect(), left.collect());
        let [full, left] = [&full, &left].map(|faces| Surface::new(source.positions(), faces));
        deviation(&full, &left, samples).two_sided
    }

    /// The faces of each part, by their places.
    fn parts(&self) -> BTreeMap<(u32, u32), Vec<u32>> {
        let mut parts: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
        for (place, face) in (0..).zip(self.gathered.mesh.faces()) {
            let part = self.gathered.sides[face[0] as usize].part();
            parts.entry(part).or_default().push(place);
        }
        parts
    }
}

/// The diagonal of the bounding box of all corners.
fn diagonal(positions: &[[f32; 3]], faces: &[[u32; 3]]) -> f64 {
    let mut bounds = Bounds::default();
    for &vertex in faces.as_flattened() {
        bounds.add(widened(positions[vertex as usize]));
    }
    bounds.diagonal()
}
