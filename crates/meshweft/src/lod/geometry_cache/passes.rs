//! More active vertices than slots: a frame drawn in passes.

use std::ops::Range;

use super::cache_error::GeometryCacheError;
use super::manager::GeometryCache;
use super::number_set::NumberSet;
use super::upload::Upload;

/// The passes of a frame, each with as many faces as the slots have vertices for.
#[derive(Debug)]
pub struct Passes<'a> {
    cache: &'a mut GeometryCache,
    faces: &'a [[u32; 3]],
    /// The faces that are still to be drawn.
    left: Range<usize>,
    is_backward: bool,
}

/// One pass: upload its inserts, then draw its faces, then ask for the next one.
#[derive(Debug, Clone, Copy)]
pub struct CachePass<'a> {
    cache: &'a GeometryCache,
    faces: &'a [[u32; 3]],
    start: usize,
}

impl GeometryCache {
    /// Draws these faces, of any vertices, in passes: every face in exactly one of them, with its three vertices in
    /// slots. For frames of [`FrameMode::Passes`](super::FrameMode::Passes); after any other frame it takes the slots of the active vertices.
    ///
    /// Passes take faces in the order of the list, so the better that is for a cache, the fewer there are. Every
    /// second frame starts at the end of the list, where the slots have the vertices of the last pass.
    ///
    /// # Errors
    /// If a face has a vertex that does not exist; everything is then as it was.
    ///
    /// # Complexity
    /// Time O(faces + active vertices + n log n) for n inserts; 4 bytes a vertex from the first call on.
    pub fn passes<'a>(
        &'a mut self,
        faces: &'a [[u32; 3]],
    ) -> Result<Passes<'a>, GeometryCacheError> {
        self.check("corners of faces", faces.as_flattened())?;
        let is_backward = self.start_passes();
        Ok(Passes {
            is_backward,
            cache: self,
            faces,
            left: 0..faces.len(),
        })
    }
}

impl Passes<'_> {
    /// The next pass; `None` when all faces are drawn.
    pub fn next_pass(&mut self) -> Option<CachePass<'_>> {
        if self.left.is_empty() {
            return None;
        }

        // As many faces as there are slots for their vertices: always one, as there are three slots.
        self.cache.pass.restart();
        let slots = self.cache.slots();
        let before = self.left.clone();
        while let Some(next) = self.next_face()
            && add_corners(&mut self.cache.pass, self.faces[next], slots)
        {
            match self.is_backward {
                true => self.left.end -= 1,
                false => self.left.start += 1,
            }
        }
        let drawn = match self.is_backward {
            true => self.left.end..before.end,
            false => before.start..self.left.start,
        };

        self.cache.hold_pass();
        Some(CachePass {
            cache: self.cache,
            faces: &self.faces[drawn.clone()],
            start: drawn.start,
        })
    }

    fn next_face(&self) -> Option<usize> {
        match self.is_backward {
            true => self.left.clone().next_back(),
            false => self.left.clone().next(),
        }
    }
}

/// Adds the corners of a face to a pass, if there are slots for them. A face without an area needs none.
fn add_corners(pass: &mut NumberSet, face: [u32; 3], slots: usize) -> bool {
    if is_degenerate(face) {
        return true;
    }
    let missing = face.into_iter().filter(|&vertex| !pass.contains(vertex));
    if pass.len() + missing.count() > slots {
        return false;
    }
    for vertex in face {
        pass.insert(vertex);
    }
    true
}

