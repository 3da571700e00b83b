//! The cached geometry manager.

use super::cache_error::GeometryCacheError;
use super::eviction::EvictionPolicy;
use super::number_set::NumberSet;
use super::policy::SlotPolicy;
use super::slot_table::SlotTable;
use super::upload::{FrameMode, Insert, Upload};
use crate::index::MAX_VERTICES;

/// Keeps the vertices of a front in the slots of a vertex buffer, and says in each frame what to upload.
///
/// It has no vertex data: vertices are numbers, each with the error of its level of detail, larger for coarser
/// detail. While it is active a vertex keeps its slot, from one [`FrameMode::Cached`] frame to the next.
///
/// ```
/// use meshweft::lod::geometry_cache::{EvictionPolicy, GeometryCache};
/// // Four slots for eight vertices, the later the finer.
/// let errors = vec![8.0, 8.0, 8.0, 4.0, 4.0, 2.0, 1.0, 1.0];
/// let mut cache = GeometryCache::new(4, errors, EvictionPolicy::FinestFirst)?;
///
/// let upload = cache.set_active(&[0, 1, 2])?;
/// assert_eq!(upload.statistics().bytes(36), 3 * 36);
/// cache.change(&[5], &[])?;
/// cache.change(&[3], &[5])?; // 3 takes the slot of 5.
/// assert_eq!(cache.slot(3), Some(3));
/// cache.change(&[], &[3])?;
/// let upload = cache.change(&[3], &[])?; // It is still there.
/// assert!(upload.inserts().is_empty());
/// # Ok::<(), meshweft::lod::geometry_cache::GeometryCacheError>(())
/// ```
///
/// # Complexity
/// Space: 12 bytes a vertex, 8 a slot, and for the policy at most 21 a slot. Lists grow with the largest frame so far;
/// any other frame allocates nothing.
#[derive(Debug)]
pub struct GeometryCache {
    table: SlotTable,
    front: NumberSet,
    /// The vertices of the pass that is drawn; made with the first pass.
    pub(super) pass: NumberSet,
    /// The vertices that this frame added and removed.
    added: Vec<u32>,
    removed: Vec<u32>,
    is_caching: bool,
    has_passes: bool,
    /// Whether every active vertex holds a slot.
    is_complete: bool,
    /// Changes when an active vertex may have got another place.
    generation: u64,
    upload: Upload,
}

impl GeometryCache {
    /// A cache with this number of slots, for vertices of these errors, with a policy by name.
    ///
    /// # Errors
    /// If there are fewer than 3 slots or more than 2^30, or an error of a vertex is negative or not a number.
    pub fn new(
        slots: usize,
        errors: Vec<f32>,
        eviction: EvictionPolicy,
    ) -> Result<Self, GeometryCacheError> {
        // The policy has memory for the slots.
        check_slots(slots)?;
        let mut cache = Self::with_policy(slots, errors, eviction.policy(slots))?;
        cache.is_caching = eviction != EvictionPolicy::Nothing;
        Ok(cache)
    }

    /// The same with a policy of your own.
    ///
    /// # Errors
    /// As for [`GeometryCache::new`].
    pub fn with_policy(
        slots: usize,
        errors: Vec<f32>,
        policy: Box<dyn SlotPolicy>,
    ) -> Result<Self, GeometryCacheError> {
        check_slots(slots)?;
        if errors.len() > MAX_VERTICES {
            let count = errors.len();
            return Err(GeometryCacheError::Vertices { count });
        }
        let mut all = errors.iter().enumerate();
        all.try_for_each(|(vertex, &error)| check_error(vertex, error))?;

        let front = NumberSet::new(errors.len());
        Ok(Self {
            table: SlotTable::new(slots, errors, policy),
            front,
            pass: NumberSet::default(),
            added: Vec::new(),
            removed: Vec::new(),
            is_caching: true,
            has_passes: false,
            is_complete: true,
            generation: 0,
            upload: Upload::default(),
        })
    }

    /// The same cache that has frames of more active vertices than slots drawn in passes, instead of streaming them.
    #[must_use]
    pub fn with_passes(mut self) -> Self {
        self.has_passes = true;
        self
    }

    /// The same cache that joins ranges of the upload with at most this number of slots between them. The caller sends what
    /// these have: [`GeometryCache::vertex`].
    #[must_use]
    pub fn with_gap(mut self, slots: u32) -> Self {
        self.upload.ranges.gap = slots;
        self
    }

    /// More vertices, with these errors and the next numbers: for a front of which it is not known in the beginning how much of it a path
    /// needs.
    ///
    /// # Errors
    /// If there are more than 2^32 - 1 then, or an error is negative or not a number; everything is then as it was.
    pub fn grow(&mut self, errors: &[f32]) -> Result<(), GeometryCacheError> {
        let count = self.vertices() + errors.len();
        if count > MAX_VERTICES {
            return Err(GeometryCacheError::Vertices { count });
        }
        let mut all = (self.vertices()..).zip(errors);
        all.try_for_each(|(vertex, &error)| check_error(vertex, error))?;

        self.table.grow(errors);
        for _ in errors {
            self.front.grow();
            if self.pass.limit() > 0 {
                self.pass.grow();
            }
        }
        Ok(())
    }

