//! The surface of a frame, by the numbers of a walk.

use super::error::TerrainError;
use super::numbers::DistinctNumbers;
use super::source::TerrainSource;
use crate::lod::CameraView;
use crate::lod::quad_tin::{TinLimit, TinSurface};

/// What a frame draws, with numbers for vertices and faces from when they are first drawn.
#[derive(Debug, Default)]
pub(super) struct NumberedSurface {
    pub(super) surface: TinSurface,
    pub(super) vertices: DistinctNumbers,
    pub(super) faces: DistinctNumbers,
    /// Of each face that was drawn its vertices.
    corners: Vec<[u32; 3]>,
    /// The errors of the vertices that this frame draws first.
    pub(super) new_errors: Vec<f32>,
    /// How many faces it draws first.
    pub(super) new_faces: usize,
    /// The corners of all its faces, and these faces.
    pub(super) active: Vec<u32>,
    pub(super) living: Vec<(u32, [u32; 3])>,
}

impl NumberedSurface {
    /// The surface that a view needs, of limited size if that is asked for.
    pub(super) fn draw(
        &mut self,
        source: &mut TerrainSource,
        view: &CameraView,
        limit: Option<TinLimit>,
        frame: usize,
    ) -> Result<(), TerrainError> {
        source.draw(view, limit, Some(frame), &mut self.surface)?;
        self.number_all(source);
        Ok(())
    }

    fn number_all(&mut self, source: &TerrainSource) {
        let before = self.faces.len();
        self.new_errors.clear();
        self.active.clear();
        self.living.clear();
        let tin = source.tin();
        for &(id, corners) in self.surface.faces() {
            let (face, is_new) = self.faces.number(id);
            if is_new {
                let corners = corners.map(|vertex| {
                    let (number, is_new) = self.vertices.number(vertex);
                    if is_new {
                        // What is always drawn is as coarse as can be.
                        self.new_errors.push(tin.error(vertex).min(f32::MAX));
                    }
                    number
                });
                self.corners.push(corners);
            }
            let corners = self.corners[face as usize];
            self.living.push((face, corners));
            self.active.extend(corners);
        }
        self.new_faces = self.faces.len() - before;
    }
}
