//! Traversal state with undo: undrawn faces, and the caches being modelled.
//!
//! An *attempt* is what is drawn with `UNDO` between [`State::begin`] and [`State::undo`],
//! [`State::undo_to_redo`] or [`State::keep`]. It saves each vertex before first changing it; taking it back restores
//! these vertices, the caches and a few numbers, whatever the caches did.
//!
//! *Candidates* for the next focus are the unfinished vertices of the last pushes, as a bit set of
//! the numbers of these pushes: the oldest are found without touching the others.
//!
//! Read `caches` for what is modelled, `drawing` for what a face changes, `attempts` for undo and redo. `oracle` compares
//! all counts with plain recounts.

mod attempts;
mod caches;
mod drawing;
#[cfg(test)]
mod oracle;

use std::ops::Range;

use super::mask::Mask;
use crate::faces::Faces;
use crate::index::index32;
use crate::order::greedy::{HUB, least_neighbours};
use crate::topology::rows;
pub(super) use attempts::Redo;
use caches::Cache;
pub(super) use caches::CacheLimits;
#[cfg(test)]
pub(super) use caches::RING;

/// How many longer windows there are.
pub(super) const WINDOWS: usize = 3;

/// What is known of a vertex.
#[derive(Clone, Copy)]
struct SearchVertex<const CACHES: usize> {
    /// The number of its last push into each cache; 0 before the first.
    entered: [u32; CACHES],
    /// Start of its row in [`State::rows`]; the next vertex's start ends it.
    row_start: u32,
    /// Its corners in faces that are not drawn yet. 0: black.
    live: u32,
    /// How many of the other corners of its live faces are missing from each cache: 16 bits a
    /// cache, the first one in the low bits. At most 2 · [`HUB`], so no count runs into the next; a
    /// hub's may, and are not used.
    missing_corners: u32,
    /// The attempt that last changed it: it is saved already if that is the current one.
    attempt: u32,
}

impl<const CACHES: usize> SearchVertex<CACHES> {
    /// The fewest neighbours that can be missing from a cache; see [`least_neighbours`].
    #[inline]
    fn missing_neighbours(&self, cache: usize) -> u32 {
        least_neighbours(self.missing_corners >> (16 * cache) & 0xffff, self.live)
    }
}

/// The traversal, with one cache or two.
pub(super) struct State<'a, M, const CACHES: usize> {
    faces: &'a [[u32; 3]],
    /// One more than there are, so that each row has an end. That one is on no face.
    vertices: Vec<SearchVertex<CACHES>>,
    /// The faces of each vertex, including drawn ones, each with its other two corners.
    rows: Vec<[u32; 3]>,
    drawn: Vec<bool>,
    pub(super) caches: [Cache; CACHES],
    /// The candidates: those of the last `window` pushes into the first cache whose vertices are
    /// unfinished.
    candidate_pushes: M,
    /// How many of the last pushes can be candidates; at most `M::SPAN`.
    pub(super) window: u32,
    /// Longer windows whose exits are counted, in pushes into the first cache.
    pub(super) windows: [u32; WINDOWS],
    /// How many vertices left each of them unfinished.
    pub(super) window_exits: [u32; WINDOWS],
    pub(super) keep_corners: bool,
    /// Where the polygon of each face begins and ends; empty if there are no polygons.
    pub(super) polygons: &'a [[u32; 2]],
    /// How many faces across a border wait once each vertex is finished; empty where there are none.
    pub(super) anchored: Vec<u32>,
    /// How many wait now.
    waiting: u32,
    /// After how many faces a batch ends with two of them.
    pub(super) hosts: Vec<u32>,
    /// A buffer for the live faces of a focus.
    gathered: Vec<u32>,
    /// The number of the current attempt.
    attempt: u32,
    /// The vertices that the attempt changed, as they were before it.
    overwritten: Vec<(u32, SearchVertex<CACHES>)>,
    pub(super) new_to_old: Vec<u32>,
    pub(super) rotations: Vec<u8>,
    /// Vertices that were candidates and left the window, or a controllable cache, unfinished: where
    /// to go on when no candidate is left.
    pub(super) dead_ends: Vec<u32>,
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
    /// How many vertices are missing, at least: of its neighbours from the first cache, of its
    /// neighbours and itself from the second.
    pub(super) missing: [u32; 2],
}

