//! Drawing faces: what changes in the caches, and in the counts of the neighbours.

use std::ops::Range;

use super::super::border::{HOSTED, HOSTED_VERTICES};
use super::super::mask::Mask;
use super::caches::RING;
use super::{State, one_in};
use crate::faces::turned;
use crate::index::index32;
use crate::order::greedy::{HITS_FIRST, HUB, gather_live};

impl<M: Mask, const CACHES: usize> State<'_, M, CACHES> {
    /// Draws the live faces of `focus`, or their polygons, up to the end of the first cache's batch.
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
            if !self.caches[0].has_room(0) {
                break;
            }
        }

        self.gathered = gathered;
    }

    /// Draws a face in all caches.
    #[inline]
    fn draw_face<const UNDO: bool>(&mut self, face: u32) {
        let corners = self.faces[face as usize];
        let missing = self.place_in_batches::<UNDO>(corners);
        let finished = self.take_off::<UNDO>(face, corners, missing);

        // Turn its corners so that the hits of the first cache come first.
        let set = missing.map(|missing| (missing & one_in(0)) as usize);
        let rotation = match self.keep_corners {
            true => 0,
            false => HITS_FIRST[set[0] | set[1] << 1 | set[2] << 2],
        };
        self.rotations.push(rotation);
        self.new_to_old.push(face);

        // Push its misses.
        let turned = turned(corners, rotation);
        let mut entered = [0_u32; 3];
        for cache in 0..CACHES {
            // A face may name a vertex twice, and with kept corners an earlier push may have
            // evicted a corner that was there.
            for (corner, entered) in turned.into_iter().zip(&mut entered) {
                if self.is_missing(corner, cache) {
                    self.push::<UNDO>(corner, cache, corners);
                    *entered += one_in(cache);
                    if CACHES == 1 {
                        self.announce_entry::<UNDO>(corner, one_in(cache));
                    }
                }
            }
        }

        // What entered two caches at once is announced once. With one it was announced at once: a
        // controllable cache makes room by what was.
        if CACHES > 1 {
            for (corner, entered) in turned.into_iter().zip(entered) {
                if entered != 0 {
                    self.announce_entry::<UNDO>(corner, entered);
                }
            }
        }

        if self.waiting >= HOSTED {
            self.host();
        }

        // Finished corners leave a controllable cache after the face: until then it needs them.
        if self.caches[0].limits.is_controllable {
            self.caches[0].held -= finished;
        }
    }

    /// Leaves the end of the batch to faces across a border that wait, if it is near and there is room.
    fn host(&mut self) {
        let batch = &mut self.caches[CACHES - 1];
        let limits = batch.limits;
        let is_near = batch.faces_in_batch + HOSTED == limits.batch_faces;
        let vertices = batch.pushes_in_batch.saturating_add(HOSTED_VERTICES);
        if is_near && vertices <= limits.batch_vertices {
            batch.reserved = HOSTED;
            self.waiting -= HOSTED;
            self.hosts.push(index32(self.new_to_old.len()));
        }
    }

    /// Adds a face to the batch of each cache, or to a new one if it does not fit; returns for each
    /// corner [`one_in`] each cache that misses it then.
    #[inline]
    fn place_in_batches<const UNDO: bool>(&mut self, corners: [u32; 3]) -> [u32; 3] {
        let mut missing = [0; 3];
        for cache in 0..CACHES {
            let mut missing_here = corners.map(|corner| self.is_missing(corner, cache));
            let misses = missing_here.map(u32::from).iter().sum();
            if !self.caches[cache].has_room(misses) {
                self.end_batch::<UNDO>(cache);
                missing_here = [true; 3];
            }
            self.caches[cache].faces_in_batch += 1;

            for (missing, here) in missing.iter_mut().zip(missing_here) {
                *missing += u32::from(here) * one_in(cache);
            }
        }
        missing
    }

    /// Marks a face drawn and takes it off the counts of its corners, of which `missing` says where
    /// they are missing; returns how many of them are finished.
    ///
    /// It comes before the face's pushes, so that they are not announced to it.
    #[inline]
    fn take_off<const UNDO: bool>(
        &mut self,
        face: u32,
        corners: [u32; 3],
        missing: [u32; 3],
    ) -> u32 {
        self.drawn[face as usize] = true;

        let mut finished = 0;
        for i in 0..3 {
            let others = missing[(i + 1) % 3] + missing[(i + 2) % 3];
            let vertex = self.vertex_mut::<UNDO>(corners[i]);
            vertex.live -= 1;
            vertex.missing_corners = vertex.missing_corners.wrapping_sub(others);
            let (entered, is_finished) = (vertex.entered[0], vertex.live == 0);
            if is_finished {
                finished += 1;
                self.drop_candidate(entered);
                if let Some(count) = self.anchored.get(corners[i] as usize) {
                    self.waiting += count;
                }
            }
        }
        finished
    }

    /// Removes the vertex of push `entered` into the first cache from the candidates, if it is one.
    #[inline]
    fn drop_candidate(&mut self, entered: u32) {
        let is_in_window = self.caches[0].pushes - entered <= self.window;
        self.candidate_pushes.clear_if(is_in_window, entered);
    }

    /// Pushes a missing corner of the face with `corners` into a cache, and evicts another vertex
    /// if the cache was full.
    #[inline]
    fn push<const UNDO: bool>(&mut self, corner: u32, cache: usize, corners: [u32; 3]) {
        let now = self.caches[cache].pushes;
        let vertex = self.vertex_mut::<UNDO>(corner);
        let before = std::mem::replace(&mut vertex.entered[cache], now);
        let is_live = vertex.live != 0;

        // Candidates follow the first cache.
        if cache == 0 {
            self.drop_candidate(before);
            self.slide_windows::<UNDO>(now);
            self.candidate_pushes.set_if(is_live, now);
        }

        // Enter.
        let model = &mut self.caches[cache];
        model.ring[now as usize % RING] = corner;
        model.pushes = now + 1;
        model.pushes_in_batch = model.pushes_in_batch.saturating_add(1);

        // Make room.
        if model.limits.is_controllable {
            model.held += 1;
            if model.held > model.limits.size {
                self.make_room::<UNDO>(corners);
            }
        } else if model.pushes - model.first > model.limits.size {
            let leaving = model.pushed(model.first);
            model.first += 1;
            self.exit::<UNDO>(leaving, cache);
        }
    }

    /// Announces a vertex that entered caches, [`one_in`] each, unless it is finished.
    #[inline]
    fn announce_entry<const UNDO: bool>(&mut self, vertex: u32, entered: u32) {
        if self.live(vertex) != 0 {
            self.announce::<UNDO>(vertex, entered.wrapping_neg());
        }
    }

    /// Counts the vertices that leave the longer windows as push `now` enters, and removes the
    /// candidate that leaves the window; a controllable cache evicts it.
    #[inline]
    fn slide_windows<const UNDO: bool>(&mut self, now: u32) {
        // The longer windows.
        if CACHES > 1 {
            for (window, exits) in self.windows.iter().zip(&mut self.window_exits) {
                let expired = now - window;
                let vertex = &self.vertices[self.caches[0].pushed(expired) as usize];
                *exits += u32::from(vertex.live != 0 && vertex.entered[0] == expired);
            }
        }

        // The window of candidates.
        let expired = now - self.window;
        if self.candidate_pushes.contains(expired) {
            let leaving = self.caches[0].pushed(expired);
            if self.caches[0].limits.is_controllable {
                self.evict::<UNDO>(leaving, expired);
            } else {
                self.candidate_pushes.clear_if(true, expired);
                self.dead_ends.push(leaving);
            }
        }
    }

    /// Evicts the vertex of a controllable cache that costs most to finish, ties to the oldest;
    /// never one of the `corners` of the face that is being drawn.
    fn make_room<const UNDO: bool>(&mut self, corners: [u32; 3]) {
        let mut dearest = None;
        let mut most = i64::MIN;
        self.candidates(u32::MAX, |_, candidate| {
            // In half pushes: as the weights of `preset::controllable`.
            let cost = 2 * i64::from(candidate.missing[0]) - i64::from(candidate.live);
            if cost > most && !corners.contains(&candidate.vertex) {
                most = cost;
                dearest = Some(candidate.vertex);
            }
        });
        if let Some(vertex) = dearest {
            let entered = self.vertices[vertex as usize].entered[0];
            self.evict::<UNDO>(vertex, entered);
        }
    }

    /// Evicts an unfinished vertex, pushed as number `entered`, from a controllable cache.
    fn evict<const UNDO: bool>(&mut self, vertex: u32, entered: u32) {
        self.candidate_pushes.clear_if(true, entered);
        self.caches[0].held -= 1;
        self.vertex_mut::<UNDO>(vertex).entered[0] = 0;
        self.dead_ends.push(vertex);
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
        let model = &mut self.caches[cache];
        let Range { start, end } = model.first..model.pushes;
        model.first = end;
        model.faces_in_batch = 0;
        model.pushes_in_batch = 0;
        model.reserved = 0;

        for number in start..end {
            let vertex = self.caches[cache].pushed(number);
            self.exit::<UNDO>(vertex, cache);
        }
    }

    /// Tells the neighbours of `vertex`, unless it is a hub, that it left or entered caches:
    /// `change` is [`one_in`] each of them, or the wrapped negative.
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
                let neighbour = self.vertex_mut::<UNDO>(neighbour);
                neighbour.missing_corners = neighbour.missing_corners.wrapping_add(change);
            }
        }
    }
}
