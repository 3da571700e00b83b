//! A mesh and its removals.

use super::history::{History, HistoryBuilder, NewRecord};
use super::records::{Collapse, Records, SidePair};
use super::ring::{self, RingFace};
use crate::error::MeshError;
use crate::faces::Faces;
use crate::index::index32;

/// All resolutions of a mesh: its faces, and what each removal changes, the least noticeable first.
///
/// A *level* is a number of removals: 0 is the full mesh. A face keeps its number, and its place, as long as
/// it is there: a removal takes faces away and changes corners of others.
#[derive(Debug, Clone)]
pub struct ProgressiveMesh {
    faces: Vec<[u32; 3]>,
    vertex_count: usize,
    /// The first vertex with the same record as each.
    same_as: Vec<u32>,
    records: Records,
    stop: StopReason,
}

/// Why no more was removed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StopReason {
    /// As few faces are left as were asked for.
    Faces,
    /// The next removals would have a larger error than was allowed.
    Error,
    /// No other vertex can be removed: what is left is as coarse as its shape and topology allow.
    NothingLeft,
}

impl ProgressiveMesh {
    pub(super) fn new(
        faces: Vec<[u32; 3]>,
        same_as: Vec<u32>,
        records: Records,
        stop: StopReason,
    ) -> Self {
        Self {
            faces,
            vertex_count: same_as.len(),
            same_as,
            records,
            stop,
        }
    }

    /// Why the coarsest level is no coarser.
    #[must_use]
    pub fn stop(&self) -> StopReason {
        self.stop
    }

    /// The faces at full resolution. Where vertices have the same record, they name the first of them.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// How many vertices the full mesh has, used or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many removals there are: the number of the coarsest level.
    #[must_use]
    pub fn last_level(&self) -> usize {
        self.records.len()
    }

    /// The removal that leads from `level` to the next one.
    ///
    /// # Panics
    /// If `level` is the last one, or past it.
    #[must_use]
    pub fn collapse(&self, level: usize) -> Collapse<'_> {
        self.records.get(level)
    }

    /// How many faces a level has.
    ///
    /// # Panics
    /// If there is no such level.
    #[must_use]
    pub fn face_count(&self, level: usize) -> usize {
        assert!(level <= self.last_level(), "no level {level}");
        self.faces.len() - self.records.left_after(level)
    }

    /// The finest level of at most so many faces, or the coarsest one.
    #[must_use]
    pub fn level_of_faces(&self, most: usize) -> usize {
        self.records
            .records_for(self.faces.len().saturating_sub(most))
    }

    /// The coarsest level whose error is at most this.
    #[must_use]
    pub fn level_of_error(&self, most: f32) -> usize {
        self.records.records_within(most)
    }

    /// How far the surface of a level is from the full one, as an estimate in units of the positions.
    ///
    /// # Panics
    /// If there is no such level.
    #[must_use]
    pub fn error(&self, level: usize) -> f32 {
        level
            .checked_sub(1)
            .map_or(0.0, |last| self.collapse(last).error())
    }

    /// The vertices in the order in which they leave, up to the coarsest level.
    ///
    /// # Complexity
    /// Time O(removals).
    #[must_use]
    pub fn removal_order(&self) -> Vec<u32> {
        let collapses = (0..self.last_level()).map(|level| self.collapse(level));
        collapses
            .flat_map(|collapse| collapse.pairs().map(|pair| pair.from))
            .collect()
    }

    /// For each vertex of the full mesh, the one that stands for it at a level: itself if it is still there,
    /// nothing if it left with a whole part.
    ///
    /// # Complexity
    /// Time O(vertices + level).
    ///
    /// # Panics
    /// If there is no such level.
    #[must_use]
    pub fn fine_to_coarse(&self, level: usize) -> Vec<Option<u32>> {
        // From coarse to fine, what a vertex goes to is known before it.
        let mut coarse: Vec<Option<u32>> = (0..index32(self.vertex_count)).map(Some).collect();
        for record in (0..level).rev() {
            for pair in self.collapse(record).pairs() {
                let stays = pair.from != pair.to;
                coarse[pair.from as usize] = coarse[pair.to as usize].filter(|_| stays);
            }
        }
        let same = self.same_as.iter();
        same.map(|&first| coarse[first as usize]).collect()
    }

    /// The same removals as records that any sequence update follows: a face whose corners change leaves,
    /// and comes back with a number of its own.
    ///
    /// New faces are in the order around the removed vertex, counterclockwise as they are wound, beginning
    /// at the neighbour of lowest number; where several vertices leave together, one after the other.
    ///
    /// # Errors
    /// [`MeshError::TooLarge`] beyond (2³² − 1) / 3 faces, all that come counted.
    ///
    /// # Complexity
    /// Time O(faces + removals), about 110 bytes a removal.
    pub fn history(&self) -> Result<History, MeshError> {
        let mut builder = HistoryBuilder::new(Faces::of_checked(&self.faces, self.vertex_count));
        let mut faces = self.faces.clone();
        let mut numbers: Vec<u32> = (0..index32(faces.len())).collect();
        let mut next = index32(faces.len());
        let (mut vertices, mut into, mut ring) = (Vec::new(), Vec::new(), Vec::new());
        let (mut removed, mut inserted) = (Vec::new(), Vec::new());
        for level in 0..self.last_level() {
            let collapse = self.collapse(level);

            // Vertices that leave, and what they are merged into.
            vertices.clear();
            into.clear();
            for pair in collapse.pairs() {
                vertices.push(pair.from);
                into.extend((pair.from != pair.to).then_some(pair.to));
            }

            // Faces that leave for good.
            removed.clear();
            let leaving = collapse.leaving_faces().iter();
            removed.extend(leaving.map(|&face| numbers[face as usize]));

            // Faces that come back with another corner and number.
            inserted.clear();
            for (SidePair { to, .. }, corners) in collapse.corners() {
                ring.clear();
                ring.extend(corners.iter().map(|&corner| ring_face(&faces, corner)));
                ring::put_in_order(&mut ring);
                for &RingFace { corner, .. } in &ring {
                    let face = (corner / 3) as usize;
                    faces[face][corner as usize % 3] = to;
                    inserted.push(faces[face]);
                    removed.push(std::mem::replace(&mut numbers[face], next));
                    next += 1;
                }
            }

            let record = NewRecord {
                removed_vertices: &vertices,
                merges_into: &into,
                removed_faces: &removed,
                inserted_faces: &inserted,
                error: collapse.error(),
            };
            builder.push(&record).map_err(|_| MeshError::TooLarge {
                what: "faces",
                limit: crate::index::MAX_FACES,
                count: self.faces.len() + self.records.corner_count(),
            })?;
        }
        Ok(builder.finish())
    }
}

/// The face of a corner, seen from there.
fn ring_face(faces: &[[u32; 3]], corner: u32) -> RingFace {
    let face = faces[(corner / 3) as usize];
    let [from, to] = [1, 2].map(|turn| face[(corner as usize + turn) % 3]);
    RingFace { corner, from, to }
}
