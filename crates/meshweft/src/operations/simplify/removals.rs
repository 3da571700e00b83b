//! In which order the vertices of an object leave.

use serde_json::{Value, json};

use super::gathered::GatheredMesh;
use crate::index::index32;
use crate::progressive::ProgressiveMesh;

/// The vertices that leave, one after the other down to the coarsest mesh, in columns.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Removals {
    /// The number of the mesh in the file that each vertex is of.
    pub mesh: Vec<u32>,
    /// The vertex, by its number in the source.
    pub vertex: Vec<u32>,
    /// The vertex that its corners go to; `None` if they leave with a whole part.
    pub into: Vec<Option<u32>>,
    /// How many faces the object has then.
    pub faces: Vec<u32>,
    /// How far the object then is from the source, as an estimate in units of the positions.
    pub error: Vec<f32>,
}

impl Removals {
    /// Those of a progressive mesh of the gathered one.
    pub(super) fn new(progressive: &ProgressiveMesh, gathered: &GatheredMesh) -> Self {
        let mut removals = Self::default();
        for level in 0..progressive.last_level() {
            let collapse = progressive.collapse(level);
            let first = removals.vertex.len();
            for pair in collapse.pairs() {
                let [from, to] = [pair.from, pair.to].map(|side| gathered.sides[side as usize]);
                let is_known = (first..removals.vertex.len()).any(|row| {
                    (removals.mesh[row], removals.vertex[row]) == (from.mesh, from.vertex)
                });
                if !is_known {
                    let stays = pair.from != pair.to;
                    removals.mesh.push(from.mesh);
                    removals.vertex.push(from.vertex);
                    removals.into.push(stays.then_some(to.vertex));
                    removals
                        .faces
                        .push(index32(progressive.face_count(level + 1)));
                    removals.error.push(collapse.error());
                }
            }
        }
        removals
    }

    /// As a JSON object, a list a column.
    pub(super) fn json(&self) -> Value {
        json!({
            "mesh": self.mesh,
            "vertex": self.vertex,
            "into": self.into,
            "faces": self.faces,
            "error": self.error,
        })
    }
}
