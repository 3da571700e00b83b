//! The simple update: free places are filled one after the other.

use super::places::{FreePlaces, PlacedFaces, Rule};
use super::updated::{Updated, update_methods};
use crate::error::MeshError;
use crate::permutation::FaceOrder;
use crate::progressive::history::History;

/// A rendering sequence kept up by the simple update (Bogomjakov & Gotsman 2002): the new faces of a
/// record take the places of the removed ones, from the front, in the order of the record.
///
/// ```
/// use meshweft::FaceOrder;
/// use meshweft::progressive::{HistoryBuilder, NewRecord, SimpleUpdate};
/// let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 3, 5]];
/// let mut builder = HistoryBuilder::new(&faces);
/// builder.push(&NewRecord {
///     removed_vertices: &[4],
///     removed_faces: &[0, 1, 2, 3],
///     inserted_faces: &[[0, 1, 2], [0, 2, 3]],
///     ..NewRecord::default()
/// })?;
/// let history = builder.finish();
/// let mut sequence = SimpleUpdate::new(&history, &FaceOrder::identity(5))?;
/// let mut numbers = Vec::new();
/// sequence.go_to(1);
/// sequence.emit(&mut numbers);
/// assert_eq!(numbers, [5, 6, 4]);
/// sequence.refine();
/// sequence.emit(&mut numbers);
/// assert_eq!(numbers, [0, 1, 2, 3, 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Complexity
/// A record of n faces takes O(n · log n) the first time, then O(n); giving out the sequence takes
/// O(faces of the full mesh). Space 4 bytes a face number and 4 a face of the full mesh.
#[derive(Debug, Clone)]
pub struct SimpleUpdate<'a> {
    updated: Updated<'a, PlacedFaces<FromTheFront>>,
}

impl<'a> SimpleUpdate<'a> {
    /// The sequence at full resolution: the faces in this order.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the order is not as long as the full mesh has faces.
    pub fn new(history: &'a History, order: &FaceOrder) -> Result<Self, MeshError> {
        let start = || Ok(PlacedFaces::new(history, order, FromTheFront));
        let updated = Updated::new(history, order, start)?;
        Ok(Self { updated })
    }
}

update_methods!(SimpleUpdate);

/// Fills the free places from the front.
#[derive(Debug, Clone)]
pub(super) struct FromTheFront;

impl Rule for FromTheFront {
    fn give(&mut self, _: &History, free: &FreePlaces, _: u32, given: &mut [u32]) {
        for (given, &place) in given.iter_mut().zip(&free.places) {
            *given = place;
        }
    }
}
