//! Attempts: drawn, taken back, and drawn again.

use std::mem;

use super::caches::Cache;
use super::{SearchVertex, State, WINDOWS};
use crate::order::search::mask::Mask;

/// What undo restores besides vertices.
pub(in crate::order::search) struct Saved<M, const CACHES: usize> {
    caches: [Cache; CACHES],
    candidate_pushes: M,
    window_exits: [u32; WINDOWS],
    /// How many faces were drawn.
    pub(in crate::order::search) drawn: usize,
    /// How many dead ends there were.
    dead_ends: usize,
    waiting: u32,
    /// How many hosts there were.
    hosts: usize,
}

/// What an attempt drew, to be drawn again at once.
pub(in crate::order::search) struct Redo<M, const CACHES: usize> {
    /// The vertices that it changed, as they were after it.
    vertices: Vec<(u32, SearchVertex<CACHES>)>,
    new_to_old: Vec<u32>,
    rotations: Vec<u8>,
    dead_ends: Vec<u32>,
    hosts: Vec<u32>,
    waiting: u32,
    /// `None` before the first attempt.
    caches: Option<[Cache; CACHES]>,
    candidate_pushes: M,
    window_exits: [u32; WINDOWS],
}

impl<M: Mask, const CACHES: usize> Default for Redo<M, CACHES> {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            new_to_old: Vec::new(),
            rotations: Vec::new(),
            dead_ends: Vec::new(),
            hosts: Vec::new(),
            waiting: 0,
            caches: None,
            candidate_pushes: M::default(),
            window_exits: [0; WINDOWS],
        }
    }
}

impl<M: Mask, const CACHES: usize> State<'_, M, CACHES> {
    /// What [`undo`](Self::undo) needs to come back to this state, as often as it is asked to.
    pub(in crate::order::search) fn save(&self) -> Saved<M, CACHES> {
        Saved {
            caches: self.caches.clone(),
            candidate_pushes: self.candidate_pushes,
            window_exits: self.window_exits,
            drawn: self.new_to_old.len(),
            dead_ends: self.dead_ends.len(),
            waiting: self.waiting,
            hosts: self.hosts.len(),
        }
    }

    /// Starts an attempt: what is drawn with `UNDO` from now on can be taken back.
    pub(in crate::order::search) fn begin(&mut self) {
        debug_assert!(
            self.overwritten.is_empty(),
            "the last attempt has not ended"
        );
        if self.attempt == u32::MAX {
            // Numbers start again: no vertex may have one that comes up once more.
            self.vertices.iter_mut().for_each(|v| v.attempt = 0);
            self.attempt = 0;
        }
        self.attempt += 1;
    }

    /// Takes the attempt back, to the state at `save`.
    pub(in crate::order::search) fn undo(&mut self, saved: &Saved<M, CACHES>) {
        for (vertex, before) in self.overwritten.drain(..) {
            self.vertices[vertex as usize] = before;
        }

        for &face in &self.new_to_old[saved.drawn..] {
            self.drawn[face as usize] = false;
        }
        self.new_to_old.truncate(saved.drawn);
        self.rotations.truncate(saved.drawn);
        self.dead_ends.truncate(saved.dead_ends);
        self.waiting = saved.waiting;
        self.hosts.truncate(saved.hosts);

        self.caches.clone_from(&saved.caches);
        self.candidate_pushes = saved.candidate_pushes;
        self.window_exits = saved.window_exits;
    }

    /// Takes the attempt back, and records in `redo` what it drew.
    pub(in crate::order::search) fn undo_to_redo(
        &mut self,
        saved: &Saved<M, CACHES>,
        redo: &mut Redo<M, CACHES>,
    ) {
        // What is taken back changes places with what stood before, so that little is copied.
        for (vertex, before) in &mut self.overwritten {
            mem::swap(&mut self.vertices[*vertex as usize], before);
        }
        redo.vertices.clear();
        mem::swap(&mut self.overwritten, &mut redo.vertices);
        let caches = redo.caches.get_or_insert_with(|| saved.caches.clone());
        mem::swap(&mut self.caches, caches);

        let added = |all: &[u32], before: usize, to: &mut Vec<u32>| {
            to.clear();
            to.extend_from_slice(&all[before..]);
        };
        added(&self.new_to_old, saved.drawn, &mut redo.new_to_old);
        added(&self.dead_ends, saved.dead_ends, &mut redo.dead_ends);
        added(&self.hosts, saved.hosts, &mut redo.hosts);
        redo.rotations.clear();
        redo.rotations
            .extend_from_slice(&self.rotations[saved.drawn..]);
        redo.waiting = self.waiting;
        redo.candidate_pushes = self.candidate_pushes;
        redo.window_exits = self.window_exits;
        self.undo(saved);
    }

    /// Draws again what was recorded, in the state from which that was drawn; it stays. Nothing is recorded then.
    pub(in crate::order::search) fn redo(&mut self, redo: &mut Redo<M, CACHES>) {
        for (vertex, mut after) in redo.vertices.drain(..) {
            // Whatever attempt comes next has not saved it.
            after.attempt = 0;
            self.vertices[vertex as usize] = after;
        }
        for &face in &redo.new_to_old {
            self.drawn[face as usize] = true;
        }
        self.new_to_old.extend_from_slice(&redo.new_to_old);
        self.rotations.extend_from_slice(&redo.rotations);
        self.dead_ends.extend_from_slice(&redo.dead_ends);
        self.hosts.extend_from_slice(&redo.hosts);
        self.waiting = redo.waiting;
        if let Some(caches) = &mut redo.caches {
            mem::swap(&mut self.caches, caches);
        }
        self.candidate_pushes = redo.candidate_pushes;
        self.window_exits = redo.window_exits;
    }

    /// Ends the attempt and leaves what it drew.
    pub(in crate::order::search) fn keep(&mut self) {
        self.overwritten.clear();
    }
}
