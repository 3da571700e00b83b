//! Recursive cut: half of the mesh, then the other half, and the same within each.
//!
//! The paper draws one half, then the faces along the cut, then the other half, and wants the exit
//! from the first to be near the entry into the second. Where it leaves room:
//! - *What is cut*: the dual graph, so that each face is in one half.
//! - *Pieces*: sixteen faces or less are drawn as K-Cache-Reorder for a FIFO cache of 12 would.
//! - *Which half is first, and from which end*: from the pieces up, the best of all eight ways to
//!   draw two halves one after the other, by simulating what the second one finds in caches of 10,
//!   12, 16 and 64 ([`seam`](super::seam)). This is worth more than better cuts.

use super::cut_tree::{CutTree, Cutter, Cutting};
use super::seam::{PartSequence, SeamCaches};
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::order::k_cache_reorder::KCacheReorder;
use crate::order::turn_corners::turn_corners;
use crate::parallel;
use crate::partition::Graph;
use crate::permutation::{FaceOrder, Permutation};

/// A rendering sequence by recursive cut (Bogomjakov & Gotsman 2002).
///
/// ```
/// use meshweft::{CacheModel, Mesh, cache, order::{baselines, bogomjakov_gotsman::RecursiveCut}};
/// let strip = |i: u32| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] };
/// let faces = baselines::random(100, 1).apply(&(0..100).map(strip).collect::<Vec<_>>());
/// let mesh = Mesh::connectivity_only(102, faces)?;
/// let after = mesh.with_face_order(&RecursiveCut::default().face_order(&mesh));
/// assert_eq!(cache::misses(after.faces(), CacheModel::fifo(10)), 102);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RecursiveCut {
    /// Pieces of at most this many faces are not cut further.
    pub piece: u32,
    /// Which algorithm finds the cuts.
    pub cutter: Cutter,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Forbids turning corners.
    pub keep_corners: bool,
}

impl Default for RecursiveCut {
    fn default() -> Self {
        Self {
            piece: 16,
            cutter: Cutter::default(),
            seed: 0,
            keep_corners: false,
        }
    }
}

/// The halves of a tree of more faces are joined on two threads.
const ALONE: usize = 1 << 16;

impl RecursiveCut {
    /// The order in which to draw the faces.
    ///
    /// Corners are turned so that hits come first in a FIFO cache of 12, unless that is forbidden.
    ///
    /// # Complexity
    /// Time O(faces · log faces), space 150 bytes a face.
    #[must_use]
    pub fn face_order<'a>(&self, faces: impl Into<Faces<'a>>) -> FaceOrder {
        let faces = faces.into();

        // Faces are numbered in the greedy's order, so that pieces are drawn in that order.
        let inside = KCacheReorder {
            cache: CacheModel::fifo(12),
            keep_corners: true,
            ..KCacheReorder::default()
        };
        let inside = inside.face_order(faces);
        let in_order = inside.apply(faces.as_slice());
        let in_order = Faces::of_checked(&in_order, faces.vertex_count());

        let graph = Graph::dual(in_order);
        let cutting = Cutting {
            piece: self.piece,
            seed: self.seed,
            cutter: self.cutter,
        };
        let tree = CutTree::new(&graph, &cutting);

        let sequence = Join { faces: in_order }.apart(tree).faces;
        let order = Permutation::from_algorithm(sequence);
        let order = inside.then(&order.into());
        match self.keep_corners {
            true => order,
            false => turn_corners(faces, &order, CacheModel::fifo(12)),
        }
    }
}

/// Joins the halves of a tree, from the pieces up.
struct Join<'a> {
    faces: Faces<'a>,
}

impl Join<'_> {
    fn caches(&self) -> SeamCaches<'_> {
        SeamCaches::new(self.faces)
    }

    /// The sequence of a tree, with large halves on threads of their own.
    fn apart(&self, tree: CutTree) -> PartSequence {
        match tree {
            CutTree::Cut(halves, len) if len > ALONE => {
                let halves: [CutTree; 2] = *halves;
                let halves = parallel::map(halves.into(), |half| self.apart(half));
                let mut caches = self.caches();
                let join = |a, b| caches.joined([a, b]);
                halves.into_iter().reduce(join).expect("two halves")
            }
            tree => together(tree, &mut self.caches()),
        }
    }
}

/// The sequence of a tree, on one thread.
fn together(tree: CutTree, caches: &mut SeamCaches<'_>) -> PartSequence {
    match tree {
        CutTree::Piece(faces) => caches.sequence(faces),
        CutTree::Cut(halves, _) => {
            let pair = halves.map(|half| together(half, caches));
            caches.joined(pair)
        }
    }
}