    /// Another error for a vertex, for where errors are not all known in the beginning: until then any number will do.
    ///
    /// A policy is told the error of a vertex when its slot opens. So it counts from the next time on that the vertex leaves the front;
    /// give it before the frame that adds the vertex, and it is as if it had been known from the beginning.
    ///
    /// # Errors
    /// If the vertex does not exist, or the error is negative or not a number; everything is then as it was.
    pub fn set_error(&mut self, vertex: u32, error: f32) -> Result<(), GeometryCacheError> {
        self.check("vertices with an error", &[vertex])?;
        check_error(vertex as usize, error)?;
        self.table.errors[vertex as usize] = error;
        Ok(())
    }

    /// The next frame, of an implicit front: exactly these vertices are active. One that is named twice counts once.
    ///
    /// # Complexity
    /// Time O(active vertices of this frame and the last + n log n) for n inserts.
    ///
    /// # Errors
    /// If a vertex does not exist; everything is then as it was.
    pub fn set_active(&mut self, active: &[u32]) -> Result<&Upload, GeometryCacheError> {
        self.check("active vertices", active)?;
        self.start_frame();

        self.front.restart();
        for &vertex in active {
            let was_active = self.front.was_there(vertex);
            if self.front.insert(vertex) && !was_active {
                self.added.push(vertex);
            }
        }
        self.removed.extend(self.front.gone());
        Ok(self.finish_frame())
    }

    /// The next frame, of an explicit front: the first vertices become active, the second ones inactive.
    ///
    /// The lists are sets: to add what is active, or to remove what is not, changes nothing. A vertex in both is active.
    ///
    /// # Complexity
    /// Time O(added + removed + n log n) for n inserts. The first frame after one that was not
    /// [`FrameMode::Cached`], and every frame that is not: O(active) beside.
    ///
    /// # Errors
    /// If a vertex does not exist; everything is then as it was.
    pub fn change(
        &mut self,
        added: &[u32],
        removed: &[u32],
    ) -> Result<&Upload, GeometryCacheError> {
        self.check("added vertices", added)?;
        self.check("removed vertices", removed)?;
        self.start_frame();

        for &vertex in removed {
            if self.front.remove(vertex) {
                self.removed.push(vertex);
            }
        }
        for &vertex in added {
            if self.front.insert(vertex) {
                self.added.push(vertex);
            }
        }

        // What was removed and added again stayed.
        let front = &self.front;
        let stayed = self.removed.iter().copied();
        let mut stayed: Vec<u32> = stayed.filter(|&it| front.place(it).is_some()).collect();
        if !stayed.is_empty() {
            stayed.sort_unstable();
            let has_changed = |vertex: &u32| stayed.binary_search(vertex).is_err();
            self.added.retain(has_changed);
            self.removed.retain(has_changed);
        }
        Ok(self.finish_frame())
    }

    /// What the last frame, or the last pass of it, uploads.
    #[must_use]
    pub fn upload(&self) -> &Upload {
        &self.upload
    }

    /// Where a vertex is for the draws of this frame: its slot, if it is resident. In a streamed frame: its place in
    /// the stream, if it is active.
    #[must_use]
    #[inline]
    pub fn slot(&self, vertex: u32) -> Option<u32> {
        match self.upload.mode {
            FrameMode::Streamed => self.front.place(vertex),
            FrameMode::Cached | FrameMode::Passes => self.table.slot(vertex),
        }
    }

    /// The same for an active vertex only. In a frame that is drawn in passes, any number tells that it is active.
    #[inline]
    pub(super) fn active_slot(&self, vertex: u32) -> Option<u32> {
        match self.upload.mode {
            FrameMode::Cached => self.table.held_slot(vertex),
            FrameMode::Streamed | FrameMode::Passes => self.front.place(vertex),
        }
    }

    /// Whether an active vertex may have got another place: it changes then.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// What all places of the frame are below.
    pub(super) fn place_limit(&self) -> usize {
        match self.upload.mode {
            FrameMode::Streamed => self.front.len(),
            FrameMode::Cached | FrameMode::Passes => self.slots(),
        }
    }

    /// The vertex that a slot has, active or not.
    #[must_use]
    pub fn vertex(&self, slot: u32) -> Option<u32> {
        self.table.vertex(slot)
    }

    /// Whether a vertex is in a slot, active or not.
    #[must_use]
    pub fn is_resident(&self, vertex: u32) -> bool {
        self.table.slot(vertex).is_some()
    }

    /// Whether a vertex is active.
    #[must_use]
    #[inline]
    pub fn is_active(&self, vertex: u32) -> bool {
        self.front.contains(vertex)
    }

    /// The active vertices, in no particular order.
    #[must_use]
    pub fn active(&self) -> &[u32] {
        self.front.as_slice()
    }

