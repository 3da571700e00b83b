//! What all updates share: going from level to level, and giving out the sequence.

use crate::error::MeshError;
use crate::faces::turned;
use crate::permutation::FaceOrder;
use crate::progressive::history::History;

/// A rendering sequence that records change.
pub(super) trait Sequence {
    /// Plays a record: from level `record` to the next coarser one.
    fn play(&mut self, history: &History, record: usize);

    /// Undoes a record: from the level after `record` back to `record`.
    fn undo(&mut self, history: &History, record: usize);

    /// The numbers of the faces, in the order of drawing.
    fn visit(&self, visit: impl FnMut(u32));
}

/// A sequence, its history, and where in it the sequence is.
#[derive(Debug, Clone)]
pub(super) struct Updated<'a, S> {
    pub(super) history: &'a History,
    /// How far the corners of each face of the full mesh are turned; empty if none are.
    rotations: Vec<u8>,
    pub(super) level: usize,
    sequence: S,
}

impl<'a, S: Sequence> Updated<'a, S> {
    pub(super) fn new(
        history: &'a History,
        order: &FaceOrder,
        start: impl FnOnce() -> Result<S, MeshError>,
    ) -> Result<Self, MeshError> {
        let expected = history.full_faces().len();
        if order.len() != expected {
            return Err(MeshError::LengthMismatch {
                what: "face order of the full mesh",
                expected,
                found: order.len(),
            });
        }

        let mut rotations = vec![0; order.rotations().len()];
        for (&face, &rotation) in order.new_to_old().iter().zip(order.rotations()) {
            rotations[face as usize] = rotation;
        }
        Ok(Self {
            history,
            rotations,
            level: 0,
            sequence: start()?,
        })
    }

    pub(super) fn coarsen(&mut self) -> bool {
        let is_finer = self.level < self.history.len();
        if is_finer {
            self.sequence.play(self.history, self.level);
            self.level += 1;
        }
        is_finer
    }

    pub(super) fn refine(&mut self) -> bool {
        let is_coarser = self.level > 0;
        if is_coarser {
            self.level -= 1;
            self.sequence.undo(self.history, self.level);
        }
        is_coarser
    }

    pub(super) fn go_to(&mut self, level: usize) {
        let coarsest = self.history.len();
        assert!(
            level <= coarsest,
            "level {level} of a history of {coarsest} records"
        );
        while self.level < level {
            self.coarsen();
        }
        while self.level > level {
            self.refine();
        }
    }

    pub(super) fn emit(&self, numbers: &mut Vec<u32>) {
        numbers.clear();
        self.sequence.visit(|face| numbers.push(face));
    }

    pub(super) fn emit_faces(&self, faces: &mut Vec<[u32; 3]>) {
        faces.clear();
        self.sequence.visit(|face| {
            let rotation = self.rotations.get(face as usize).copied().unwrap_or(0);
            faces.push(turned(self.history.face(face), rotation));
        });
    }
}

/// The public methods of an update, which has its `Updated` in a field `updated`.
macro_rules! update_methods {
    ($update:ident) => {
        impl $update<'_> {
            /// The level of the sequence: how many records are played.
            #[must_use]
            pub fn level(&self) -> usize {
                self.updated.level
            }

            /// Plays the next record, to the next coarser level; false at the coarsest.
            pub fn coarsen(&mut self) -> bool {
                self.updated.coarsen()
            }

            /// Undoes the last record, to the next finer level; false at full resolution.
            pub fn refine(&mut self) -> bool {
                self.updated.refine()
            }

            /// Plays or undoes the records up to a level.
            ///
            /// # Panics
            /// If the history has no such level.
            pub fn go_to(&mut self, level: usize) {
                self.updated.go_to(level);
            }

            /// The numbers of the level's faces, in the order of drawing, in place of what `numbers`
            /// had.
            pub fn emit(&self, numbers: &mut Vec<u32>) {
                self.updated.emit(numbers);
            }

            /// The corners of the level's faces, in the order of drawing, in place of what `faces`
            /// had. Faces of the full mesh are turned as the starting order turns them.
            pub fn emit_faces(&self, faces: &mut Vec<[u32; 3]>) {
                self.updated.emit_faces(faces);
            }
        }
    };
}
pub(super) use update_methods;
