//! The index buffer of a front, edited in place.

use std::ops::Range;

use super::index_slots_error::IndexSlotsError;
use super::manager::GeometryCache;
use super::number_set::NumberSet;
use super::slot_bits::SlotBits;
use super::slot_indices::{IndexArray, SlotIndices};
use super::slot_ranges::SlotRanges;
use super::upload::FrameMode;
use crate::index::{BLOCK, index32};

/// The faces of a front as an index buffer of slots: a frame writes the faces that change, and no others.
///
/// A face keeps its place in the buffer while it lives. An active vertex keeps its slot, so a face that does not
/// change itself needs no patch. What left is degenerate, three times slot 0, until a face comes to its place;
/// where more than a share of the places is dead, living faces from the end move into them.
///
/// Indices have 16 bits where there are at most 65,536 slots: no value of theirs may restart a primitive then.
///
/// ```
/// use meshweft::lod::geometry_cache::{EvictionPolicy, GeometryCache, IndexSlots, SlotIndices};
/// let mut cache = GeometryCache::new(4, vec![1.0; 6], EvictionPolicy::default())?;
/// let mut indices = IndexSlots::new(8);
/// cache.change(&[5, 4, 3], &[])?;
/// indices.update(&cache, &[], &[(7, [3, 4, 5])])?;
/// cache.change(&[2], &[])?;
/// let patch = indices.update(&cache, &[], &[(1, [2, 4, 3])])?;
/// assert_eq!(patch.ranges(), [1..2]);
/// assert_eq!(indices.indices(), SlotIndices::Narrow(&[2, 1, 0, 3, 1, 2]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Complexity
/// Space: 4 bytes a face, and at most 38 a place.
#[derive(Debug, Clone)]
pub struct IndexSlots {
    /// Of each face its place, if it lives.
    places: Vec<u32>,
    /// Of each place its face, if one lives there.
    faces: Vec<u32>,
    /// Of each place the vertices of its face.
    corners: Vec<[u32; 3]>,
    dead: NumberSet,
    most_dead: f32,
    buffer: IndexArray,
    /// The generation of slots that the buffer has; none if it has none.
    generation: Option<u64>,
    /// The slots of the corners of what is added.
    slots: Vec<[u32; 3]>,
    /// The places that this frame wrote.
    patched: SlotBits,
    patch: IndexPatch,
    /// What a whole frame's faces are found to change.
    difference: FaceDifference,
}

/// What lives in a frame beside what lived before.
#[derive(Debug, Clone, Default)]
struct FaceDifference {
    /// Of each place whether its face stays.
    stays: Vec<bool>,
    left: Vec<u32>,
    came: Vec<(u32, [u32; 3])>,
}

/// What a frame writes to an index buffer.
#[derive(Debug, Clone, Default)]
pub struct IndexPatch {
    ranges: SlotRanges,
    statistics: IndexStatistics,
}

/// The counts of a frame of an index buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct IndexStatistics {
    /// Faces that live.
    pub living: usize,
    /// Places whose face left: degenerate.
    pub dead: usize,
    /// Faces that are uploaded.
    pub patched: usize,
    /// Ranges that hold these.
    pub ranges: usize,
    /// Bytes that these have.
    pub bytes: usize,
    /// Whether all faces were written again, as the vertices have other places.
    pub is_rewritten: bool,
}

/// No place, no face.
const NONE: u32 = u32::MAX;

impl IndexSlots {
    /// A buffer without faces, for faces with numbers below a count, which is at most 2^32 - 1.
    #[must_use]
    pub fn new(face_count: usize) -> Self {
        Self {
            places: vec![NONE; face_count],
            faces: Vec::new(),
            corners: Vec::new(),
            dead: NumberSet::default(),
            most_dead: 0.25,
            buffer: IndexArray::Narrow(Vec::new()),
            generation: None,
            slots: Vec::new(),
            patched: SlotBits::default(),
            patch: IndexPatch::default(),
            difference: FaceDifference::default(),
        }
    }

    /// Room for this number of faces more, with the next numbers.
    pub fn grow(&mut self, faces: usize) {
        self.places.resize(self.places.len() + faces, NONE);
    }

    /// The same with another largest share of places that are dead, from 0, always dense, to 1. It is .25 else.
    #[must_use]
    pub fn with_most_dead(mut self, share: f32) -> Self {
        self.most_dead = share;
        self
    }

    /// The same that joins ranges with at most this number of faces between them.
    #[must_use]
    pub fn with_gap(mut self, faces: u32) -> Self {
        self.patch.ranges.gap = faces;
        self
    }

