//! From one level to another, in time proportional to the removals between them.

use super::progressive_mesh::ProgressiveMesh;
use super::records::SidePair;

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
        self.go_to_marking(level, |_| ());
    }

    /// Goes to a level; says which faces change, come or leave, some of them several times.
    #[inline]
    pub(super) fn go_to_marking(&mut self, level: usize, mut mark: impl FnMut(u32)) {
        assert!(level <= self.mesh.last_level(), "no level {level}");
        while self.level < level {
            self.play(self.level, |pair| pair.to, false, &mut mark);
            self.level += 1;
        }
        while self.level > level {
            self.level -= 1;
            self.play(self.level, |pair| pair.from, true, &mut mark);
        }
    }

    /// Gives the corners of a record the vertex that they get, and lets its faces leave or come.
    #[inline]
    fn play(
        &mut self,
        record: usize,
        vertex: impl Fn(SidePair) -> u32,
        is_live: bool,
        mark: &mut impl FnMut(u32),
    ) {
        let collapse = self.mesh.collapse(record);
        let corners = self.faces.as_flattened_mut();
        for (pair, changed) in collapse.corners() {
            for &corner in changed {
                corners[corner as usize] = vertex(pair);
                mark(corner / 3);
            }
        }
        for &face in collapse.leaving_faces() {
            self.is_live[face as usize] = is_live;
            mark(face);
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
        let faces = self.faces.iter().zip(&self.is_live);
        self.emit_live(faces.map(|(&face, &is_live)| (face, is_live)), out);
    }

    /// Writes those of these faces that are there to `out`, in their order; all that are there are among them.
    pub(super) fn emit_in(&self, order: &[u32], out: &mut Vec<[u32; 3]>) {
        let faces = order.iter();
        self.emit_live(faces.map(|&face| (self.face(face), self.has(face))), out);
    }

    fn emit_live(&self, faces: impl Iterator<Item = ([u32; 3], bool)>, out: &mut Vec<[u32; 3]>) {
        // Without a branch each face is written, and the next one over it if it has left.
        out.resize(self.mesh.face_count(self.level) + 1, [0; 3]);
        let mut at = 0;
        for (face, is_live) in faces {
            out[at] = face;
            at += usize::from(is_live);
        }
        out.truncate(at);
    }
}
