//! What is found for one mesh.

use std::borrow::Cow;

use super::counts::Counts;
use crate::faces::Faces;
use crate::files::MeshEntry;
use crate::permutation::FaceOrder;

/// What is to be done to the faces of a mesh.
pub(super) struct FaceChange {
    pub(super) order: FaceOrder,
    /// Why an order that was found is not taken.
    pub(super) reason: Option<&'static str>,
    /// Pushes of the schedule that came with the order, for a controllable cache.
    pub(super) scheduled: Option<u64>,
}

impl FaceChange {
    /// Nothing moves, and why.
    pub(super) fn none(entry: &MeshEntry, reason: Option<&'static str>) -> Self {
        Self {
            order: FaceOrder::identity(entry.record_count()),
            reason,
            scheduled: None,
        }
    }
}

/// A mesh in its better order.
pub(super) struct Improved<'a> {
    pub(super) faces: Cow<'a, [[u32; 3]]>,
    /// Not yet with what is fetched.
    pub(super) counts: Counts,
}

impl Improved<'_> {
    /// Gives the vertices their new numbers.
    pub(super) fn renumber(&mut self, old_to_new: &[u32]) {
        for face in self.faces.to_mut() {
            *face = face.map(|vertex| old_to_new[vertex as usize]);
        }
    }

    /// The counts, with what is fetched where anything moved.
    pub(super) fn into_counts(mut self) -> Counts {
        if let Cow::Owned(faces) = &self.faces {
            let faces = Faces::of_checked(faces, self.counts.vertices);
            self.counts.count_fetched(faces);
        }
        self.counts
    }
}
