//! The faces that are not drawn yet, their scores, and where they stand in the rows of their vertices.

use super::scores::{SCORES_OUTSIDE, ScoresAtPlace};
use crate::faces::Faces;
use crate::index::index32;
use crate::topology::rows;

/// A vertex that is no hub.
const NO_HUB: u32 = u32::MAX;

/// The score of a face that is drawn: less than any sum of scores of vertices.
const DRAWN: f32 = f32::NEG_INFINITY;

/// What a step needs to know of a vertex, in one place in memory.
#[derive(Clone, Copy)]
pub(super) struct ScoredVertex {
    /// Where its row starts in [`OpenFaces::rows`].
    pub(super) start: u32,
    /// How many faces its row has, one that names it twice counted twice. The places behind them are of faces
    /// that are drawn.
    pub(super) live: u32,
    /// What its faces have of it in their scores.
    pub(super) score: f32,
    /// Its number among the hubs, or [`NO_HUB`].
    pub(super) hub: u32,
}

impl ScoredVertex {
    #[inline]
    pub(super) fn is_hub(&self) -> bool {
        self.hub != NO_HUB
    }

    /// Scores the vertex for its place; returns by how much the score changed.
    #[inline]
    pub(super) fn set_score(&mut self, at_place: &ScoresAtPlace) -> f32 {
        let before = self.score;
        self.score = at_place.of(self.live);
        self.score - before
    }

    /// The row of the vertex.
    #[inline]
    pub(super) fn row<'a>(&self, rows: &'a [u32]) -> &'a [u32] {
        &rows[self.start as usize..][..self.live as usize]
    }
}

/// The state of the traversal, apart from its list.
pub(super) struct OpenFaces<'a> {
    pub(super) corners: &'a [[u32; 3]],
    pub(super) vertices: Vec<ScoredVertex>,
    /// The faces of each vertex, by number.
    pub(super) rows: Vec<u32>,
    /// The score of each face; around hubs it may stand elsewhere.
    pub(super) scores: Vec<f32>,
}

impl<'a> OpenFaces<'a> {
    /// No face is drawn, no vertex in the list, and none is a hub.
    pub(super) fn new(faces: Faces<'a>) -> Self {
        let (corners, vertex_count) = (faces.as_slice(), faces.vertex_count());

        // Count the faces of each vertex.
        let unused = ScoredVertex {
            start: 0,
            live: 0,
            score: 0.0,
            hub: NO_HUB,
        };
        let mut vertices = vec![unused; vertex_count];
        for &vertex in corners.as_flattened() {
            vertices[vertex as usize].live += 1;
        }

        // From the counts follow the scores, and where each row ends.
        let mut end = 0;
        for vertex in &mut vertices {
            end += vertex.live;
            vertex.start = end;
            vertex.set_score(SCORES_OUTSIDE);
        }

        // Fill the rows from the end, which moves each start to where it belongs.
        let mut entries = vec![0; corners.len() * 3];
        let numbered = (0..index32(corners.len())).zip(corners).rev();
        let items = numbered.map(|(face, corners)| corners.map(|corner| (corner, face)));
        rows::place_backwards(
            &mut vertices,
            |vertex| &mut vertex.start,
            items,
            &mut entries,
        );

        let score_of = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|vertex| vertices[vertex as usize].score);
            a + b + c
        };
        let scores = corners.iter().map(score_of).collect();
        Self {
            corners,
            vertices,
            rows: entries,
            scores,
        }
    }

    /// Makes these vertices the hubs.
    pub(super) fn number_hubs(&mut self, hubs: &[u32]) {
        for vertex in &mut self.vertices {
            vertex.hub = NO_HUB;
        }
        for (number, &vertex) in (0..).zip(hubs) {
            self.vertices[vertex as usize].hub = number;
        }
    }

    #[inline]
    pub(super) fn is_drawn(&self, face: u32) -> bool {
        self.scores[face as usize] == DRAWN
    }

    /// Takes a face out of the rows of its vertices, but those of hubs.
    #[inline]
    pub(super) fn draw(&mut self, face: u32) {
        self.scores[face as usize] = DRAWN;
        for corner in self.corners[face as usize] {
            let vertex = &mut self.vertices[corner as usize];
            if vertex.is_hub() {
                continue;
            }
            let row = &mut self.rows[vertex.start as usize..][..vertex.live as usize];
            // It is in the row once for each corner that names the vertex.
            if let Some(at) = row.iter().position(|&other| other == face) {
                row[at] = row[row.len() - 1];
                vertex.live -= 1;
            }
        }
    }
}
