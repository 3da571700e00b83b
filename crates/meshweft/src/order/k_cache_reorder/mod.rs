//! K-Cache-Reorder: finish one vertex after the other, each time the cheapest.
//!
//! Gang Lin, Thomas P.-Y. Yu: *An Improved Vertex Caching Scheme for 3D Mesh Rendering*, IEEE
//! Transactions on Visualization and Computer Graphics 12(4), 2006, doi:10.1109/TVCG.2006.59.
//!
//! A vertex is *white* (not in the cache, faces left to draw), *gray* (in the cache) or *black*
//! (all its faces are drawn). Each step chooses a gray vertex as the *focus* and draws all its
//! remaining faces, which pushes their white corners and turns it black. The focus is the vertex
//! of least cost `C = k1·C1 − k2·C2 + k3·C3`: `C1` pushes that finishing it takes, `C2` faces that
//! it draws, `C3` its distance from the front of the cache afterwards, as a share of the size.
//!
//! # Where the paper leaves room
//! Choices of [`Mode::Faithful`], each the plainest reading that meets the paper's tables:
//! - The sign of `C2` is minus ("the more faces rendered, the lower cost"); plus or nothing is
//!   .01 to .04 worse.
//! - FIFO: `C1` counts every push of a tentative run, also of vertices that the run evicts and
//!   pushes again. A push may evict a vertex of the face being drawn, so corners are pushed until
//!   all three are there. `C3` is `(K − age) / K` after the run, age in pushes.
//! - A black vertex keeps its place until it reaches the front. Dropping it there (step 17) does
//!   not change what else is in the cache, so it is left out.
//! - Controllable: `C1` is the number of distinct white neighbours, without a run. On a full buffer
//!   the vertex of greatest current cost leaves, except those of the face and those pushed since
//!   the focus was chosen, **ties to the newest**: this detail is worth .02, and the paper's
//!   figures show which reading is meant. Black vertices leave at once.
//! - Ties of the focus go to the front. With no gray vertex left, the focus is the white vertex of
//!   least degree (all its faces, drawn or not) that is first in the file.
//! - FIFO: a vertex's faces are drawn clockwise from the first in the file, a non-manifold fan in
//!   pieces. Controllable: in file order. The paper says clockwise, but its controllable column
//!   agrees with file order only (mesh *eight*: printed .635, file order .640, clockwise .665), its
//!   FIFO column with clockwise only (.633; file order .622, clockwise .630).
//! - A vertex with more than 4096 faces left is not run; it waits until no other is gray. A run for
//!   it at every step would take too long, and it would be chosen last anyway.
//! - Step 14 (draw at once whatever else has become drawable) is left out: it does not change the
//!   mean push count and, unless each push is checked again, lets the assumed cache drift from the
//!   real one.
//!
//! [`Mode::Fast`] departs from the paper where that is faster or better. Only the oldest few live
//! vertices are candidates. Corners are turned so that hits come first, which makes the pushes it
//! counts equal to a hardware replay. Dead ends go to the vertex with the fewest *remaining* faces.
//! In a controllable cache the vertex that is needed last leaves (`fast_controllable`). Read
//! `fast_fifo` for how it avoids running every candidate.

mod faithful;
mod fast_controllable;
mod fast_fifo;
#[cfg(test)]
mod oracle;
mod task;
mod tentative;

use std::fmt;

use crate::cache::{CacheEvent, CacheModel, MIN_CACHE_SIZE, Schedule};
use crate::faces::Faces;
use crate::index::index32;
use crate::order::greedy::Costs;
use crate::order::polygons::{check_starts, polygon_of_each_face};
use crate::permutation::{FaceOrder, Permutation};
use faithful::Evictions;
use task::Task;

/// How closely [`KCacheReorder`] follows the paper.
///
/// Written as `fast`, `faithful`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Mode {
    /// Faster and better than the paper; the default.
    #[default]
    Fast,
    /// The plain reading of the paper, to compare with its tables. Corners are never turned.
    Faithful,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Fast => "fast",
            Self::Faithful => "faithful",
        })
    }
}

/// A rendering sequence by K-Cache-Reorder (Lin & Yu 2006).
///
/// ```
/// use meshweft::{CacheModel, Mesh, cache, order::KCacheReorder};
/// // A strip of 100 faces whose file order alternates between its ends.
/// let strip = |i: u32| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
/// let faces: Vec<_> = (0..50).flat_map(|i| [strip(i), strip(99 - i)]).collect();
/// let mesh = Mesh::connectivity_only(102, faces)?;
/// let algorithm = KCacheReorder { cache: CacheModel::fifo(16), ..Default::default() };
/// let order = algorithm.face_order(&mesh);
/// let after = mesh.with_face_order(&order);
/// assert_eq!(cache::misses(after.faces(), CacheModel::fifo(16)), 102);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct KCacheReorder {
    /// The cache to order for: FIFO or controllable.
    pub cache: CacheModel,
    /// Fast or faithful.
    pub mode: Mode,
    /// Weight of a push.
    pub k1: f64,
    /// Weight of a face drawn.
    pub k2: f64,
    /// Weight of the distance from the front of a FIFO cache. The controllable cache has none.
    pub k3: f64,
    /// Forbids turning corners (provoking vertex, data on edges). Pushes are then counted in file
    /// order of the corners, as hardware does.
    pub keep_corners: bool,
    /// The vertex to start from, instead of what the mode would choose.
    pub first_focus: Option<u32>,
}

impl Default for KCacheReorder {
    /// FIFO of 12 entries, fast, the paper's weights (1, 0.5, 1.3).
    ///
    /// The size is small because an order made for a larger cache than the device has is bad, while
    /// one made for a smaller cache loses little.
    fn default() -> Self {
        Self {
            cache: CacheModel::fifo(12),
            mode: Mode::Fast,
            k1: 1.0,
            k2: 0.5,
            k3: 1.3,
            keep_corners: false,
            first_focus: None,
        }
    }
}

