//! Which faces of each vertex are not drawn yet, and how many of their corners are white.
//!
//! The counts of white corners are `u32`, changed by wrapping additions: a change of −1 is
//! `1_u32.wrapping_neg()`. One addition then serves both signs, and multiplying the change by 0 or
//! 1 skips drawn faces without a branch. No count falls below 0: a white corner is counted from the
//! start, or when it leaves the cache, and taken off once, when it enters or its face is drawn.

use std::ops::Range;

use super::estimate::{gather_live, least_neighbours};
use crate::faces::Faces;
use crate::index::index32;
use crate::topology::rows;

/// Most faces of an ordinary vertex; a vertex with more is a *hub*.
///
/// A hub's pushes and evictions are not announced to its neighbours, and it is not drawn
/// tentatively: this bounds the work of a step for any valence. In return the counts of its
/// neighbours may be too high, which can cost quality, nothing else. The number was not tuned.
pub(in crate::order) const HUB: u32 = 256;

/// How many dead-end stacks there are: one for each live count below this, the last one for all
/// others. This bounds the search at a dead end. The number was not tuned.
const STACKS: usize = 8;

/// What a step needs to know of a vertex, in one place in memory.
#[derive(Clone, Copy, Default)]
pub(in crate::order) struct LiveVertex {
    /// FIFO: the clock at its last push, 0 before. Controllable: the number of its push, 0 while it
    /// is not in the cache.
    pub(in crate::order) entered: u32,
    /// Start of its row in [`LiveFaces::rows`]; the next vertex's start ends it.
    row_start: u32,
    /// Its corners in faces that are not drawn yet: its live faces, one that names it twice counted
    /// twice. 0: black.
    pub(in crate::order) live: u32,
    /// White corners of its live faces: its neighbours', and its own while it is white.
    pub(in crate::order) white_corners: u32,
}

impl LiveVertex {
    /// The fewest white neighbours that it can have, if it is in the cache; see
    /// [`least_neighbours`].
    #[inline]
    pub(in crate::order) fn white_neighbours(&self) -> u32 {
        least_neighbours(self.white_corners, self.live)
    }
}

/// The state of a greedy traversal, apart from its cache.
pub(in crate::order) struct LiveFaces<'a> {
    pub(in crate::order) faces: &'a [[u32; 3]],
    /// One more entry than vertices, so that each row has an end. That entry is on no face.
    pub(in crate::order) vertices: Vec<LiveVertex>,
    /// The faces of each vertex in file order, including drawn faces.
    rows: Vec<u32>,
    /// Whether each face is drawn. Bytes, not bits: they are tested more often than a row is read.
    drawn: Vec<bool>,
    /// Vertices that left the cache unfinished, by their live count then ([`stack_of`]). An entry
    /// whose vertex belongs to another stack by now is out of date.
    dead_ends: [Vec<u32>; STACKS],
    /// Whether a dead-end stack may have entries.
    has_dead_ends: bool,
    /// Where the scan in file order goes on: no vertex before it has live faces.
    input_cursor: u32,
}

