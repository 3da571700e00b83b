//! Which vertex has which slot.

use super::policy::SlotPolicy;
use crate::index::index32;

/// The cross index of vertices and slots, and which slots are open.
///
/// Of a slot and its vertex: *held* while the vertex is to stay there, *open* otherwise.
#[derive(Debug)]
pub(super) struct SlotTable {
    /// Of each vertex the slot that it had last.
    slot_of: Vec<u32>,
    slots: Vec<Slot>,
    /// Of each vertex the error of its level of detail.
    pub(super) errors: Vec<f32>,
    policy: Box<dyn SlotPolicy>,
    pub(super) frame: u32,
    /// How often the policy named a slot that was not open.
    pub(super) overruled: usize,
}

/// What a slot has.
#[derive(Debug, Clone, Copy)]
struct Slot {
    vertex: u32,
    is_open: bool,
}

/// Neither a slot nor a vertex.
const NONE: u32 = u32::MAX;

impl SlotTable {
    pub(super) fn new(slots: usize, errors: Vec<f32>, mut policy: Box<dyn SlotPolicy>) -> Self {
        for slot in 0..index32(slots) {
            policy.open(slot, None, 0);
        }
        Self {
            slot_of: vec![NONE; errors.len()],
            slots: vec![
                Slot {
                    vertex: NONE,
                    is_open: true,
                };
                slots
            ],
            errors,
            policy,
            frame: 0,
            overruled: 0,
        }
    }

    /// More vertices.
    pub(super) fn grow(&mut self, errors: &[f32]) {
        self.errors.extend_from_slice(errors);
        self.slot_of.resize(self.errors.len(), NONE);
    }

    pub(super) fn slots(&self) -> usize {
        self.slots.len()
    }

    pub(super) fn vertices(&self) -> usize {
        self.slot_of.len()
    }

    /// The slot of a vertex, if it is resident: both sides of the cross index agree.
    #[inline]
    pub(super) fn slot(&self, vertex: u32) -> Option<u32> {
        let slot = *self.slot_of.get(vertex as usize)?;
        let is_there = |found: &Slot| found.vertex == vertex;
        self.slots
            .get(slot as usize)
            .is_some_and(is_there)
            .then_some(slot)
    }

    /// The slot of a vertex, if it is held.
    #[inline]
    pub(super) fn held_slot(&self, vertex: u32) -> Option<u32> {
        let slot = self.slot(vertex)?;
        (!self.slots[slot as usize].is_open).then_some(slot)
    }

    pub(super) fn vertex(&self, slot: u32) -> Option<u32> {
        let vertex = self.slots.get(slot as usize)?.vertex;
        (vertex != NONE).then_some(vertex)
    }

    /// Holds the slot of a vertex; false if it is not resident.
    #[inline]
    pub(super) fn hold(&mut self, vertex: u32) -> bool {
        let Some(slot) = self.slot(vertex) else {
            return false;
        };
        if std::mem::take(&mut self.slots[slot as usize].is_open) {
            self.policy.close(slot);
        }
        true
    }

    /// Opens the slot of a vertex, if it is held.
    #[inline]
    pub(super) fn release(&mut self, vertex: u32) {
        if let Some(slot) = self.held_slot(vertex) {
            self.slots[slot as usize].is_open = true;
            let error = self.errors[vertex as usize];
            self.policy.open(slot, Some(error), self.frame);
        }
    }

    /// Gives a vertex that is not resident an open slot and holds it. There must be one.
    #[inline]
    pub(super) fn insert(&mut self, vertex: u32) -> u32 {
        let chosen = self.policy.take(self.frame);
        let is_open = |slot: &u32| {
            self.slots
                .get(*slot as usize)
                .is_some_and(|slot| slot.is_open)
        };
        let slot = match chosen.filter(is_open) {
            Some(slot) => slot,
            None => self.overrule(),
        };
        self.slots[slot as usize] = Slot {
            vertex,
            is_open: false,
        };
        self.slot_of[vertex as usize] = slot;
        slot
    }

    /// The first open slot, where the policy named none.
    #[cold]
    fn overrule(&mut self) -> u32 {
        self.overruled += 1;
        let first = self.slots.iter().position(|slot| slot.is_open);
        let slot = index32(
            first.expect("a slot is open while fewer vertices are held than there are slots"),
        );
        self.policy.close(slot);
        slot
    }
}
