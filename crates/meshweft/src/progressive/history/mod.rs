//! Histories: a mesh at full resolution and its update records, fine to coarse, made by any
//! simplifier.
//!
//! A face has one number for ever. Those of the full mesh come first, in their order; each inserted
//! face gets the next number, record by record. So a record is a few numbers, it can be read in
//! both directions, and nothing has to be searched.
//!
//! [`HistoryBuilder`] checks each record as it is added: faces that leave are there, vertices that
//! leave are used by no face afterwards, new faces use vertices that are there. Beyond that a record
//! may do anything: remove several vertices or none, leave a hole, insert more faces than it removes.
//! With the feature `files`, histories are read and written as JSON, a line a record.

mod builder;
mod error;
#[cfg(feature = "files")]
mod json_lines;
#[cfg(feature = "files")]
mod read_error;
mod record;
#[cfg(test)]
mod tests;

pub use builder::HistoryBuilder;
pub use error::{HistoryError, HistoryErrorKind};
#[cfg(feature = "files")]
pub use read_error::{ReadHistoryError, ReadHistoryErrorKind};
pub use record::{NewRecord, Record};

use crate::faces::Faces;
use crate::index::index32;
use crate::topology::rows::Rows;

/// In `merges_into`: the record does not say.
const UNKNOWN: u32 = u32::MAX;

/// A mesh at full resolution and its update records, fine to coarse.
///
/// Levels are counted by the records that are played: 0 is full resolution, [`len`](Self::len) the
/// coarsest. It takes 16 bytes a record, 4 for each vertex and face that leaves, 12 a face number:
/// about 45 bytes a record beside the faces.
///
/// ```
/// use meshweft::progressive::{HistoryBuilder, NewRecord};
/// // A square around vertex 4, which leaves: four faces become two.
/// let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
/// let mut builder = HistoryBuilder::new(&faces);
/// builder.push(&NewRecord {
///     removed_vertices: &[4],
///     removed_faces: &[0, 1, 2, 3],
///     inserted_faces: &[[0, 1, 2], [0, 2, 3]],
///     ..NewRecord::default()
/// })?;
/// let history = builder.finish();
/// assert_eq!(history.faces_at(1), [4, 5]);
/// assert_eq!(history.face(5), [0, 2, 3]);
/// # Ok::<(), meshweft::progressive::history::HistoryError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    vertex_count: usize,
    full_face_count: usize,
    /// Corners by face number.
    faces: Vec<[u32; 3]>,
    /// A row a record.
    removed_vertices: Rows<u32>,
    /// Beside the entries of `removed_vertices`, or empty if no record says it.
    merges_into: Vec<u32>,
    /// A row a record.
    removed_faces: Rows<u32>,
    /// The first face number of each record, and the number after the last.
    inserted_starts: Vec<u32>,
    /// One a record.
    errors: Vec<f32>,
}

impl History {
    /// How many records there are: the coarsest level.
    #[must_use]
    pub fn len(&self) -> usize {
        self.errors.len()
    }

    /// Whether there is no record.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// How many vertices the full mesh has, used or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The faces of the full mesh, those with the numbers from 0.
    #[must_use]
    pub fn full_faces(&self) -> Faces<'_> {
        Faces::of_checked(&self.faces[..self.full_face_count], self.vertex_count)
    }

    /// How many face numbers there are: faces of the full mesh and all that are inserted.
    #[must_use]
    pub fn number_count(&self) -> usize {
        self.faces.len()
    }

    /// The corners of the face with this number.
    ///
    /// # Panics
    /// If there is no such number.
    #[must_use]
    #[inline]
    pub fn face(&self, number: u32) -> [u32; 3] {
        self.faces[number as usize]
    }

    /// The record that leads from level `number` to the next coarser one.
    ///
    /// # Panics
    /// If there is no such record.
    #[must_use]
    #[inline]
    pub fn record(&self, number: usize) -> Record<'_> {
        let row = index32(number);
        let removed_vertices = self.removed_vertices.row(row);
        let first = self.removed_vertices.start(number);
        let merged = self.merges_into.get(first..first + removed_vertices.len());
        let says = |merged: &&[u32]| merged.first() != Some(&UNKNOWN);
        Record {
            removed_vertices,
            merges_into: merged.filter(says).unwrap_or_default(),
            removed_faces: self.removed_faces.row(row),
            inserted_faces: self.inserted_starts[number]..self.inserted_starts[number + 1],
            error: self.errors[number],
        }
    }

    /// All records, fine to coarse; reversed, coarse to fine.
    pub fn records(&self) -> impl DoubleEndedIterator<Item = Record<'_>> + ExactSizeIterator {
        (0..self.len()).map(|number| self.record(number))
    }

    /// How many faces a level has.
    ///
    /// # Panics
    /// If there is no such level.
    #[must_use]
    pub fn face_count(&self, level: usize) -> usize {
        self.inserted_starts[level] as usize - self.removed_faces.start(level)
    }

    /// How many vertices have not left at a level, used or not.
    ///
    /// # Panics
    /// If there is no such level.
    #[must_use]
    pub fn vertex_count_at(&self, level: usize) -> usize {
        self.vertex_count - self.removed_vertices.start(level)
    }

    /// The faces of a level: their numbers, rising.
    ///
    /// # Panics
    /// If there is no such level.
    ///
    /// # Complexity
    /// Time O(face numbers), space 1 byte a number beside the result.
    #[must_use]
    pub fn faces_at(&self, level: usize) -> Vec<u32> {
        let numbers = self.inserted_starts[level] as usize;
        let mut is_present = vec![true; numbers];
        for record in 0..level {
            for &face in self.removed_faces.row(index32(record)) {
                is_present[face as usize] = false;
            }
        }
        let present = |&face: &u32| is_present[face as usize];
        (0..index32(numbers)).filter(present).collect()
    }

    /// The vertices that leave, in the order in which they do.
    #[must_use]
    pub fn removal_order(&self) -> &[u32] {
        self.removed_vertices.entries()
    }

    /// For each vertex of the full mesh the one that it is merged into at a level: itself if it is
    /// there, nothing if a record on the way does not say.
    ///
    /// # Panics
    /// If there is no such level.
    ///
    /// # Complexity
    /// Time O(vertices).
    #[must_use]
    pub fn fine_to_coarse(&self, level: usize) -> Vec<Option<u32>> {
        let mut coarse: Vec<Option<u32>> = (0..index32(self.vertex_count)).map(Some).collect();

        // From coarse to fine, what a vertex is merged into is known before it.
        for number in (0..level).rev() {
            let record = self.record(number);
            for (at, &vertex) in record.removed_vertices.iter().enumerate() {
                let into = record.merges_into.get(at);
                coarse[vertex as usize] = into.and_then(|&into| coarse[into as usize]);
            }
        }
        coarse
    }

    /// The finest level of at most `face_count` faces; nothing if no level has so few.
    ///
    /// # Complexity
    /// Time O(records).
    #[must_use]
    pub fn level_of_faces(&self, face_count: usize) -> Option<usize> {
        (0..=self.len()).find(|&level| self.face_count(level) <= face_count)
    }

    /// The coarsest level up to which no record has a greater error.
    ///
    /// # Complexity
    /// Time O(records).
    #[must_use]
    pub fn level_of_error(&self, error: f32) -> usize {
        let first = self.errors.iter().position(|&found| found > error);
        first.unwrap_or(self.len())
    }
}
