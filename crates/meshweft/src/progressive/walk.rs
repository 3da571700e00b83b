//! From one level to another, in time proportional to the removals between them.

use super::progressive_mesh::ProgressiveMesh;

/// A progressive mesh at a level that changes: the faces are edited in place.
#[derive(Debug, Clone)]
pub struct Walk<'a> {
    mesh: &'a ProgressiveMesh,
    level: usize,
    /// Every face in its place; those that left keep the corners that they had.
    faces: Vec<[u32; 3]>,
    is_live: Vec<bool>,
}

impl<'a> Walk<'a> {
    /// At full resolution.
    #[must_use]
    pub fn new(mesh: &'a ProgressiveMesh) -> Self {
        Self {
            mesh,
            level: 0,
            faces: mesh.faces().to_vec(),
            is_live: vec![true; mesh.faces().len()],
        }
    }

    /// The level that the faces have.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Goes to a level.
    ///
    /// # Complexity
    /// Time O(removals between); no memory.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn go_to(&mut self, level: usize) {
        assert!(level <= self.mesh.last_level(), "no level {level}");
        while self.level < level {
            self.coarsen();
        }
        while self.level > level {
            self.refine();
        }
    }

    fn coarsen(&mut self) {
        let collapse = self.mesh.collapse(self.level);
        let corners = self.faces.as_flattened_mut();
        for (pair, changed) in collapse.corners() {
            for &corner in changed {
                corners[corner as usize] = pair.to;
            }
        }
        for &face in collapse.leaving_faces() {
            self.is_live[face as usize] = false;
        }
        self.level += 1;
    }

    fn refine(&mut self) {
        self.level -= 1;
        let collapse = self.mesh.collapse(self.level);
        let corners = self.faces.as_flattened_mut();
        for (pair, changed) in collapse.corners() {
            for &corner in changed {
                corners[corner as usize] = pair.from;
            }
        }
        for &face in collapse.leaving_faces() {
            self.is_live[face as usize] = true;
        }
    }

    /// Whether a face is there at this level.
    #[must_use]
    #[inline]
    pub fn has(&self, face: u32) -> bool {
        self.is_live[face as usize]
    }

    /// The corners of a face, by its number at full resolution; those that it had last if it left.
    #[must_use]
    #[inline]
    pub fn face(&self, face: u32) -> [u32; 3] {
        self.faces[face as usize]
    }

    /// The mesh that is walked.
    #[must_use]
    pub fn mesh(&self) -> &'a ProgressiveMesh {
        self.mesh
    }

    /// Writes the faces of the level to `out`, in the order of the full mesh.
    ///
    /// # Complexity
    /// Time O(faces of the full mesh); memory only if `out` is too small.
    pub fn emit(&self, out: &mut Vec<[u32; 3]>) {
        out.clear();
        out.resize(self.mesh.face_count(self.level), [0; 3]);
        let mut at = 0;
        for (&face, &is_live) in self.faces.iter().zip(&self.is_live) {
            if is_live {
                out[at] = face;
                at += 1;
            }
        }
    }
}