impl KCacheReorder {
    /// The order in which to draw the faces.
    ///
    /// Weights are rounded to thousandths and clamped to ±1024.
    ///
    /// # Panics
    /// If [`cache`](Self::cache) is neither FIFO nor controllable, or `first_focus` names no
    /// vertex.
    ///
    /// # Complexity
    /// Fast: time O(vertices + faces) for any cache size; space 16 bytes a vertex and 13 a face
    /// in addition to the result.
    /// Faithful: O(K · vertices) tentative runs.
    #[must_use]
    pub fn face_order<'a>(&self, faces: impl Into<Faces<'a>>) -> FaceOrder {
        self.ordered(faces.into(), |_| {})
    }

    /// The order in which to draw the faces, with the faces of each polygon kept together and in
    /// their order; faces `starts[i]..starts[i + 1]` are polygon `i`.
    ///
    /// The fast mode for a FIFO cache draws whole polygons; otherwise a polygon is drawn where the
    /// first of its faces would be. Corners are never turned.
    ///
    /// # Panics
    /// As [`face_order`](Self::face_order), or if `starts` does not rise from 0 to the number of
    /// faces.
    ///
    /// # Complexity
    /// As [`face_order`](Self::face_order), and 8 more bytes a face.
    ///
    /// ```
    /// use meshweft::{CacheModel, Mesh, cache, order::KCacheReorder};
    /// // A ladder of 50 squares, cut in two faces each, that jumps between its ends.
    /// let square = |i: u32| [[2 * i, 2 * i + 1, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 2]];
    /// let faces: Vec<_> = (0..25).flat_map(|i| [square(i), square(49 - i)]).flatten().collect();
    /// let starts: Vec<u32> = (0..=50).map(|i| 2 * i).collect();
    /// let mesh = Mesh::connectivity_only(102, faces)?;
    /// let algorithm = KCacheReorder { cache: CacheModel::fifo(8), ..Default::default() };
    /// let order = algorithm.polygon_order(&mesh, &starts);
    /// assert!(order.new_to_old().chunks(2).all(|faces| faces[0] + 1 == faces[1]));
    /// let after = mesh.with_face_order(&order);
    /// assert_eq!(cache::misses(after.faces(), CacheModel::fifo(8)), 102);
    /// # Ok::<(), meshweft::MeshError>(())
    /// ```
    #[must_use]
    pub fn polygon_order<'a>(&self, faces: impl Into<Faces<'a>>, starts: &[u32]) -> FaceOrder {
        let faces = faces.into();
        check_starts(starts, faces.len());
        let (CacheModel::Fifo { size }, Mode::Fast) = (self.cache, self.mode) else {
            return whole_polygons(&self.face_order(faces), starts);
        };
        fast_fifo::polygon_order(
            &self.task(faces, size, self.k3),
            &polygon_of_each_face(starts),
        )
    }

    /// The order and, for a controllable cache, the schedule of pushes and pops that goes with it.
    ///
    /// For a FIFO cache in fast mode the schedule is empty: the hardware decides.
    ///
    /// # Panics
    /// As [`face_order`](Self::face_order).
    #[must_use]
    pub fn schedule<'a>(&self, faces: impl Into<Faces<'a>>) -> (FaceOrder, Schedule) {
        let mut events = Vec::new();
        let order = self.ordered(faces.into(), |event| events.push(event));
        (order, Schedule { events })
    }

    fn ordered(&self, faces: Faces<'_>, record: impl FnMut(CacheEvent)) -> FaceOrder {
        let (evictions, size) = match self.cache {
            CacheModel::Fifo { size } => (Evictions::Fifo, size),
            CacheModel::Controllable { size } => (Evictions::Controllable, size),
            other => panic!("K-Cache-Reorder orders for fifo:K and controllable:K, not {other}"),
        };
        let k3 = match evictions {
            Evictions::Fifo => self.k3,
            Evictions::Controllable => 0.0,
        };
        let task = self.task(faces, size, k3);
        match (self.mode, evictions) {
            (Mode::Faithful, evictions) => faithful::face_order(&task, evictions, record),
            (Mode::Fast, Evictions::Controllable) => fast_controllable::face_order(&task, record),
            (Mode::Fast, Evictions::Fifo) => fast_fifo::face_order(&task, self.keep_corners),
        }
    }

    fn task<'a>(&self, faces: Faces<'a>, size: u32, k3: f64) -> Task<'a> {
        let vertex_count = index32(faces.vertex_count());
        if let Some(focus) = self.first_focus {
            assert!(
                focus < vertex_count,
                "the first focus {focus} names no vertex"
            );
        }
        Task {
            faces,
            costs: Costs::new(self.k1, self.k2, k3, size),
            // A cache that holds all vertices never evicts one, so a larger cache changes nothing.
            size: size.min(vertex_count).max(MIN_CACHE_SIZE),
            first_focus: self.first_focus,
        }
    }
}

/// The whole polygons, in the order in which `order` draws the first face of each.
fn whole_polygons(order: &FaceOrder, starts: &[u32]) -> FaceOrder {
    let mut placed = vec![false; starts.len()];
    let mut faces = Vec::with_capacity(order.len());
    for &face in order.new_to_old() {
        let polygon = starts.partition_point(|&start| start <= face) - 1;
        if !std::mem::replace(&mut placed[polygon], true) {
            faces.extend(starts[polygon]..starts[polygon + 1]);
        }
    }
    Permutation::from_algorithm(faces).into()
}
