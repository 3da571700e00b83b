//! One call for every target and effort: [`Optimizer`].
//!
//! K-Cache-Reorder ([`KCacheReorder`]) is a greedy: it takes the vertex that is cheapest to finish
//! and sees the price of a bad choice only when it is paid, about a cache's length of pushes later.
//! *Rollouts* look that far ahead. From where the sequence stands, several continuations of a few
//! dozen vertices are run, each with other noise on the costs; the one that evicts least unfinished
//! work for the faces that it draws is kept for its first quarter, its tail competes again in the
//! next round. Evictions of unfinished vertices are the right count: each is exactly one more miss
//! to come, so all misses are used vertices plus such evictions. (Rolling-horizon search; D. P.
//! Bertsekas, J. N. Tsitsiklis, C. Wu: *Rollout Algorithms for Combinatorial Optimization*, Journal
//! of Heuristics 3, 1997, doi:10.1023/A:1009635226865.)
//!
//! The same traversal serves all targets; what differs is which caches are modelled and how their
//! evictions are weighed (`preset`). Batches are modelled as the GPU starts them, so an order stays
//! aligned with them from the first face to the last. The *universal* target models a small FIFO
//! cache and a batch side by side and also counts vertices that drop out of longer windows.
//!
//! Read `rollout` for the loop, `state` for how a run is taken back, `parts` for threads.

mod mask;
mod parts;
mod preset;
mod rollout;
mod slabs;
mod state;

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use crate::cache::{self, CacheModel, ParseCacheModelError};
use crate::mesh::Mesh;
use crate::order::{KCacheReorder, check_starts};
use crate::permutation::FaceOrder;

/// What an order is to be good for.
///
/// Written and read as `universal` or as a [`CacheModel`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Target {
    /// Every cache size and every GPU at once: for files whose device is not known.
    #[default]
    Universal,
    /// One cache.
    Cache(CacheModel),
}

impl Target {
    /// The caches that [`Universal`](Self::Universal) is judged by: FIFO caches of 10 to 64
    /// vertices and the batches of three GPUs.
    pub const UNIVERSAL: [CacheModel; 9] = [
        CacheModel::fifo(10),
        CacheModel::fifo(12),
        CacheModel::fifo(16),
        CacheModel::fifo(24),
        CacheModel::fifo(32),
        CacheModel::fifo(64),
        CacheModel::NVIDIA,
        CacheModel::AMD,
        CacheModel::INTEL,
    ];

    /// The caches that it stands for.
    #[must_use]
    pub fn models(&self) -> &[CacheModel] {
        match self {
            Self::Universal => &Self::UNIVERSAL,
            Self::Cache(model) => std::slice::from_ref(model),
        }
    }

    /// Misses of this order, added up over [`models`](Self::models).
    ///
    /// # Complexity
    /// One [`cache::misses`] a model.
    #[must_use]
    pub fn misses(&self, faces: &[[u32; 3]]) -> u64 {
        let misses = |&model| cache::misses(faces, model);
        self.models().iter().map(misses).sum()
    }
}

impl From<CacheModel> for Target {
    fn from(model: CacheModel) -> Self {
        Self::Cache(model)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Universal => f.write_str("universal"),
            Self::Cache(model) => model.fmt(f),
        }
    }
}

impl FromStr for Target {
    type Err = ParseTargetError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "universal" => Ok(Self::Universal),
            _ => text.parse().map(Self::Cache).map_err(ParseTargetError),
        }
    }
}

/// Why a text names no [`Target`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseTargetError(ParseCacheModelError);

impl fmt::Display for ParseTargetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, or universal", self.0)
    }
}

impl std::error::Error for ParseTargetError {}

/// How much time an order is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
#[non_exhaustive]
pub enum Effort {
    /// One greedy pass; for the universal target the best of three continuations.
    #[default]
    Fast,
    /// A search of about twenty times that.
    Best,
    /// A search of some two or three hundred times that.
    Max,
}

/// The order of a mesh's faces for a [`Target`], at an [`Effort`].
///
/// ```
/// use meshweft::{CacheModel, Mesh, cache, order::{Effort, Optimizer, baselines}};
/// // A strip of 100 faces, shuffled.
/// let strip = |i: u32| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
/// let faces = baselines::random(100, 1).apply(&(0..100).map(strip).collect::<Vec<_>>());
/// let mesh = Mesh::connectivity_only(102, faces)?;
/// let optimizer = Optimizer { effort: Effort::Best, ..Optimizer::for_cache(CacheModel::fifo(16)) };
/// let after = mesh.with_face_order(&optimizer.face_order(&mesh));
/// assert_eq!(cache::misses(after.faces(), CacheModel::fifo(16)), 102);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Optimizer {
    /// What the order is to be good for.
    pub target: Target,
    /// How much time it is worth.
    pub effort: Effort,
    /// Where the random numbers of a search start. The same seed gives the same order, on any
    /// platform and any number of threads.
    pub seed: u64,
    /// Forbids turning corners (provoking vertex, data on edges).
    pub keep_corners: bool,
    /// Searches for about this long, whatever the effort. The order then depends on the machine.
    pub time_budget: Option<Duration>,
}

impl Optimizer {
    /// For one cache, fast.
    #[must_use]
    pub fn for_cache(model: CacheModel) -> Self {
        Self {
            target: model.into(),
            ..Self::default()
        }
    }

    /// The order in which to draw the faces of `mesh`.
    ///
    /// - FIFO and controllable, fast: [`KCacheReorder`].
    /// - Larger caches than 128 vertices are searched as if they had 128: nothing is lost by a
    ///   larger cache than an order was made for.
    /// - LRU: as for a FIFO cache of five eighths of the size; made for the whole size, an order
    ///   falls off the edge of an LRU cache.
    ///
    /// # Complexity
    /// Time O(vertices + faces), with a factor that the effort sets. Meshes of more than 262 thousand
    /// faces are cut in parts of at least 131 thousand; space 90 bytes a face of the parts at work,
    /// one a thread, beside 40 bytes a face of the whole.
    #[must_use]
    pub fn face_order(&self, mesh: &Mesh) -> FaceOrder {
        match self.greedy() {
            Some(greedy) => greedy.face_order(mesh),
            None => parts::face_order(mesh, None, self),
        }
    }

    /// The order in which to draw the faces of `mesh` so that those of a polygon stay together, one
    /// after the other as they are; faces `starts[i]..starts[i + 1]` are polygon `i`.
    ///
    /// Corners are never turned.
    ///
    /// # Panics
    /// If `starts` does not rise from 0 to the number of faces.
    ///
    /// # Complexity
    /// As [`face_order`](Self::face_order).
    #[must_use]
    pub fn polygon_order(&self, mesh: &Mesh, starts: &[u32]) -> FaceOrder {
        check_starts(starts, mesh);
        match self.greedy() {
            Some(greedy) => greedy.polygon_order(mesh, starts),
            None => parts::face_order(mesh, Some(starts), self),
        }
    }

    /// The greedy that does it all, where there is one.
    fn greedy(&self) -> Option<KCacheReorder> {
        let is_fast = self.effort == Effort::Fast && self.time_budget.is_none();
        let cache = match self.target {
            Target::Cache(CacheModel::Lru { size }) => CacheModel::fifo(preset::lru_as_fifo(size)),
            Target::Cache(cache @ (CacheModel::Fifo { .. } | CacheModel::Controllable { .. })) => {
                cache
            }
            _ => return None,
        };
        is_fast.then(|| KCacheReorder {
            cache,
            keep_corners: self.keep_corners,
            ..KCacheReorder::default()
        })
    }
}