impl<'a> LiveFaces<'a> {
    /// No face is drawn and every vertex is white.
    pub(in crate::order) fn new(faces: Faces<'a>) -> Self {
        let (faces, vertex_count) = (faces.as_slice(), faces.vertex_count());

        // Count the live faces of each vertex.
        let mut vertices = vec![LiveVertex::default(); vertex_count + 1];
        for &[a, b, c] in faces {
            vertices[a as usize].live += 1;
            vertices[b as usize].live += 1;
            vertices[c as usize].live += 1;
        }

        // From the counts follows where each row ends. All corners are white at first.
        let mut end = 0;
        for vertex in &mut vertices {
            end += vertex.live;
            vertex.row_start = end;
            vertex.white_corners = vertex.live.wrapping_mul(3);
        }

        // Fill the rows from the end, which moves each `row_start` from the end to the start.
        let mut entries = vec![0; faces.len() * 3];
        let numbered = (0..index32(faces.len())).zip(faces).rev();
        let items = numbered.map(|(face, corners)| corners.map(|corner| (corner, face)));
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
            dead_ends: Default::default(),
            has_dead_ends: false,
            input_cursor: 0,
        }
    }

    /// Where the faces of `vertex` are in `rows`.
    #[inline]
    fn row(&self, vertex: u32) -> Range<usize> {
        let start = self.vertices[vertex as usize].row_start as usize;
        let end = self.vertices[vertex as usize + 1].row_start as usize;
        start..end
    }

    /// Writes the live faces of `vertex`, in file order, to the front of `buffer`; returns their
    /// number.
    #[inline]
    pub(in crate::order) fn gather(&self, vertex: u32, buffer: &mut Vec<u32>) -> usize {
        let row = self.rows[self.row(vertex)].iter().copied();
        gather_live(row, &self.drawn, buffer)
    }

    /// Calls `visit` with the corners of each live face of `vertex`, unless it is a hub.
    #[inline]
    pub(in crate::order) fn for_each_live_face(
        &self,
        vertex: u32,
        mut visit: impl FnMut([u32; 3]),
    ) {
        let row = self.row(vertex);
        if row.len() <= HUB as usize {
            for &face in &self.rows[row] {
                if !self.drawn[face as usize] {
                    visit(self.faces[face as usize]);
                }
            }
        }
    }

    /// Marks `face` drawn; false if it was drawn already, since a face that names a vertex twice is
    /// gathered twice.
    #[inline]
    pub(in crate::order) fn mark_drawn(&mut self, face: u32) -> bool {
        !std::mem::replace(&mut self.drawn[face as usize], true)
    }

    /// Takes a drawn face with `white` white corners off the counts of its corners. Call it once a
    /// face, before any of them is pushed.
    #[inline]
    pub(in crate::order) fn remove_corners(&mut self, corners: [u32; 3], white: u32) {
        for corner in corners {
            let vertex = &mut self.vertices[corner as usize];
            vertex.live -= 1;
            vertex.white_corners = vertex.white_corners.wrapping_sub(white);
        }
    }

    /// Tells the neighbours of `vertex` that it entered the cache.
    #[inline]
    pub(in crate::order) fn announce_entry(&mut self, vertex: u32) {
        self.announce(vertex, 1_u32.wrapping_neg());
    }

    /// Tells the neighbours of `vertex` that it left the cache, and keeps it for dead ends.
    #[inline]
    pub(in crate::order) fn announce_unfinished_exit(&mut self, vertex: u32) {
        self.announce(vertex, 1);

        let slot = stack_of(self.vertices[vertex as usize].live);
        let stack = &mut self.dead_ends[slot];

        // A full stack drops entries that are out of date. If few are, it grows, or the next pushes
        // would sift it again and again.
        if stack.len() == stack.capacity() {
            let vertices = &self.vertices;
            stack.retain(|&v| stack_of(vertices[v as usize].live) == slot);
            if stack.len() > stack.capacity() / 2 {
                stack.reserve(stack.capacity());
            }
        }

        stack.push(vertex);
        self.has_dead_ends = true;
    }

    /// Adds `change`, 1 or a wrapped −1, to the white corners of each corner of each live face of
    /// `vertex`, unless it is a hub.
    #[inline]
    fn announce(&mut self, vertex: u32, change: u32) {
        let row = self.row(vertex);
        if row.len() > HUB as usize {
            return;
        }

        let vertices = &mut self.vertices[..];
        for &face in &self.rows[row] {
            // 0 for a drawn face: no branch for the processor to guess.
            let change = change * u32::from(!self.drawn[face as usize]);
            for corner in self.faces[face as usize] {
                let neighbour = &mut vertices[corner as usize];
                neighbour.white_corners = neighbour.white_corners.wrapping_add(change);
            }
        }
    }

    /// The next focus when no live vertex is in the cache: the vertex with the fewest live faces
    /// among those that left it unfinished, ties to the last to leave; else the first in file order
    /// that has live faces; `None` if all faces are drawn.
    pub(in crate::order) fn after_dead_end(&mut self) -> Option<u32> {
        // The stack of the fewest live faces first.
        if self.has_dead_ends {
            for (slot, stack) in self.dead_ends.iter_mut().enumerate() {
                while let Some(vertex) = stack.pop() {
                    if stack_of(self.vertices[vertex as usize].live) == slot {
                        return Some(vertex);
                    }
                }
            }
            self.has_dead_ends = false;
        }

        // File order.
        let rest = &self.vertices[self.input_cursor as usize..];
        self.input_cursor += index32(rest.iter().position(|v| v.live != 0)?);
        Some(self.input_cursor)
    }
}

/// The dead-end stack of a live count; `usize::MAX`, which is not a stack, for 0.
#[inline]
fn stack_of(live: u32) -> usize {
    (live as usize).min(STACKS).wrapping_sub(1)
}