    /// Follows a frame of the cache: these faces left; these came, or have these corners now. Call it after the
    /// frame's vertices are changed. A face must leave, or get other corners, in the frame in which a vertex of it
    /// does. A face in both lists lives.
    ///
    /// After a frame of [`FrameMode::Passes`] the buffer is empty: draw [`IndexSlots::corners`] by passes.
    ///
    /// # Errors
    /// If a face does not exist, or a vertex of an added one is not active; everything is then as it was.
    ///
    /// # Complexity
    /// Time O(n + faces / 4096) for n faces in the lists. All faces are written where the vertices have other places: in a frame
    /// that is not [`FrameMode::Cached`], and the first one after.
    pub fn update(
        &mut self,
        cache: &GeometryCache,
        removed: &[u32],
        added: &[(u32, [u32; 3])],
    ) -> Result<&IndexPatch, IndexSlotsError> {
        // Nothing is changed before all of it can be.
        self.check("removed faces", removed.iter().copied())?;
        self.check("added faces", added.iter().map(|&(face, _)| face))?;
        self.look_up(cache, added)?;
        // Passes left it empty; whatever is written now, all is written again.
        self.buffer.resize(self.faces.len());

        // Faces that come take the places of those that leave.
        for &face in removed {
            self.kill(face);
        }
        for (i, &(face, corners)) in added.iter().enumerate() {
            let place = self.place_for(face);
            self.corners[place as usize] = corners;
            self.write(place, self.slots[i]);
        }
        self.trim();
        self.fill_up();

        self.finish(cache);
        Ok(&self.patch)
    }

    /// Follows a frame of an implicit front, of which only is known what there is: exactly these faces live. Which of them came, and
    /// what left, is found here. Name each once.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    ///
    /// # Complexity
    /// Time O(faces of this frame and the last).
    pub fn set_living(
        &mut self,
        cache: &GeometryCache,
        living: &[(u32, [u32; 3])],
    ) -> Result<&IndexPatch, IndexSlotsError> {
        self.check("living faces", living.iter().map(|&(face, _)| face))?;
        let mut difference = std::mem::take(&mut self.difference);
        difference.restart(self.faces.len());

        // What stays has to be drawn too.
        let mut inactive = None;
        for &(face, corners) in living {
            let place = self.place(face).map(|it| it as usize);
            match place {
                Some(place) if self.corners[place] == corners => {
                    difference.stays[place] = true;
                    let missing = corners.iter().find(|&&it| !cache.is_active(it));
                    inactive = inactive.or(missing.map(|&vertex| (face, vertex)));
                }
                _ => difference.came.push((face, corners)),
            }
        }
        if let Some((face, vertex)) = inactive {
            self.difference = difference;
            return Err(IndexSlotsError::Inactive { face, vertex });
        }
        let places = self.faces.iter().zip(&difference.stays);
        let left = places.filter(|&(&face, &stays)| face != NONE && !stays);
        difference.left.extend(left.map(|(&face, _)| face));

        let updated = self.update(cache, &difference.left, &difference.came);
        let done = updated.map(|_| ());
        self.difference = difference;
        done.map(|()| &self.patch)
    }

    /// What the last frame writes.
    #[must_use]
    pub fn patch(&self) -> &IndexPatch {
        &self.patch
    }

