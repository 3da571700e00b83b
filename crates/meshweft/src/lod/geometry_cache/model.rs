//! The cache by definition: naive lists, and every choice by looking at all open slots.

use super::eviction::EvictionPolicy;
use super::upload::Insert;

pub(super) struct Model {
    eviction: EvictionPolicy,
    slots: Vec<ModelSlot>,
    errors: Vec<f32>,
    pub(super) active: Vec<u32>,
    frame: u32,
    /// How often a slot was opened.
    openings: usize,
    /// Whether all active vertices were in slots.
    is_complete: bool,
}

#[derive(Clone, Default)]
struct ModelSlot {
    vertex: Option<u32>,
    is_held: bool,
    /// In which frame, and as the how manyth of all, it was opened.
    opened: (u32, usize),
}

impl Model {
    pub(super) fn new(slots: usize, errors: &[f32], eviction: EvictionPolicy) -> Self {
        let empty = |i| ModelSlot {
            opened: (0, i),
            ..ModelSlot::default()
        };
        Self {
            eviction,
            slots: (0..slots).map(empty).collect(),
            errors: errors.to_vec(),
            active: Vec::new(),
            frame: 0,
            openings: slots,
            is_complete: true,
        }
    }

    /// The inserts of the next frame, by rising slots, after what is removed and added in turn. More active vertices
    /// than slots are streamed. An implicit front has an order in each frame.
    pub(super) fn frame(
        &mut self,
        added: &[u32],
        removed: &[u32],
        order: Option<&[u32]>,
    ) -> Vec<Insert> {
        self.frame += 1;
        for &vertex in removed {
            if let Some(place) = self.active.iter().position(|&active| active == vertex) {
                self.active.swap_remove(place);
                if let Some(slot) = self.slot_of(vertex).filter(|_| self.caches()) {
                    self.slots[slot].is_held = false;
                    self.slots[slot].opened = (self.frame, self.openings);
                    self.openings += 1;
                }
            }
        }
        let mut missing = Vec::new();
        for &vertex in added {
            if !self.active.contains(&vertex) {
                self.active.push(vertex);
                missing.push(vertex);
            }
        }
        if let Some(order) = order {
            self.active = order.to_vec();
        }
        if !self.is_complete {
            missing.clone_from(&self.active);
        }

        self.is_complete = self.caches() && self.active.len() <= self.slots.len();
        missing.retain(|&vertex| match self.slot_of(vertex) {
            Some(slot) => {
                self.slots[slot].is_held = true;
                false
            }
            None => true,
        });
        let mut inserts: Vec<Insert> = match self.is_complete {
            true => missing.iter().map(|&vertex| self.insert(vertex)).collect(),
            false => {
                let places = (0..).zip(&self.active);
                places
                    .map(|(slot, &vertex)| Insert { slot, vertex })
                    .collect()
            }
        };
        inserts.sort_unstable();
        inserts
    }

    fn caches(&self) -> bool {
        self.eviction != EvictionPolicy::Nothing
    }

    fn slot_of(&self, vertex: u32) -> Option<usize> {
        let is_there = |slot: &ModelSlot| slot.vertex == Some(vertex);
        self.slots.iter().position(is_there)
    }

    fn insert(&mut self, vertex: u32) -> Insert {
        let slot = self.choice();
        self.slots[slot].vertex = Some(vertex);
        self.slots[slot].is_held = true;
        let slot = u32::try_from(slot).unwrap();
        Insert { slot, vertex }
    }

    fn choice(&self) -> usize {
        let mut open: Vec<usize> = (0..self.slots.len()).collect();
        open.retain(|&slot| !self.slots[slot].is_held);
        let order = |slot: &usize| self.slots[*slot].opened.1;
        let is_empty = |slot: &usize| self.slots[*slot].vertex.is_none();
        let error = |slot: usize| match self.slots[slot].vertex {
            Some(vertex) => self.errors[vertex as usize],
            None => -1.0,
        };
        match self.eviction {
            EvictionPolicy::Nothing | EvictionPolicy::OldestFirst => {
                open.into_iter().min_by_key(order)
            }
            EvictionPolicy::FirstAvailable => {
                let is_old =
                    |slot: &&usize| is_empty(slot) || self.slots[**slot].opened.0 < self.frame;
                let old = open.iter().find(is_old);
                old.or(open.first()).copied()
            }
            EvictionPolicy::FinestFirst => open
                .into_iter()
                .min_by_key(|&slot| (quarter_octave(error(slot)), order(&slot))),
            EvictionPolicy::QueuedByError { percent, age } => {
                open.sort_by_key(order);
                let size = self.slots.len() * percent as usize / 100;
                let is_old =
                    |slot: &usize| is_empty(slot) || self.frame - self.slots[*slot].opened.0 >= age;
                let queue = open.iter().copied().take(size.max(1)).take_while(is_old);
                let finest = queue.min_by(|&a, &b| error(a).total_cmp(&error(b)).then(a.cmp(&b)));
                finest.or(open.first().copied())
            }
        }
        .unwrap()
    }
}

/// Which quarter of which octave, counted from far below; below all for an empty slot.
fn quarter_octave(error: f32) -> i32 {
    if error <= 0.0 {
        return if error < 0.0 { i32::MIN } else { i32::MIN + 1 };
    }
    let octave = (-100..100)
        .find(|&k| f64::from(error) < 2_f64.powi(k + 1))
        .unwrap();
    let quarters = (f64::from(error) / 2_f64.powi(octave) - 1.0) * 4.0;
    4 * octave + (0..4).rfind(|&i| f64::from(i) <= quarters).unwrap()
}
