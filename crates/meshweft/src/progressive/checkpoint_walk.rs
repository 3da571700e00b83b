//! A walk that takes the order of the checkpoint that it has passed last.

use super::checkpoints::Checkpoints;
use super::walk::Walk;

/// A progressive mesh at a level that changes, drawn in the order of the nearest finer checkpoint.
///
/// On the way to coarser levels it goes on with an order for 2 % of the faces beyond the next checkpoint, so
/// that a level which goes to and fro there does not change the whole sequence each time.
#[derive(Debug, Clone)]
pub struct CheckpointWalk<'a> {
    checkpoints: &'a Checkpoints<'a>,
    pub(super) walk: Walk<'a>,
    pub(super) current: usize,
}

/// The share of its faces for which a checkpoint waits.
const HYSTERESIS: usize = 50;

impl<'a> CheckpointWalk<'a> {
    /// At full resolution.
    #[must_use]
    pub fn new(checkpoints: &'a Checkpoints<'a>) -> Self {
        Self {
            checkpoints,
            walk: Walk::new(checkpoints.mesh),
            current: 0,
        }
    }

    /// The level that the faces have.
    #[must_use]
    pub fn level(&self) -> usize {
        self.walk.level()
    }

    /// The level of the checkpoint whose order is used.
    #[must_use]
    pub fn checkpoint(&self) -> usize {
        self.checkpoints.stored[self.current].level
    }

    /// Goes to a level; returns whether the faces are now drawn in the order of another checkpoint.
    ///
    /// # Complexity
    /// Time O(removals between + checkpoints); no memory.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn go_to(&mut self, level: usize) -> bool {
        self.go_to_marking(level, |_| ())
    }

    /// Goes to a level; says which faces change, come or leave.
    pub(super) fn go_to_marking(&mut self, level: usize, mark: impl FnMut(u32)) -> bool {
        self.walk.go_to_marking(level, mark);
        let next = self.checkpoint_of(level);
        std::mem::replace(&mut self.current, next) != next
    }

    /// The number of the checkpoint whose order is used at a level, coming from here.
    pub(super) fn checkpoint_of(&self, level: usize) -> usize {
        let (mesh, stored) = (self.checkpoints.mesh, &self.checkpoints.stored);
        let mut current = self.current;
        while stored[current].level > level {
            current -= 1;
        }
        let faces = mesh.face_count(level);
        while let Some(next) = stored.get(current + 1)
            && next.level <= level
        {
            let next_faces = mesh.face_count(next.level);
            let is_beyond = faces + next_faces / HYSTERESIS <= next_faces;
            if !is_beyond && level != mesh.last_level() {
                break;
            }
            current += 1;
        }
        current
    }

    /// The order of the checkpoint; nothing for the sequence of the mesh itself.
    #[inline]
    pub(super) fn order(&self) -> Option<&'a [u32]> {
        self.checkpoints.stored[self.current].order.as_deref()
    }

    /// Writes the faces of the level to `out`, in the order of drawing.
    ///
    /// # Complexity
    /// Time O(faces of the checkpoint); memory only if `out` is too small.
    pub fn emit(&self, out: &mut Vec<[u32; 3]>) {
        match self.order() {
            None => self.walk.emit(out),
            Some(order) => self.walk.emit_in(order, out),
        }
    }
}
