//! Traversal state with undo: undrawn faces, and the caches being modelled.
//!
//! An attempt remembers each vertex that it changes, once; taking it back restores these and a few
//! numbers, whatever the caches did. Who is a candidate is a bit a push, so the oldest are found
//! without touching the rest.

mod caches;
mod drawing;
#[cfg(test)]
mod oracle;

use std::ops::Range;

use super::mask::Mask;
use crate::index::index32;
use crate::order::greedy::{HUB, least_neighbours};
use crate::topology::rows;
use caches::Cache;
pub(super) use caches::CacheLimits;

/// How many longer windows there are.
pub(super) const WINDOWS: usize = 3;

#[derive(Clone, Copy)]
struct SearchVertex<const CACHES: usize> {
    /// The number of its last push into each cache; 0 before the first.
    entered: [u32; CACHES],
    /// Start of its row of faces; the next vertex's start ends it.
    row: u32,
    /// Its corners in faces that are not drawn yet. 0: black.
    live: u32,
    /// The other corners of its live faces that are missing, 16 bits for each cache. Of a hub it
    /// means nothing.
    missing: u32,
    /// The attempt that last changed it.
    attempt: u32,
}

impl<const CACHES: usize> SearchVertex<CACHES> {
    /// How many neighbours are missing from a cache at least; see [`least_neighbours`].
    #[inline]
    fn missing_neighbours(&self, cache: usize) -> u32 {
        least_neighbours(self.missing >> (16 * cache) & 0xffff, self.live)
    }
}

pub(super) struct State<'a, M, const CACHES: usize> {
    faces: &'a [[u32; 3]],
    /// One more than there are, so that each row has an end.
    vertices: Vec<SearchVertex<CACHES>>,
    /// Rows of faces with their other two corners, drawn faces included.
    rows: Vec<[u32; 3]>,
    drawn: Vec<bool>,
    pub(super) caches: [Cache; CACHES],
    /// The last pushes into the first cache whose vertices are unfinished: the candidates.
    recent: M,
    /// How many of the last pushes that are.
    pub(super) window: u32,
    /// Longer windows whose exits are counted, in pushes into the first cache.
    pub(super) windows: [u32; WINDOWS],
    pub(super) window_exits: [u32; WINDOWS],
    pub(super) keep_corners: bool,
    /// Where the polygon of each face begins and ends; empty where each face is on its own.
    pub(super) polygons: &'a [[u32; 2]],
    gathered: Vec<u32>,
    /// The number of the attempt, and what it has overwritten.
    attempt: u32,
    overwritten: Vec<(u32, SearchVertex<CACHES>)>,
    pub(super) new_to_old: Vec<u32>,
    pub(super) rotations: Vec<u8>,
    /// Vertices that were candidates and are no more, though unfinished.
    pub(super) left: Vec<u32>,
}

/// What an attempt restores as a whole.
pub(super) struct Saved<M, const CACHES: usize> {
    caches: [Cache; CACHES],
    recent: M,
    window_exits: [u32; WINDOWS],
    /// How many faces were drawn.
    pub(super) drawn: usize,
    left: usize,
}

/// What is known of a candidate for the next focus.
pub(super) struct Candidate {
    pub(super) vertex: u32,
    /// Faces left.
    pub(super) live: u32,
    /// Pushes since it entered the first cache.
    pub(super) age: u32,
    /// Whether it is in the first cache.
    pub(super) is_inside: bool,
    /// How many of its neighbours are missing from the first cache at least; of its neighbours and
    /// itself from the one beside it.
    pub(super) missing: [u32; 2],
}

impl<'a, M: Mask, const CACHES: usize> State<'a, M, CACHES> {
    /// Nothing is drawn; every vertex is a candidate of no window yet.
    pub(super) fn new(
        faces: &'a [[u32; 3]],
        vertex_count: usize,
        limits: [CacheLimits; CACHES],
    ) -> Self {
        let unused = SearchVertex {
            entered: [0; CACHES],
            row: 0,
            live: 0,
            missing: 0,
            attempt: 0,
        };
        let mut vertices = vec![unused; vertex_count + 1];
        for &corner in faces.as_flattened() {
            vertices[corner as usize].live += 1;
        }
        let everywhere: u32 = (0..CACHES).map(one_in).sum();
        let mut end = 0;
        for vertex in &mut vertices {
            end += vertex.live;
            vertex.row = end;
            vertex.missing = vertex.live.wrapping_mul(2 * everywhere);
        }

        // Rows whose starts stand with their vertices: no second line of memory for a row.
        let mut entries = vec![[0; 3]; faces.len() * 3];
        let numbered = (0..index32(faces.len())).zip(faces).rev();
        let items = numbered
            .map(|(face, &[a, b, c])| [(c, [face, a, b]), (b, [face, c, a]), (a, [face, b, c])]);
        rows::place_from_behind(&mut vertices, |vertex| &mut vertex.row, items, &mut entries);
        Self {
            faces,
            vertices,
            rows: entries,
            drawn: vec![false; faces.len()],
            caches: limits.map(|limits| Cache::new(limits, index32(vertex_count))),
            recent: M::default(),
            window: limits[0].size,
            windows: [1; WINDOWS],
            window_exits: [0; WINDOWS],
            keep_corners: false,
            polygons: &[],
            gathered: vec![0; HUB as usize],
            attempt: 0,
            overwritten: Vec::new(),
            new_to_old: Vec::with_capacity(faces.len()),
            rotations: Vec::with_capacity(faces.len()),
            left: Vec::new(),
        }
    }