    /// The buffer, to the last face that lives.
    #[must_use]
    pub fn indices(&self) -> SlotIndices<'_> {
        self.buffer.as_slice()
    }

    /// The vertices of the faces in the buffer; of a dead one, three times vertex 0.
    #[must_use]
    pub fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }

    /// The place of a face in the buffer, if it lives.
    #[must_use]
    pub fn place(&self, face: u32) -> Option<u32> {
        let place = *self.places.get(face as usize)?;
        (place != NONE).then_some(place)
    }

    /// Whether every face that lives is drawn with its vertices, all of them active, and nothing else is drawn: for
    /// tests of what follows a front. O(faces).
    #[must_use]
    pub fn is_true_to(&self, cache: &GeometryCache) -> bool {
        (0..self.indices().len() / 3).all(|place| {
            let is_dead = self.faces[place] == NONE;
            let slots = self.indices().face(place);
            let vertices = self.corners[place].map(|vertex| cache.active_slot(vertex));
            match is_dead {
                true => slots == [0; 3],
                false => vertices == slots.map(Some),
            }
        })
    }

    fn check(
        &self,
        list: &'static str,
        mut faces: impl Iterator<Item = u32>,
    ) -> Result<(), IndexSlotsError> {
        let face_count = self.places.len();
        let mut position = 0;
        let missing = faces.find(|&face| {
            position += 1;
            face as usize >= face_count
        });
        let Some(face) = missing else {
            return Ok(());
        };
        Err(IndexSlotsError::Face {
            list,
            position: position - 1,
            face,
            face_count,
        })
    }

    /// Finds the slots of all corners that come.
    fn look_up(
        &mut self,
        cache: &GeometryCache,
        added: &[(u32, [u32; 3])],
    ) -> Result<(), IndexSlotsError> {
        self.slots.clear();
        for &(face, corners) in added {
            let mut slots = [0; 3];
            for (slot, vertex) in slots.iter_mut().zip(corners) {
                let found = cache.active_slot(vertex);
                *slot = found.ok_or(IndexSlotsError::Inactive { face, vertex })?;
            }
            self.slots.push(slots);
        }
        Ok(())
    }

    fn kill(&mut self, face: u32) {
        if let Some(place) = self.place(face) {
            self.places[face as usize] = NONE;
            self.faces[place as usize] = NONE;
            self.corners[place as usize] = [0; 3];
            self.dead.insert(place);
            self.write(place, [0; 3]);
        }
    }

    /// The place of a face: its own, a dead one, or one more at the end.
    fn place_for(&mut self, face: u32) -> u32 {
        if let Some(place) = self.place(face) {
            return place;
        }
        let place = self.dead.pop().unwrap_or_else(|| {
            self.faces.push(NONE);
            self.corners.push([0; 3]);
            self.buffer.resize(self.faces.len());
            self.patched.grow(self.faces.len());
            let place = index32(self.faces.len() - 1);
            if self.dead.limit() < self.faces.len() {
                self.dead.grow();
            }
            place
        });
        self.faces[place as usize] = face;
        self.places[face as usize] = place;
        place
    }

    /// Ends the buffer with a face that lives.
    fn trim(&mut self) {
        while self.faces.last() == Some(&NONE) {
            self.faces.pop();
            self.corners.pop();
            self.buffer.resize(self.faces.len());
            self.dead.remove(index32(self.faces.len()));
        }
    }

    /// Moves faces from the end into dead places while too many are dead.
    fn fill_up(&mut self) {
        while self.dead.len() as f32 > self.most_dead * self.faces.len() as f32
            && let Some(place) = self.dead.pop()
        {
            let last = self.faces.len() - 1;
            let face = std::mem::replace(&mut self.faces[last], NONE);
            let slots = self.buffer.as_slice().face(last);
            self.dead.insert(index32(last));
            self.faces[place as usize] = face;
            self.places[face as usize] = place;
            self.corners[place as usize] = self.corners[last];
            self.write(place, slots);
            self.trim();
        }
    }

    fn write(&mut self, place: u32, slots: [u32; 3]) {
        self.buffer.write(place, slots);
        self.patched.insert(place);
    }

    /// Joins what was patched, or writes all if the places of vertices are others.
    fn finish(&mut self, cache: &GeometryCache) {
        let is_drawn = cache.upload().mode() != FrameMode::Passes;
        let generation = is_drawn.then(|| cache.generation());
        let is_rewritten = generation.is_none() || generation != self.generation;
        self.generation = generation;

        let count = self.faces.len();
        let patched = std::iter::from_fn(|| self.patched.take_first());
        let patched = patched.filter(|&place| (place as usize) < count);
        self.patch.ranges.replace(patched);
        if is_rewritten {
            let drawn = index32(count) * u32::from(is_drawn);
            self.patch.ranges.replace_by_one(0..drawn);
            self.rewrite(cache, drawn);
        }

        let patched = self.patch.ranges.count();
        self.patch.statistics = IndexStatistics {
            living: count - self.dead.len(),
            dead: self.dead.len(),
            patched,
            ranges: self.patch.ranges.as_slice().len(),
            bytes: 3 * patched * self.indices().index_size(),
            is_rewritten,
        };
    }

    /// Writes the first faces: as wide as needed, degenerate where a face is dead or has a vertex that left.
    fn rewrite(&mut self, cache: &GeometryCache, drawn: u32) {
        self.buffer.restart(cache.place_limit() <= BLOCK);
        self.buffer.resize(drawn as usize);
        for place in 0..drawn {
            if self.faces[place as usize] == NONE {
                continue;
            }
            let corners = self.corners[place as usize];
            let slots = corners.map(|vertex| cache.active_slot(vertex));
            if let [Some(a), Some(b), Some(c)] = slots {
                self.buffer.write(place, [a, b, c]);
            }
        }
    }
}

impl FaceDifference {
    fn restart(&mut self, places: usize) {
        self.stays.clear();
        self.stays.resize(places, false);
        self.left.clear();
        self.came.clear();
    }
}

impl IndexPatch {
    /// The faces to write, by place, as few ranges, rising and apart: three indices each.
    #[must_use]
    pub fn ranges(&self) -> &[Range<u32>] {
        self.ranges.as_slice()
    }

    /// The counts.
    #[must_use]
    pub fn statistics(&self) -> IndexStatistics {
        self.statistics
    }
}
