//! A sequence of places, each with a face or free: new faces take the places of removed ones.

use std::ops::Range;

use super::updated::Sequence;
use crate::index::index32;
use crate::permutation::FaceOrder;
use crate::progressive::history::{History, Record};

/// A place without a face, a face without a place.
pub(super) const NONE: u32 = u32::MAX;

/// The places that a record frees, and the faces that had them: `faces[i]` stood at `places[i]`.
///
/// From the first place to the last.
#[derive(Debug, Clone, Default)]
pub(super) struct FreePlaces {
    pub(super) faces: Vec<u32>,
    pub(super) places: Vec<u32>,
}

/// Which free place each new face of a record takes.
pub(super) trait Rule {
    /// Gives some of the new faces a free place, each place once.
    ///
    /// `given` has a place for each new face, which is [`NONE`] so far; the first has number `first`.
    fn give(&mut self, history: &History, free: &FreePlaces, first: u32, given: &mut [u32]);
}

/// A face number for each place, and back.
///
/// A face never comes back under another number, so the place that it had when it left is still
/// known, and undoing needs no log. Places are given when a record is played for the first time, and
/// are the same ever after.
#[derive(Debug, Clone)]
pub(super) struct PlacedFaces<R> {
    rule: R,
    /// The face at each place, or [`NONE`].
    faces: Vec<u32>,
    /// The place of each face that has come so far, also when it has left.
    places: Vec<u32>,
    /// How many records have given their places.
    given_records: usize,
    /// What a record frees: kept for its memory.
    free: FreePlaces,
}

impl<R: Rule> PlacedFaces<R> {
    /// The places of an order of the full mesh.
    pub(super) fn new(history: &History, order: &FaceOrder, rule: R) -> Self {
        let mut places = Vec::with_capacity(history.number_count());
        places.extend(order.permutation().old_to_new());
        Self {
            rule,
            faces: order.new_to_old().to_vec(),
            places,
            given_records: 0,
            free: FreePlaces::default(),
        }
    }

    /// Gives the new faces of a record their places.
    fn give(&mut self, history: &History, record: &Record<'_>) {
        let FreePlaces { faces, places } = &mut self.free;
        faces.clear();
        faces.extend(record.removed_faces);
        faces.sort_unstable_by_key(|&face| self.places[face as usize]);
        places.clear();
        places.extend(faces.iter().map(|&face| self.places[face as usize]));

        let Range { start, end } = record.inserted_faces;
        self.places.resize(end as usize, NONE);
        let given = &mut self.places[start as usize..];
        self.rule.give(history, &self.free, start, given);

        // Those without a place go behind the last.
        for place in given.iter_mut().filter(|place| **place == NONE) {
            *place = index32(self.faces.len());
            self.faces.push(NONE);
        }
    }

    fn free(&mut self, face: u32) {
        self.faces[self.places[face as usize] as usize] = NONE;
    }

    fn place(&mut self, face: u32) {
        self.faces[self.places[face as usize] as usize] = face;
    }
}

impl<R: Rule> Sequence for PlacedFaces<R> {
    fn play(&mut self, history: &History, record: usize) {
        let update = history.record(record);
        if record == self.given_records {
            self.give(history, &update);
            self.given_records += 1;
        }
        update
            .removed_faces
            .iter()
            .for_each(|&face| self.free(face));
        update.inserted_faces.for_each(|face| self.place(face));
    }

    fn undo(&mut self, history: &History, record: usize) {
        let update = history.record(record);
        update.inserted_faces.for_each(|face| self.free(face));
        update
            .removed_faces
            .iter()
            .for_each(|&face| self.place(face));
    }

    fn visit(&self, visit: impl FnMut(u32)) {
        let faces = self.faces.iter().copied();
        faces.filter(|&face| face != NONE).for_each(visit);
    }
}
