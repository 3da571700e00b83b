//! What clusters are made of.

use super::masks::Mask;
use crate::mesh::Mesh;

/// The faces that clusters are made of, and what the sampled eyes see of each.
pub(super) struct Seen<'a, const WORDS: usize> {
    pub(super) mesh: &'a Mesh,
    /// Rising.
    pub(super) faces: &'a [u32],
    pub(super) masks: &'a [Mask<WORDS>],
    /// Towards each eye.
    pub(super) directions: &'a [[f64; 3]],
}

impl<const WORDS: usize> Seen<'_, WORDS> {
    /// The place of one of the faces among them.
    pub(super) fn place(&self, face: u32) -> usize {
        let place = self.faces.binary_search(&face);
        place.expect("one of the faces")
    }

    /// The vertices of each of the faces.
    pub(super) fn corners(&self) -> Vec<[u32; 3]> {
        let corners = self.faces.iter();
        corners
            .map(|&face| self.mesh.faces()[face as usize])
            .collect()
    }
}