fn is_degenerate([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

impl<'a> CachePass<'a> {
    /// What to upload before the pass is drawn.
    #[must_use]
    pub fn upload(&self) -> &'a Upload {
        self.cache.upload()
    }

    /// Which faces of the list the pass draws.
    #[must_use]
    pub fn faces(&self) -> Range<usize> {
        self.start..self.start + self.faces.len()
    }

    /// The slots of the corners of each of these faces. A face of two equal corners is three times slot 0.
    pub fn indices(&self) -> impl Iterator<Item = [u32; 3]> + 'a {
        let (cache, faces) = (self.cache, self.faces);
        let slot = |vertex| cache.slot(vertex).unwrap_or(0);
        let place = move |face| match is_degenerate(face) {
            true => [0; 3],
            false => face.map(slot),
        };
        faces.iter().copied().map(place)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{EvictionPolicy, FrameMode, GeometryCache};
    use crate::random::SplitMix64;

    /// Draws all passes on a card, and returns how many vertices were sent.
    fn draw(cache: &mut GeometryCache, faces: &[[u32; 3]], card: &mut Vec<Option<u32>>) -> usize {
        card.resize(cache.slots(), None);
        let (mut is_drawn, mut sent) = (vec![false; faces.len()], 0);
        let mut passes = cache.passes(faces).unwrap();
        while let Some(pass) = passes.next_pass() {
            assert!(!pass.faces().is_empty());
            assert_eq!(pass.upload().statistics().overruled, 0);
            assert_eq!(pass.upload().mode(), FrameMode::Passes);
            for insert in pass.upload().inserts() {
                card[insert.slot as usize] = Some(insert.vertex);
            }
            sent += pass.upload().statistics().inserts;
            assert_eq!(pass.indices().count(), pass.faces().len());
            for (number, indices) in pass.faces().zip(pass.indices()) {
                assert!(!std::mem::replace(&mut is_drawn[number], true));
                let [a, b, c] = faces[number];
                match a == b || b == c || c == a {
                    true => assert_eq!(indices, [0; 3]),
                    false => assert_eq!(
                        indices.map(|slot| card[slot as usize]),
                        faces[number].map(Some)
                    ),
                }
            }
        }
        assert!(is_drawn.into_iter().all(|is_drawn| is_drawn));
        sent
    }

    #[test]
    fn every_face_is_drawn_once_with_its_vertices() {
        for eviction in EvictionPolicy::ALL {
            for seed in 0..40 {
                let random = &mut SplitMix64(seed);
                let slots = 3 + random.below(3) * random.below(20);
                let vertices = 3 + random.below(4 * slots);
                let mut number = || u32::try_from(random.below(vertices)).unwrap();
                let errors = vec![1.0; vertices];
                let cache = GeometryCache::new(slots, errors, eviction).unwrap();
                let (mut cache, mut card) = (cache.with_passes(), Vec::new());
                for frame in 0..6 {
                    let active: Vec<u32> = (0..number()).map(|_| number()).collect();
                    let mode = cache.set_active(&active).unwrap().mode();
                    for insert in cache.upload().inserts() {
                        if mode == FrameMode::Cached {
                            card.resize(slots, None);
                            card[insert.slot as usize] = Some(insert.vertex);
                        }
                    }
                    // After a frame that fits too, and twice; then the front is in slots again.
                    for _ in 0..frame % 3 {
                        let faces: Vec<_> = (0..number())
                            .map(|_| [number(), number(), number()])
                            .collect();
                        draw(&mut cache, &faces, &mut card);
                    }
                    if mode == FrameMode::Cached {
                        for insert in cache.change(&[], &[]).unwrap().inserts() {
                            card[insert.slot as usize] = Some(insert.vertex);
                        }
                        let is_there = |&vertex: &u32| {
                            card[cache.slot(vertex).unwrap() as usize] == Some(vertex)
                        };
                        assert!(cache.active().iter().all(is_there));
                    }
                }
            }
        }
    }

    #[test]
    fn three_slots_draw_a_strip() {
        let cache = GeometryCache::new(3, vec![1.0; 9], EvictionPolicy::OldestFirst).unwrap();
        let mut cache = cache.with_passes();
        let strip: Vec<[u32; 3]> = (0..7).map(|i| [i, i + 1, i + 2]).collect();
        let mode = cache
            .set_active(&[0, 1, 2, 3, 4, 5, 6, 7, 8])
            .unwrap()
            .mode();
        assert_eq!(mode, FrameMode::Passes);
        // Each pass is a face, and needs one vertex more than the one before.
        assert_eq!(draw(&mut cache, &strip, &mut Vec::new()), 9);
        assert!(cache.passes(&[[0, 1, 9]]).is_err());
    }

    /// Going to and fro, the vertices of the last pass are the first of the next frame.
    #[test]
    fn every_second_frame_goes_backward() {
        let cache = GeometryCache::new(10, vec![1.0; 22], EvictionPolicy::OldestFirst).unwrap();
        let (mut cache, mut card) = (cache.with_passes(), Vec::new());
        let strip: Vec<[u32; 3]> = (0..20).map(|i| [i, i + 1, i + 2]).collect();
        let all: Vec<u32> = (0..22).collect();
        let mut sent = Vec::new();
        for _ in 0..4 {
            cache.set_active(&all).unwrap();
            sent.push(draw(&mut cache, &strip, &mut card));
        }
        assert_eq!(sent, [22, 12, 12, 12]);
    }
}
