//! Drawing faces: what changes in the caches, and in the counts of the neighbours.

use std::ops::Range;

use super::super::mask::Mask;
use super::caches::RING;
use super::{State, one_in};
use crate::faces::turned;
use crate::order::greedy::{HITS_FIRST, HUB, gather_live};

impl<M: Mask, const CACHES: usize> State<'_, M, CACHES> {
    /// Draws the live faces of `focus`, up to the end of the first cache's batch.
    #[inline]
    pub(in crate::order::search) fn draw<const UNDO: bool>(&mut self, focus: u32) {
        let mut gathered = std::mem::take(&mut self.gathered);
        let row = self.row(focus);
        let row = self.rows[row].iter().map(|&[face, ..]| face);
        let count = gather_live(row, &self.drawn, &mut gathered);

        for &face in &gathered[..count] {
            if self.drawn[face as usize] {
                // It names the focus twice, or was drawn with its polygon.
                continue;
            }
            match self.polygons.get(face as usize) {
                None => self.draw_face::<UNDO>(face),
                Some(&[start, end]) => {
                    (start..end).for_each(|face| self.draw_face::<UNDO>(face));
                }
            }
            if self.caches[0].is_full(0) {
                break;
            }
        }

        self.gathered = gathered;
    }

    /// Draws a face in all caches.
    #[inline]
    fn draw_face<const UNDO: bool>(&mut self, face: u32) {
        let corners = self.faces[face as usize];

        // Which corners each cache misses, after a new batch if the face does not fit in the
        // current one. `absent` is the same by corner, in the 16-bit counts of
        // `SearchVertex::missing`.
        let mut missing = [[false; 3]; CACHES];
        let mut absent = [0_u32; 3];
        for (cache, missing) in missing.iter_mut().enumerate() {
            *missing = corners.map(|corner| self.is_missing(corner, cache));
            let count = missing.map(u32::from).iter().sum();
            if self.caches[cache].is_full(count) {
                self.end_batch::<UNDO>(cache);
                *missing = [true; 3];
            }
            for (absent, &missing) in absent.iter_mut().zip(&*missing) {
                *absent += u32::from(missing) << (16 * cache);
            }
            self.caches[cache].faces += 1;
        }

        // Take the face off the counts of its corners. It is marked first, so that its own pushes
        // are not announced to it.
        self.drawn[face as usize] = true;
        let mut finished = 0_u32;
        for i in 0..3 {
            let others = absent[(i + 1) % 3] + absent[(i + 2) % 3];
            let vertex = self.change::<UNDO>(corners[i]);
            vertex.live -= 1;
            vertex.missing = vertex.missing.wrapping_sub(others);
            let (entered, is_finished) = (vertex.entered[0], vertex.live == 0);
            if is_finished {
                finished += 1;
                self.forget(entered);
            }
        }

        // Turn its corners so that the hits of the first cache come first.
        let set = missing[0].map(usize::from);
        let rotation = match self.keep_corners {
            true => 0,
            false => HITS_FIRST[set[0] | set[1] << 1 | set[2] << 2],
        };
        self.rotations.push(rotation);
        self.new_to_old.push(face);

        let turned = turned(corners, rotation);
        for cache in 0..CACHES {
            // A face may name a vertex twice, and with kept corners an earlier push may have
            // evicted a corner that was there.
            for corner in turned {
                if self.is_missing(corner, cache) {
                    self.push::<UNDO>(corner, cache, corners);
                }
            }
        }

        // Finished corners leave a controllable cache after the face: until then it needs them.
        if self.caches[0].limits.is_controllable {
            self.caches[0].held -= finished;
        }
    }

    /// Removes the vertex of push `entered` from the candidates, if it is one.
    #[inline]
    fn forget(&mut self, entered: u32) {
        let is_recent = self.caches[0].pushes - entered <= self.window;
        self.recent.clear_if(is_recent, entered);
    }

    /// Pushes a vertex of `face` into a cache, and evicts another one if the cache was full.
    #[inline]
    fn push<const UNDO: bool>(&mut self, vertex: u32, cache: usize, face: [u32; 3]) {
        let now = self.caches[cache].pushes;
        let entry = self.change::<UNDO>(vertex);
        let before = std::mem::replace(&mut entry.entered[cache], now);
        let is_live = entry.live != 0;

        // Candidates follow the first cache.
        if cache == 0 {
            self.forget(before);
            self.slide_windows::<UNDO>(now);
            self.recent.set_if(is_live, now);
        }

        let state = &mut self.caches[cache];
        state.ring[now as usize % RING] = vertex;
        state.pushes = now + 1;
        state.vertices = state.vertices.saturating_add(1);

        // Make room.
        if state.limits.is_controllable {
            state.held += 1;
            if state.held > state.limits.size {
                self.make_room::<UNDO>(face);
            }
        } else if state.pushes - state.first > state.limits.size {
            let leaving = state.pushed(state.first);
            state.first += 1;
            self.exit::<UNDO>(leaving, cache);
        }

        if is_live {
            self.announce::<UNDO>(vertex, one_in(cache).wrapping_neg());
        }
    }

    /// Counts the vertices that leave the longer windows as push `now` enters, and removes the
    /// candidate that leaves the window; a controllable cache evicts it.
    #[inline]
    fn slide_windows<const UNDO: bool>(&mut self, now: u32) {
        if CACHES > 1 {
            for (window, exits) in self.windows.iter().zip(&mut self.window_exits) {
                let entered = now - window;
                let known = &self.vertices[self.caches[0].pushed(entered) as usize];
                *exits += u32::from(known.live != 0 && known.entered[0] == entered);
            }
        }

        let expired = now - self.window;
        if self.recent.contains(expired) {
            let leaving = self.caches[0].pushed(expired);
            if self.caches[0].limits.is_controllable {
                self.evict::<UNDO>(leaving, expired);
            } else {
                self.recent.clear_if(true, expired);
                self.left.push(leaving);
            }
        }
    }

    /// Evicts the vertex of a controllable cache that costs most to finish, ties to the oldest;
    /// never a corner of `face`, which is being drawn.
    fn make_room<const UNDO: bool>(&mut self, face: [u32; 3]) {
        let mut dearest = None;
        let mut most = i64::MIN;
        self.candidates(u32::MAX, |_, candidate| {
            let cost = 2 * i64::from(candidate.missing[0]) - i64::from(candidate.live);
            if cost > most && !face.contains(&candidate.vertex) {
                most = cost;
                dearest = Some(candidate.vertex);
            }
        });
        if let Some(vertex) = dearest {
            let entered = self.vertices[vertex as usize].entered[0];
            self.evict::<UNDO>(vertex, entered);
        }
    }

    /// Evicts an unfinished vertex from a controllable cache.
    fn evict<const UNDO: bool>(&mut self, vertex: u32, entered: u32) {
        self.recent.clear_if(true, entered);
        self.caches[0].held -= 1;
        self.change::<UNDO>(vertex).entered[0] = 0;
        self.left.push(vertex);
        self.exit::<UNDO>(vertex, 0);
    }

    /// Counts and announces a vertex that has left a cache, unless it is finished.
    #[inline]
    fn exit<const UNDO: bool>(&mut self, vertex: u32, cache: usize) {
        if self.vertices[vertex as usize].live != 0 {
            self.caches[cache].exits += 1;
            self.announce::<UNDO>(vertex, one_in(cache));
        }
    }

    /// Empties a cache: all its vertices exit, and a new batch starts.
    #[cold]
    fn end_batch<const UNDO: bool>(&mut self, cache: usize) {
        let state = &mut self.caches[cache];
        let Range { start, end } = state.first..state.pushes;
        state.first = end;
        state.faces = 0;
        state.vertices = 0;
        for number in start..end {
            let vertex = self.caches[cache].pushed(number);
            self.exit::<UNDO>(vertex, cache);
        }
    }

    /// Tells the neighbours of `vertex`, unless it is a hub, that it left or entered a cache:
    /// `change` is [`one_in`] that cache, or its wrapped negative.
    #[inline]
    fn announce<const UNDO: bool>(&mut self, vertex: u32, change: u32) {
        let row = self.row(vertex);
        if row.len() > HUB as usize {
            return;
        }
        for entry in row {
            let [face, a, b] = self.rows[entry];
            // Multiplied by 0 for a drawn face: no branch for the processor to guess.
            let change = change.wrapping_mul(u32::from(!self.drawn[face as usize]));
            for neighbour in [a, b] {
                let neighbour = self.change::<UNDO>(neighbour);
                neighbour.missing = neighbour.missing.wrapping_add(change);
            }
        }
    }
}