    /// How many faces of a vertex are left.
    #[inline]
    pub(super) fn live(&self, vertex: u32) -> u32 {
        self.vertices[vertex as usize].live
    }

    /// The first vertex with faces left, from this one on.
    pub(super) fn first_live(&self, from: u32) -> Option<u32> {
        let rest = &self.vertices[from as usize..];
        let skipped = rest.iter().position(|vertex| vertex.live != 0)?;
        Some(from + index32(skipped))
    }

    #[inline]
    fn row(&self, vertex: u32) -> Range<usize> {
        let v = vertex as usize;
        self.vertices[v].row as usize..self.vertices[v + 1].row as usize
    }

    #[inline]
    fn is_missing(&self, vertex: u32, cache: usize) -> bool {
        self.vertices[vertex as usize].entered[cache] < self.caches[cache].first
    }

    /// How many faces the last batch has, of those that end by faces or vertices.
    pub(super) fn faces_in_batch(&self) -> usize {
        let ends = |cache: &&Cache| cache.limits.batch_faces != u32::MAX;
        let batches = self.caches.iter().filter(ends);
        batches.map(|cache| cache.faces as usize).max().unwrap_or(0)
    }

    pub(super) fn has_candidates(&self) -> bool {
        self.recent != M::default()
    }

    /// Counts exits from here on.
    pub(super) fn reset_exits(&mut self) {
        for cache in &mut self.caches {
            cache.exits = 0;
        }
        self.window_exits = [0; WINDOWS];
    }

    /// What [`undo`](Self::undo) goes back to.
    pub(super) fn save(&self) -> Saved<M, CACHES> {
        Saved {
            caches: self.caches.clone(),
            recent: self.recent,
            window_exits: self.window_exits,
            drawn: self.new_to_old.len(),
            left: self.left.len(),
        }
    }

    /// Starts an attempt: what is drawn with `UNDO` from here on can be taken back.
    pub(super) fn begin(&mut self) {
        if self.attempt == u32::MAX {
            self.vertices.iter_mut().for_each(|v| v.attempt = 0);
            self.attempt = 0;
        }
        self.attempt += 1;
    }

    /// Takes the attempt back.
    pub(super) fn undo(&mut self, saved: &Saved<M, CACHES>) {
        for (vertex, before) in self.overwritten.drain(..) {
            self.vertices[vertex as usize] = before;
        }
        for &face in &self.new_to_old[saved.drawn..] {
            self.drawn[face as usize] = false;
        }
        self.new_to_old.truncate(saved.drawn);
        self.rotations.truncate(saved.drawn);
        self.left.truncate(saved.left);
        self.caches.clone_from(&saved.caches);
        self.recent = saved.recent;
        self.window_exits = saved.window_exits;
    }

    /// Leaves the attempt as it is.
    pub(super) fn keep(&mut self) {
        self.overwritten.clear();
    }

    /// How many faces there are, drawn or not.
    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The vertex, after remembering what it was before this attempt.
    #[inline]
    fn change<const UNDO: bool>(&mut self, vertex: u32) -> &mut SearchVertex<CACHES> {
        let entry = &mut self.vertices[vertex as usize];
        if UNDO && entry.attempt != self.attempt {
            self.overwritten.push((vertex, *entry));
            entry.attempt = self.attempt;
        }
        entry
    }

    /// Shows up to `most` candidates, the oldest first, with their numbers; how many.
    #[inline]
    pub(super) fn candidates(&self, most: u32, mut visit: impl FnMut(usize, Candidate)) -> u32 {
        let cache = &self.caches[0];
        let start = cache.pushes - self.window;
        let mut recent = self.recent.rotated(start);
        let count = recent.count().min(most);
        for i in 0..count as usize {
            let entered = start + recent.take_lowest();
            let vertex = cache.pushed(entered);
            let known = &self.vertices[vertex as usize];
            let mut missing = [known.missing_neighbours(0), 0];
            if CACHES > 1 {
                let last = CACHES - 1;
                let itself = u32::from(known.entered[last] < self.caches[last].first);
                missing[1] = known.missing_neighbours(1) + itself;
            }
            let candidate = Candidate {
                vertex,
                live: known.live,
                age: cache.pushes - entered,
                is_inside: entered >= cache.first,
                missing,
            };
            visit(i, candidate);
        }
        count
    }
}

/// One vertex more that is missing from a cache.
#[inline]
const fn one_in(cache: usize) -> u32 {
    1 << (16 * cache)
}
