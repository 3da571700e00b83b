//! Levels of detail that a file does not have yet.

use super::error::FileErrorKind;
use crate::faces::Faces;

/// Levels of detail to be added to a mesh, for [`Edit::Levels`](super::Edit::Levels).
#[derive(Debug, Clone)]
pub struct NewLevels {
    /// The number of the mesh, which is the full one.
    pub mesh: usize,
    /// The vertices that the levels have copies of, in the order of the copies: of a mesh without an index list. Empty if the
    /// levels have the vertices of the mesh.
    pub copies: Vec<u32>,
    /// Its levels, fine to coarse. Meshes that are drawn together (the primitives of a glTF mesh) have equally many.
    pub levels: Vec<NewLevel>,
    /// How far the vertices of its faces are from the center of their bounding box at most, in units of the positions.
    pub radius: f64,
}

/// Which vertices the levels of detail of a mesh can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VerticesOfLevels {
    /// Those of the mesh.
    OfMesh,
    /// Copies: the mesh has no index list, and what else reads its vertices would make them immovable.
    Copies,
    /// None: it has no index list, and they cannot be copied.
    None,
}

/// A mesh with fewer faces, over vertices of the full one.
#[derive(Debug, Clone)]
pub struct NewLevel {
    /// At least one, by the numbers of the vertices as they are now; `None` for the same as in the next finer level, of which
    /// the first is the full mesh.
    pub faces: Option<Vec<[u32; 3]>>,
    /// How many vertices from the first on have all that a reader needs for it, once the vertices are in their final order; of
    /// copies, if it has those.
    pub vertices: usize,
    /// How far it is from the full mesh, in units of the positions.
    pub error: f64,
}

impl NewLevels {
    /// Whether there are levels, and each is of vertices that are there.
    pub(super) fn check(&self, vertex_count: usize) -> Result<(), FileErrorKind> {
        let is_length = |length: f64| length >= 0.0 && length.is_finite();
        let lengths = self.levels.iter().map(|level| level.error);
        let lists = self.levels.iter().filter_map(|level| level.faces.as_ref());
        let has_faces = lists.clone().all(|faces| !faces.is_empty());
        let is_sound = is_length(self.radius) && lengths.clone().all(is_length);
        if self.levels.is_empty() || !has_faces || !is_sound {
            let text =
                "it needs one level or more, each with faces, its error and the radius 0 or more";
            return Err(FileErrorKind::unsupported(text));
        }
        for faces in lists.clone() {
            Faces::new(faces, vertex_count).map_err(FileErrorKind::Order)?;
        }

        // All vertices of the levels are copied, each once, or none.
        if self.copies.is_empty() {
            return Ok(());
        }
        let mut is_copied = vec![false; vertex_count];
        let is_new = |&vertex: &u32| {
            let place = is_copied.get_mut(vertex as usize);
            place.is_some_and(|is_copied| !std::mem::replace(is_copied, true))
        };
        let are_new = self.copies.iter().all(is_new);
        let mut corners = lists.flat_map(|faces| faces.as_flattened());
        if !are_new || !corners.all(|&vertex| is_copied[vertex as usize]) {
            let text = "its copies of vertices are each to be of another one, and all vertices of its levels among them";
            return Err(FileErrorKind::unsupported(text));
        }
        Ok(())
    }
}

/// How much of a picture a mesh covers where a pixel is as long as an error, of 1920 by 1080 pixels: the switch to the
/// level with that error is not seen where it covers less.
///
/// # Complexity
/// O(1).
#[must_use]
pub fn screen_coverage(radius: f64, error: f64) -> f64 {
    const PIXELS: f64 = 1920.0 * 1080.0;
    let pixels = radius / error;
    match pixels.is_finite() {
        true => (std::f64::consts::PI * pixels * pixels / PIXELS).min(1.0),
        // Nothing is off.
        false => 1.0,
    }
}
