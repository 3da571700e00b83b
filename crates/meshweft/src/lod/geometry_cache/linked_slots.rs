//! Lists of slots, linked by number.

use crate::index::index32;

/// Some lists of slots, each slot in at most one of them: two numbers a slot and a list.
#[derive(Debug, Clone)]
pub(super) struct LinkedSlots {
    /// The next and the one before, in rings: after the slots come the lists, each the start and the end of its own.
    links: Vec<[u32; 2]>,
    slots: u32,
}

impl LinkedSlots {
    pub(super) fn new(slots: usize, lists: usize) -> Self {
        let ring = |place| [index32(place); 2];
        Self {
            links: (0..slots + lists).map(ring).collect(),
            slots: index32(slots),
        }
    }

    /// The first slot of a list.
    #[inline]
    pub(super) fn first(&self, list: usize) -> Option<u32> {
        let [first, _] = self.links[self.slots as usize + list];
        (first < self.slots).then_some(first)
    }

    /// Puts a slot that is in no list at the end of one.
    #[inline]
    pub(super) fn push(&mut self, list: usize, slot: u32) {
        let end = self.slots + index32(list);
        let [_, last] = self.links[end as usize];
        self.links[slot as usize] = [end, last];
        self.links[last as usize][0] = slot;
        self.links[end as usize][1] = slot;
    }

    /// Takes a slot out of its list.
    #[inline]
    pub(super) fn remove(&mut self, slot: u32) {
        let [next, previous] = self.links[slot as usize];
        self.links[previous as usize][0] = next;
        self.links[next as usize][1] = previous;
        self.links[slot as usize] = [slot; 2];
    }
}
