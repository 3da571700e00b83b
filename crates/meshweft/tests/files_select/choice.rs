//! Random faces and vertices to be selected.

use meshweft::files::{MeshEntry, SelectedFace};

use crate::random::Random;

/// Faces of a mesh, and vertices of its group.
#[derive(Debug, Clone, Default)]
pub(crate) struct Choice {
    pub(crate) faces: Vec<SelectedFace>,
    /// `None` for all.
    pub(crate) vertices: Option<Vec<u32>>,
}

impl Choice {
    /// All faces as they are, and all vertices.
    pub(crate) fn all(entry: &MeshEntry) -> Self {
        let faces = (0..).zip(entry.mesh.faces());
        let faces = faces.map(|(face, &corners)| SelectedFace { face, corners });
        Self {
            faces: faces.collect(),
            vertices: Some((0..entry.mesh.vertex_count() as u32).collect()),
        }
    }

    /// Leaves the faces with these numbers as they are.
    pub(crate) fn of_faces(entry: &MeshEntry, faces: impl IntoIterator<Item = u32>) -> Self {
        let faces = faces.into_iter().map(|face| SelectedFace {
            face,
            corners: entry.mesh.faces()[face as usize],
        });
        Self {
            faces: faces.collect(),
            vertices: None,
        }
    }

    /// The vertices that faces use.
    pub(crate) fn used(&self) -> Vec<u32> {
        let mut used: Vec<u32> = self.faces.iter().flat_map(|face| face.corners).collect();
        used.sort_unstable();
        used.dedup();
        used
    }

    /// This with the vertices that its faces use.
    pub(crate) fn with_used(mut self) -> Self {
        self.vertices = Some(self.used());
        self
    }

    /// Collapses some of the edges, leaves out some of the faces and vertices, and changes the order where
    /// that is possible. There is one face at least.
    pub(crate) fn random(entry: &MeshEntry, random: &mut Random) -> Self {
        let old = entry.mesh.faces();
        let mut target: Vec<u32> = (0..entry.mesh.vertex_count() as u32).collect();
        let collapses = random.below(1 + old.len() / 4);
        for _ in 0..collapses {
            let face = old[random.below(old.len())];
            let corner = random.below(3);
            target[face[corner] as usize] = target[face[(corner + 1) % 3] as usize];
        }

        let mut choice = Self::default();
        let share = 1 + random.below(8);
        for (face, corners) in (0..).zip(old) {
            let corners = corners.map(|vertex| target[vertex as usize]);
            let is_flat = corners != old[face as usize]
                && (0..3).any(|corner| corners[corner] == corners[(corner + 1) % 3]);
            if !is_flat && random.below(8) < share {
                choice.faces.push(SelectedFace { face, corners });
            }
        }
        if choice.faces.is_empty() {
            choice = Self::of_faces(entry, [random.below(old.len()) as u32]);
        }

        // Another order of the faces, where that is easily told.
        let is_free = entry.faces_movable && entry.runs.len() == 1 && entry.polygons.is_none();
        if is_free && random.below(2) == 0 {
            shuffle(&mut choice.faces, random);
        }
        if random.below(4) > 0 {
            let mut is_kept = vec![false; target.len()];
            for vertex in choice.used() {
                is_kept[vertex as usize] = true;
            }
            let mut kept: Vec<u32> = (0..target.len() as u32)
                .filter(|&vertex| is_kept[vertex as usize] || random.below(8) == 0)
                .collect();
            if entry.vertices_movable && random.below(2) == 0 {
                shuffle(&mut kept, random);
            }
            choice.vertices = Some(kept);
        }
        choice
    }
}

fn shuffle<T>(entries: &mut [T], random: &mut Random) {
    for last in (1..entries.len()).rev() {
        entries.swap(last, random.below(last + 1));
    }
}
