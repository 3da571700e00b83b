//! One update record, as it is read and as it is given.

use std::ops::Range;

/// An update record of a [`History`](super::History): what leaves, and what comes in its place.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Record<'a> {
    /// The vertices that leave: one; several where a point has several vertices, on a seam; all of a
    /// part that leaves as a whole.
    pub removed_vertices: &'a [u32],
    /// The vertex that each removed one is merged into, in the same order; empty where the record
    /// does not say.
    pub merges_into: &'a [u32],
    /// Numbers of the faces that leave.
    pub removed_faces: &'a [u32],
    /// Numbers of the faces that come; their corners by [`History::face`](super::History::face).
    pub inserted_faces: Range<u32>,
    /// How far the mesh is from the full one once the record is played, in units of the positions; 0
    /// where that is not known.
    pub error: f32,
}

/// An update record to be added to a history, by [`HistoryBuilder::push`](super::HistoryBuilder::push).
///
/// The default removes and inserts nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NewRecord<'a> {
    /// The vertices that leave. No face may use them afterwards, and none may come back.
    pub removed_vertices: &'a [u32],
    /// The vertex that each removed one is merged into, in the same order, or nothing.
    pub merges_into: &'a [u32],
    /// Numbers of the faces that leave, each of them present.
    pub removed_faces: &'a [u32],
    /// Corners of the faces that come. They get the next free numbers, in this order.
    pub inserted_faces: &'a [[u32; 3]],
    /// How far the mesh is from the full one once the record is played, in units of the positions; 0
    /// where that is not known.
    pub error: f32,
}