    /// How many slots there are.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.table.slots()
    }

    /// How many vertices there are, resident or not.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.table.vertices()
    }

    pub(super) fn check(
        &self,
        list: &'static str,
        vertices: &[u32],
    ) -> Result<(), GeometryCacheError> {
        GeometryCacheError::check(list, vertices, self.vertices())
    }

    /// The memory of all lists that grow.
    #[cfg(test)]
    pub(super) fn capacities(&self) -> [usize; 5] {
        let [list, previous] = self.front.capacities();
        let inserts = self.upload.inserts.capacity();
        [
            self.added.capacity(),
            self.removed.capacity(),
            inserts,
            list,
            previous,
        ]
    }

    fn start_frame(&mut self) {
        self.table.frame = self.table.frame.wrapping_add(1);
        self.table.overruled = 0;
        self.added.clear();
        self.removed.clear();

        self.end_pass();
    }

    /// Opens the slots of what was removed, holds those of what came back, and inserts what is not resident.
    fn finish_frame(&mut self) -> &Upload {
        let is_overfull = self.front.len() > self.table.slots();
        let mode = match (self.is_caching, is_overfull, self.has_passes) {
            (true, false, _) => FrameMode::Cached,
            (true, true, true) => FrameMode::Passes,
            _ => FrameMode::Streamed,
        };
        self.upload.restart(mode);

        for &vertex in &self.removed {
            self.table.release(vertex);
        }
        match mode {
            FrameMode::Cached => self.hold_front(),
            FrameMode::Streamed => self.stream(),
            FrameMode::Passes => self.release_front(),
        }
        self.is_complete = mode == FrameMode::Cached;

        self.upload.finish();
        let statistics = &mut self.upload.statistics;
        statistics.active = self.front.len();
        statistics.added = self.added.len();
        statistics.removed = self.removed.len();
        statistics.overruled = self.table.overruled;
        &self.upload
    }

    /// Inserts what was added; what is active and has no slot yet, if that is more.
    fn hold_front(&mut self) {
        let without_place = match self.is_complete {
            true => &self.added,
            false => self.front.as_slice(),
        };
        self.generation += u64::from(!self.is_complete);

        insert_missing(&mut self.table, without_place, &mut self.upload.inserts);
    }

    /// Sends all active vertices. Those that have slots keep them.
    fn stream(&mut self) {
        self.generation += 1;
        for &vertex in self.added.iter().filter(|_| self.is_caching) {
            self.table.hold(vertex);
        }
        let places = (0..).zip(self.front.as_slice());
        let inserts = places.map(|(slot, &vertex)| Insert { slot, vertex });
        self.upload.inserts.extend(inserts);
    }

    /// Opens the slots of all active vertices, for those of the first pass.
    fn release_front(&mut self) {
        self.generation += 1;
        self.is_complete = false;
        for &vertex in self.front.as_slice() {
            self.table.release(vertex);
        }
    }

    /// Opens all slots. Whether the frame has an odd number.
    pub(super) fn start_passes(&mut self) -> bool {
        match self.pass.limit() {
            0 => self.pass = NumberSet::new(self.vertices()),
            _ => self.end_pass(),
        }
        self.release_front();
        self.upload.restart(FrameMode::Passes);
        self.table.frame % 2 == 1
    }

    fn end_pass(&mut self) {
        for &vertex in self.pass.as_slice() {
            self.table.release(vertex);
        }
        self.pass.restart();
    }

    /// Opens the slots of the last pass that this one does not need, and inserts what this one does.
    pub(super) fn hold_pass(&mut self) {
        self.table.overruled = 0;
        self.upload.restart(FrameMode::Passes);
        for vertex in self.pass.gone() {
            self.table.release(vertex);
        }
        let vertices = self.pass.as_slice();
        insert_missing(&mut self.table, vertices, &mut self.upload.inserts);
        self.upload.finish();
        self.upload.statistics.active = self.pass.len();
        self.upload.statistics.overruled = self.table.overruled;
    }
}

/// Holds the slots of these vertices, and only then inserts those that have none: so none of them is overwritten.
fn insert_missing(table: &mut SlotTable, vertices: &[u32], inserts: &mut Vec<Insert>) {
    for &vertex in vertices {
        if !table.hold(vertex) {
            inserts.push(Insert { slot: 0, vertex });
        }
    }
    for insert in inserts {
        insert.slot = table.insert(insert.vertex);
    }
}

fn check_error(vertex: usize, error: f32) -> Result<(), GeometryCacheError> {
    match error >= 0.0 {
        true => Ok(()),
        false => Err(GeometryCacheError::Error { vertex, error }),
    }
}

fn check_slots(slots: usize) -> Result<(), GeometryCacheError> {
    let most = GeometryCacheError::MOST_SLOTS;
    match (3..=most).contains(&slots) {
        true => Ok(()),
        false => Err(GeometryCacheError::Slots { slots }),
    }
}
