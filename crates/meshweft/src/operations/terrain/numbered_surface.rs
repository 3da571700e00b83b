//! The surface of a frame, by the numbers of a walk.

use super::error::TerrainError;
use super::numbers::DistinctNumbers;
use super::source::TerrainSource;
use crate::index::index32;
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
    last: LastFaces,
}

/// The faces of the frame before: most of them come again, one after the other, and need not be looked up.
#[derive(Debug, Default)]
struct LastFaces {
    /// What the surface calls them, and their numbers.
    faces: Vec<(u32, u32)>,
    /// Of each face that was drawn its place in the last frame that had it.
    places: Vec<u32>,
}

impl LastFaces {
    /// What the surface calls a face, and its number.
    fn at(&self, place: usize) -> Option<(u32, u32)> {
        self.faces.get(place).copied()
    }

    /// What comes after a face, if that was there.
    fn after(&self, number: u32) -> Option<usize> {
        let place = *self.places.get(number as usize)? as usize;
        let is_there = self.at(place).is_some_and(|it| it.1 == number);
        is_there.then_some(place + 1)
    }

    /// The faces of this frame are the last ones now.
    fn follow(&mut self, surface: &TinSurface, living: &[(u32, [u32; 3])], face_count: usize) {
        self.places.resize(face_count, 0);
        self.faces.clear();
        for (place, (&(id, _), &(number, _))) in surface.faces().iter().zip(living).enumerate() {
            self.faces.push((id, number));
            self.places[number as usize] = index32(place);
        }
    }
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
        let mut next = 0;
        for &(id, corners) in self.surface.faces() {
            let face = match self.last.at(next) {
                Some((last, number)) if last == id => {
                    next += 1;
                    number
                }
                _ => {
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
                    next = self.last.after(face).unwrap_or(next);
                    face
                }
            };
            let corners = self.corners[face as usize];
            self.living.push((face, corners));
            self.active.extend(corners);
        }
        self.new_faces = self.faces.len() - before;
        self.last
            .follow(&self.surface, &self.living, self.faces.len());
    }
}
