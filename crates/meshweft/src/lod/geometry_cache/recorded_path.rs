//! A path of the eye as the changes of the front, to replay and to bound.

use super::cache_error::GeometryCacheError;
use super::number_set::NumberSet;

/// What each frame of a path adds and removes: every cache gets the same, and the optimum knows the whole.
///
/// ```
/// use meshweft::lod::geometry_cache::{EvictionPolicy, GeometryCache, RecordedPath};
/// let mut path = RecordedPath::new(5);
/// for active in [[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 2]] {
///     path.push_active(&active)?;
/// }
/// let inserts = |eviction| -> Result<usize, Box<dyn std::error::Error>> {
///     let mut cache = GeometryCache::new(4, vec![1.0; 5], eviction)?;
///     let mut inserts = 0;
///     for (added, removed) in path.frames() {
///         inserts += cache.change(added, removed)?.statistics().inserts;
///     }
///     Ok(inserts)
/// };
/// assert_eq!(inserts(EvictionPolicy::Nothing)?, 12);
/// assert_eq!(inserts(EvictionPolicy::OldestFirst)?, 6);
/// assert_eq!((path.fewest_inserts(4), path.distinct_vertices()), (Some(5), 5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RecordedPath {
    front: NumberSet,
    was_active: Vec<bool>,
    /// The changes of all frames, of each first what it adds.
    changes: Vec<u32>,
    /// Where in the changes a frame has what it removes, and where it ends.
    frames: Vec<[usize; 2]>,
    most_active: usize,
}

impl RecordedPath {
    /// A path without frames, of vertices with numbers below a count, which is at most 2^32 - 1.
    #[must_use]
    pub fn new(vertices: usize) -> Self {
        Self {
            front: NumberSet::new(vertices),
            was_active: vec![false; vertices],
            changes: Vec::new(),
            frames: Vec::new(),
            most_active: 0,
        }
    }

    /// More vertices, with the next numbers.
    pub fn grow(&mut self, vertices: usize) {
        (0..vertices).for_each(|_| self.front.grow());
        self.was_active.resize(self.front.limit(), false);
    }

    /// Adds a frame in which exactly these vertices are active.
    ///
    /// # Errors
    /// If a vertex does not exist; nothing is then added.
    pub fn push_active(&mut self, active: &[u32]) -> Result<(), GeometryCacheError> {
        GeometryCacheError::check("active vertices", active, self.front.limit())?;
        self.front.restart();
        for &vertex in active {
            let was_there = self.front.was_there(vertex);
            if self.front.insert(vertex) && !was_there {
                self.changes.push(vertex);
            }
        }
        let added = self.changes.len();
        self.changes.extend(self.front.gone());
        self.finish_frame(added);
        Ok(())
    }

    /// Adds a frame by what becomes active and what becomes inactive, read as by
    /// [`GeometryCache::change`](super::GeometryCache::change).
    ///
    /// # Errors
    /// If a vertex does not exist; nothing is then added.
    pub fn push_change(
        &mut self,
        added: &[u32],
        removed: &[u32],
    ) -> Result<(), GeometryCacheError> {
        GeometryCacheError::check("added vertices", added, self.front.limit())?;
        GeometryCacheError::check("removed vertices", removed, self.front.limit())?;
        let mut left: Vec<u32> = removed.to_vec();
        left.retain(|&vertex| self.front.remove(vertex));
        let came = added.iter().filter(|&&vertex| self.front.insert(vertex));
        self.changes.extend(came);
        let added = self.changes.len();
        self.changes.extend(left);
        self.finish_frame(added);
        Ok(())
    }

    fn finish_frame(&mut self, added: usize) {
        let start = self.frames.last().map_or(0, |&[_, end]| end);
        for &vertex in &self.changes[start..added] {
            self.was_active[vertex as usize] = true;
        }
        self.frames.push([added, self.changes.len()]);
        self.most_active = self.most_active.max(self.front.len());
    }

    /// What each frame adds and what it removes.
    pub fn frames(&self) -> impl DoubleEndedIterator<Item = (&[u32], &[u32])> {
        (0..self.frames.len()).map(|frame| {
            let start = frame.checked_sub(1).map_or(0, |last| self.frames[last][1]);
            let [removed, end] = self.frames[frame];
            (&self.changes[start..removed], &self.changes[removed..end])
        })
    }

    /// How many frames there are.
    #[must_use]
    pub fn frame_count(&self) -> usize {
        self.frames.len()
    }

    /// How many vertices are active at most.
    #[must_use]
    pub fn most_active(&self) -> usize {
        self.most_active
    }

    /// How many vertices are active at some time: no cache needs fewer inserts, however large it is.
    #[must_use]
    pub fn distinct_vertices(&self) -> usize {
        self.was_active
            .iter()
            .filter(|&&was_active| was_active)
            .count()
    }

    /// How many vertices are active, summed over the frames: the inserts of a standard vertex array.
    #[must_use]
    pub fn all_active(&self) -> u64 {
        let mut active = 0;
        let count = |(added, removed): (&[u32], &[u32])| {
            active = active + added.len() as u64 - removed.len() as u64;
            active
        };
        self.frames().map(count).sum()
    }

    pub(super) fn vertices(&self) -> usize {
        self.was_active.len()
    }
}