impl<'a, M: Mask, const CACHES: usize> State<'a, M, CACHES> {
    /// Nothing is drawn, the caches are empty, and there are no candidates.
    ///
    /// Corners may be turned, and there are no polygons: set the fields for anything else.
    pub(super) fn new(faces: Faces<'a>, limits: [CacheLimits; CACHES]) -> Self {
        // Each cache has 16 bits of `missing`, enough for two corners a face of all but hubs, and
        // each window must fit in the ring.
        const { assert!(CACHES <= 2 && 2 * HUB < 1 << 16 && M::SPAN as usize <= caches::RING) };
        let (faces, vertex_count) = (faces.as_slice(), faces.vertex_count());

        // Count the live faces of each vertex.
        let unused = SearchVertex {
            entered: [0; CACHES],
            row_start: 0,
            live: 0,
            missing_corners: 0,
            attempt: 0,
        };
        let mut vertices = vec![unused; vertex_count + 1];
        for &corner in faces.as_flattened() {
            vertices[corner as usize].live += 1;
        }

        // From the counts follows where each row ends. All corners are missing at first, two others
        // in each face.
        let one_in_each: u32 = (0..CACHES).map(one_in).sum();
        let mut end = 0;
        for vertex in &mut vertices {
            end += vertex.live;
            vertex.row_start = end;
            vertex.missing_corners = vertex.live.wrapping_mul(2 * one_in_each);
        }

        // Fill the rows from the end, which moves each `row_start` from the end to the start.
        let mut entries = vec![[0; 3]; faces.len() * 3];
        let numbered = (0..index32(faces.len())).zip(faces).rev();
        let items = numbered
            .map(|(face, &[a, b, c])| [(c, [face, a, b]), (b, [face, c, a]), (a, [face, b, c])]);
        rows::place_backwards(
            &mut vertices,
            |vertex| &mut vertex.row_start,
            items,
            &mut entries,
        );

        Self {
            faces,
            vertices,
            rows: entries,
            drawn: vec![false; faces.len()],
            caches: limits.map(|limits| Cache::new(limits, index32(vertex_count))),
            candidate_pushes: M::default(),
            window: limits[0].size,
            windows: [1; WINDOWS],
            window_exits: [0; WINDOWS],
            keep_corners: false,
            polygons: &[],
            anchored: Vec::new(),
            waiting: 0,
            hosts: Vec::new(),
            gathered: vec![0; HUB as usize],
            attempt: 0,
            overwritten: Vec::new(),
            new_to_old: Vec::with_capacity(faces.len()),
            rotations: Vec::with_capacity(faces.len()),
            dead_ends: Vec::new(),
        }
    }

    /// How many faces of a vertex are left.
    #[inline]
    pub(super) fn live(&self, vertex: u32) -> u32 {
        self.vertices[vertex as usize].live
    }

    /// The first vertex with faces left, at or after `from`.
    pub(super) fn first_live(&self, from: u32) -> Option<u32> {
        let rest = &self.vertices[from as usize..];
        let skipped = rest.iter().position(|vertex| vertex.live != 0)?;
        Some(from + index32(skipped))
    }

    /// Where the faces of `vertex` are in `rows`.
    #[inline]
    fn row(&self, vertex: u32) -> Range<usize> {
        let v = vertex as usize;
        self.vertices[v].row_start as usize..self.vertices[v + 1].row_start as usize
    }

    #[inline]
    fn is_missing(&self, vertex: u32, cache: usize) -> bool {
        self.vertices[vertex as usize].entered[cache] < self.caches[cache].first
    }

    /// How many faces are in the batch that is not full yet, the longer one if both caches have
    /// batches; 0 if none has.
    pub(super) fn faces_in_batch(&self) -> usize {
        let has_batches = |cache: &&Cache| {
            let limits = cache.limits;
            limits.batch_faces != u32::MAX || limits.batch_vertices != u32::MAX
        };
        let batches = self.caches.iter().filter(has_batches);
        let faces = batches.map(|cache| match cache.reserved {
            0 => cache.faces_in_batch as usize,
            // It is full with the faces across a border.
            _ => 0,
        });
        faces.max().unwrap_or(0)
    }

    pub(super) fn has_candidates(&self) -> bool {
        self.candidate_pushes != M::default()
    }

    /// Counts exits from 0 again.
    pub(super) fn reset_exits(&mut self) {
        for cache in &mut self.caches {
            cache.exits = 0;
        }
        self.window_exits = [0; WINDOWS];
    }

    /// How many faces there are, drawn or not.
    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The vertex, to be changed; with `UNDO` it is saved first, once an attempt.
    #[inline]
    fn vertex_mut<const UNDO: bool>(&mut self, vertex: u32) -> &mut SearchVertex<CACHES> {
        let entry = &mut self.vertices[vertex as usize];
        if UNDO && entry.attempt != self.attempt {
            self.overwritten.push((vertex, *entry));
            entry.attempt = self.attempt;
        }
        entry
    }

    /// Calls `visit` with up to `most` candidates, numbered from 0, the oldest first; returns how
    /// many.
    #[inline]
    pub(super) fn candidates(&self, most: u32, mut visit: impl FnMut(usize, Candidate)) -> u32 {
        // Bit 0 of `places` is the oldest push of the window.
        let cache = &self.caches[0];
        let start = cache.pushes - self.window;
        let mut places = self.candidate_pushes.rotated(start);
        let count = places.count().min(most);

        for i in 0..count as usize {
            let entered = start + places.take_lowest();
            let number = cache.pushed(entered);
            let vertex = &self.vertices[number as usize];

            // The second cache may miss the vertex itself; for the first one `is_inside` says that.
            let mut missing = [vertex.missing_neighbours(0), 0];
            if CACHES > 1 {
                let second = CACHES - 1;
                let itself = u32::from(vertex.entered[second] < self.caches[second].first);
                missing[1] = vertex.missing_neighbours(second) + itself;
            }

            let candidate = Candidate {
                vertex: number,
                live: vertex.live,
                age: cache.pushes - entered,
                is_inside: entered >= cache.first,
                missing,
            };
            visit(i, candidate);
        }
        count
    }
}

/// 1 in the 16 bits of a cache in [`SearchVertex::missing_corners`].
#[inline]
const fn one_in(cache: usize) -> u32 {
    1 << (16 * cache)
}
