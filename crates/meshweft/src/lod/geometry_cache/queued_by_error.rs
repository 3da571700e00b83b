//! The slot with the finest detail of the oldest ones.

use super::linked_slots::LinkedSlots;
use super::policy::SlotPolicy;
use crate::index::index32;

/// The paper's LRU with a priority queue by error for the oldest open slots.
#[derive(Debug)]
pub(super) struct QueuedByError {
    /// Open slots that are not in the queue, the oldest first.
    young: LinkedSlots,
    queue: SlotHeap,
    /// Of each open slot: the frame since which it is.
    since: Vec<u32>,
    /// How many slots the queue has at most.
    size: usize,
    /// For how many frames a slot must be open to be queued.
    age: u32,
}

impl QueuedByError {
    pub(super) fn new(slots: usize, percent: u32, age: u32) -> Self {
        let size = slots as u64 * u64::from(percent.min(100)) / 100;
        let size = usize::try_from(size).unwrap_or(slots).max(1);
        Self {
            young: LinkedSlots::new(slots, 1),
            queue: SlotHeap::new(slots, size),
            since: vec![0; slots],
            size,
            age,
        }
    }

    /// Moves the oldest slots to the queue while it has room.
    fn fill_queue(&mut self, frame: u32) {
        while self.queue.heap.len() < self.size
            && let Some(slot) = self.young.first(0)
        {
            let age = frame.wrapping_sub(self.since[slot as usize]);
            if age < self.age && self.queue.keys[slot as usize] != EMPTY {
                break;
            }
            self.young.remove(slot);
            self.queue.insert(slot);
        }
    }
}

impl SlotPolicy for QueuedByError {
    fn open(&mut self, slot: u32, error: Option<f32>, frame: u32) {
        // Floats that are not negative are in the order of their bits.
        self.queue.keys[slot as usize] = error.map_or(EMPTY, |error| 1 + error.abs().to_bits());
        self.since[slot as usize] = frame;
        self.young.push(0, slot);
    }

    fn close(&mut self, slot: u32) {
        if !self.queue.remove(slot) {
            self.young.remove(slot);
        }
    }

    fn take(&mut self, frame: u32) -> Option<u32> {
        self.fill_queue(frame);
        let slot = self.queue.first().or_else(|| self.young.first(0))?;
        self.close(slot);
        Some(slot)
    }
}

/// The key of a slot that has no vertex: below all others, and old enough from the start.
const EMPTY: u32 = 0;

/// Slots by key, the least first; of equal keys the slot of the lower number. Any slot may leave.
#[derive(Debug)]
struct SlotHeap {
    heap: Vec<u32>,
    keys: Vec<u32>,
    /// Where each slot is in the heap, if it is there.
    places: Vec<u32>,
}

impl SlotHeap {
    fn new(slots: usize, size: usize) -> Self {
        Self {
            heap: Vec::with_capacity(size),
            keys: vec![0; slots],
            places: vec![u32::MAX; slots],
        }
    }

    fn first(&self) -> Option<u32> {
        self.heap.first().copied()
    }

    fn insert(&mut self, slot: u32) {
        self.heap.push(slot);
        self.rise(self.heap.len() - 1);
    }

    /// False if the slot is not in the heap.
    fn remove(&mut self, slot: u32) -> bool {
        let place = self.places[slot as usize] as usize;
        if self.heap.get(place) != Some(&slot) {
            return false;
        }
        self.heap.swap_remove(place);
        if place < self.heap.len() {
            let place = self.rise(place);
            self.sink(place);
        }
        true
    }

    fn rank(&self, place: usize) -> (u32, u32) {
        let slot = self.heap[place];
        (self.keys[slot as usize], slot)
    }

    fn put(&mut self, place: usize) {
        self.places[self.heap[place] as usize] = index32(place);
    }

    fn rise(&mut self, mut place: usize) -> usize {
        while place > 0 && self.rank(place) < self.rank((place - 1) / 2) {
            self.heap.swap(place, (place - 1) / 2);
            self.put(place);
            place = (place - 1) / 2;
        }
        self.put(place);
        place
    }

    fn sink(&mut self, mut place: usize) {
        loop {
            let below = (2 * place + 1..2 * place + 3).filter(|&below| below < self.heap.len());
            let Some(least) = below.min_by_key(|&below| self.rank(below)) else {
                break;
            };
            if self.rank(place) < self.rank(least) {
                break;
            }
            self.heap.swap(place, least);
            self.put(place);
            place = least;
        }
        self.put(place);
    }
}
