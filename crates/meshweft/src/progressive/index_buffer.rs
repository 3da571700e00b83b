//! An index buffer that is edited in place, and what to upload of it.

use std::ops::Range;

use super::checkpoint_walk::CheckpointWalk;
use super::checkpoints::Checkpoints;
use super::walk::Walk;
use crate::index::index32;

/// The indices of a progressive mesh at a level that changes, as a renderer keeps them, and which of them
/// changed.
///
/// Every face has a place in the order of the checkpoint, and keeps it while it is there. So between two
/// checkpoints the buffer has constant length, and a step changes a few short ranges of it. A face that left
/// is degenerate: three times the last corner that is drawn before it (or the first one of all, if none is
/// before). That vertex is in any FIFO, LRU or controllable cache at that time, so a degenerate face never
/// misses and changes nothing for the others. With another checkpoint all faces are written again, without
/// those that left before.
///
/// Renderers whose caches work in batches of faces count degenerate ones too: they draw better what
/// [`CheckpointWalk::emit`] writes.
///
/// ```
/// use meshweft::progressive::{Checkpoints, Collapses, IndexBuffer};
/// use meshweft::{CacheModel, Mesh, order::Optimizer};
/// # let positions: Vec<[f32; 3]> = (0..1681_u32).map(|i| {
/// #     let [x, y] = [i % 41, i / 41].map(|i| i as f32 / 10.0);
/// #     [x, y, x.sin() * y.cos()]
/// # }).collect();
/// # let cell = |i: u32| [[i, i + 1, i + 41], [i + 41, i + 1, i + 42]];
/// # let faces: Vec<_> = (0..1640).filter(|i| i % 41 != 40).flat_map(cell).collect();
/// # let mesh = Mesh::new(positions, faces)?;
/// let progressive = Collapses::default().build(&mesh, &[])?;
/// let optimizer = Optimizer::for_cache(CacheModel::fifo(16));
/// let checkpoints = Checkpoints::optimized(&progressive, 0.8, &optimizer);
///
/// let mut buffer = IndexBuffer::new(&checkpoints);
/// let mut uploaded = buffer.faces().to_vec();
/// for level in [1, 5, 3] {
///     let changed = buffer.go_to(level).to_vec();
///     for range in changed {
///         uploaded[range.clone()].copy_from_slice(&buffer.faces()[range]);
///     }
///     assert_eq!(uploaded, buffer.faces());
/// }
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug)]
pub struct IndexBuffer<'a> {
    walk: CheckpointWalk<'a>,
    /// What is drawn, by place.
    faces: Vec<[u32; 3]>,
    /// The place of each face that the checkpoint has, by its number.
    places: Vec<u32>,
    /// How many faces left before the first that is there.
    leading: usize,
    /// The places of faces that changed, came or left in this step, some of them several times; where it is full
    /// there may be others.
    edited: Vec<u32>,
    changed: Changes,
}

/// Ranges of places, rising.
#[derive(Debug)]
struct Changes {
    ranges: Vec<Range<usize>>,
    /// Unchanged places between two ranges that are still reported as one.
    gap: usize,
}

impl Changes {
    /// Adds a place that is not before the last range.
    #[inline]
    fn add(&mut self, place: usize) {
        match self.ranges.last_mut() {
            Some(last) if place <= last.end.saturating_add(self.gap) => {
                last.end = last.end.max(place + 1)
            }
            _ => self.ranges.push(place..place + 1),
        }
    }
}

/// The faces of a level at the places of a checkpoint's order.
#[derive(Clone, Copy)]
struct PresentFaces<'a> {
    walk: &'a Walk<'a>,
    order: Option<&'a [u32]>,
}

impl PresentFaces<'_> {
    /// The face at a place, unless it left.
    #[inline]
    fn face(self, place: usize) -> Option<[u32; 3]> {
        let face = self.order.map_or(index32(place), |order| order[place]);
        self.walk.has(face).then(|| self.walk.face(face))
    }
}

impl<'a> IndexBuffer<'a> {
    /// At full resolution.
    ///
    /// # Complexity
    /// Time O(faces of the full mesh), space 38 bytes for each of these.
    #[must_use]
    pub fn new(checkpoints: &'a Checkpoints<'a>) -> Self {
        let walk = CheckpointWalk::new(checkpoints);
        let count = walk.walk.mesh().faces().len();
        let mut buffer = Self {
            walk,
            faces: Vec::with_capacity(count),
            places: vec![0; count],
            leading: 0,
            edited: Vec::with_capacity(count / 8 + 64),
            changed: Changes {
                ranges: Vec::with_capacity(count / 2 + 1),
                gap: 0,
            },
        };
        buffer.use_order();
        buffer.write_all();
        buffer
    }

    /// The same buffer that reports two ranges as one where at most `faces` unchanged faces are between them.
    #[must_use]
    pub fn with_gap(mut self, faces: usize) -> Self {
        self.changed.gap = faces;
        self
    }

    /// The level that the faces have.
    #[must_use]
    pub fn level(&self) -> usize {
        self.walk.level()
    }

    /// The level of the checkpoint whose order is used.
    #[must_use]
    pub fn checkpoint(&self) -> usize {
        self.walk.checkpoint()
    }

    /// What is drawn: as many faces as the checkpoint has, those that left degenerate.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Goes to a level; returns which faces of the buffer are not as they were, as rising ranges. Where another
    /// checkpoint is used that is the whole buffer, which then has another length.
    ///
    /// # Complexity
    /// Time O(n log n) for the n faces that change, and the faces that left beside them; at most O(removals
    /// between + faces of the checkpoint). No memory.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn go_to(&mut self, level: usize) -> &[Range<usize>] {
        self.changed.ranges.clear();
        if self.walk.checkpoint_of(level) != self.walk.current {
            self.walk.go_to(level);
            self.use_order();
            self.write_all();
            self.changed.ranges.clear();
            self.changed.ranges.push(0..self.faces.len());
            return &self.changed.ranges;
        }

        let (edited, places) = (&mut self.edited, &self.places);
        let room = edited.capacity();
        edited.clear();
        self.walk.go_to_marking(level, |face| {
            if edited.len() < room {
                edited.push(places[face as usize]);
            }
        });
        match self.edited.len() < room {
            true => self.write_edited(),
            false => self.write_all(),
        }
        &self.changed.ranges
    }

    /// Gives each face of the checkpoint its place.
    fn use_order(&mut self) {
        let order = self.walk.order();
        let count = order.map_or(self.places.len(), <[u32]>::len);
        for place in 0..count {
            let face = order.map_or(index32(place), |order| order[place]);
            self.places[face as usize] = index32(place);
        }
        self.faces.resize(count, [0; 3]);
    }

    /// Whether the face at a place has not left.
    #[cfg(test)]
    pub(super) fn is_live(&self, place: usize) -> bool {
        self.present().face(place).is_some()
    }

    fn present(&self) -> PresentFaces<'_> {
        PresentFaces {
            walk: &self.walk.walk,
            order: self.walk.order(),
        }
    }

    /// Writes all places.
    fn write_all(&mut self) {
        self.write_leading();
        let mut last = 0;
        for place in self.leading..self.faces.len() {
            let face = self.present().face(place).unwrap_or([last; 3]);
            last = face[2];
            self.write(place, face);
        }
    }

    /// Writes the places that were edited, and where faces left the places after them.
    fn write_edited(&mut self) {
        self.edited.sort_unstable();
        let first = self.edited.first();
        if first.is_some_and(|&first| first as usize <= self.leading) {
            self.write_leading();
        }

        for i in 0..self.edited.len() {
            let mut place = self.edited[i] as usize;
            if place < self.leading {
                continue;
            }
            let face = self.present().face(place);
            let face = face.unwrap_or_else(|| [self.faces[place - 1][2]; 3]);
            self.write(place, face);

            // The same corner again, as far as faces left.
            let again = [face[2]; 3];
            place += 1;
            while place < self.faces.len()
                && self.faces[place] != again
                && self.present().face(place).is_none()
            {
                self.write(place, again);
                place += 1;
            }
        }
    }

    /// Finds the first face that is there. Those before it have its first corner.
    fn write_leading(&mut self) {
        let mut places = 0..self.faces.len();
        let first = places.find_map(|place| Some((place, self.present().face(place)?)));
        let (leading, [corner, ..]) = first.unwrap_or((self.faces.len(), [0; 3]));
        self.leading = leading;
        for place in 0..leading {
            self.write(place, [corner; 3]);
        }
    }

    #[inline]
    fn write(&mut self, place: usize, face: [u32; 3]) {
        if self.faces[place] != face {
            self.faces[place] = face;
            self.changed.add(place);
        }
    }
}
