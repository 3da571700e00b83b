//! One call for every target and effort.

use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::first_use::FirstUse;
use crate::index::index32;
use crate::order::block_faces::{BlockFaces, is_in_blocks};
use crate::order::finish::Finish;
use crate::order::k_cache_reorder::KCacheReorder;
use crate::order::polygons::{check_starts, polygon_of_each_face};
use crate::order::search::{self, Search};
use crate::order::target::{Effort, Target};
use crate::order::universal::Universal;
use crate::parallel;
use crate::permutation::{FaceOrder, Permutation};
use crate::progress::{Budget, Progress};

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
    /// Seed of the search. The same seed gives the same order, on any platform and any number of
    /// threads.
    pub seed: u64,
    /// Forbids turning corners (provoking vertex, data on edges).
    pub keep_corners: bool,
    /// How many steps a search may take.
    pub budget: Budget,
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

    /// The order in which to draw the faces.
    ///
    /// - Universal: among the faces as they are, what a search finds, and the *floor*, which is the order by
    ///   [`linear_speed`](super::baselines::linear_speed()), that of least [cost](Target::cost) that is nowhere above the
    ///   floor: in none of [`Target::UNIVERSAL`], nor in the setup cycles of NVIDIA cards. Floor and search
    ///   are found side by side. Polygons that stay whole have no floor, nor has an order that was stopped.
    /// - FIFO and controllable, fast: [`KCacheReorder`].
    /// - Larger caches than 128 vertices (controllable: 64) are searched as if they had 128 (64): an
    ///   order made for that is nearly as good in a larger cache.
    /// - More than 65,536 vertices that stand in blocks of that many, as
    ///   [`vertex_blocks`](super::vertex_blocks()) numbers them (at most one face in 50 across a border):
    ///   block by block. Universal: the faces across borders come last; `nvidia`: two at the end of a
    ///   batch; others: in the block with two of their vertices.
    /// - `nvidia`, best and max: the search is followed by an exchange of faces between the card's batches,
    ///   which a budget of steps does not limit; polygons that stay whole are not exchanged.
    /// - LRU: as for a FIFO cache of five eighths of the size; made for the whole size, an order
    ///   falls off the edge of an LRU cache.
    ///
    /// # Complexity
    /// Time O(vertices + faces), with a factor that the effort sets. Meshes in blocks are ordered in
    /// parts of a block each, others of more than 262 thousand faces in parts of at least 131 thousand. Around vertices of more than 256
    /// faces the universal order takes the time of its floor. Space: 60 bytes a face of the
    /// whole, and 90 bytes a face of the parts being searched, one a thread.
    #[must_use]
    pub fn face_order<'a>(&self, faces: impl Into<Faces<'a>>) -> FaceOrder {
        self.face_order_with(faces, None, &())
    }

    /// The order in which to draw the faces, with the faces of each polygon kept together and in
    /// their order; faces `starts[i]..starts[i + 1]` are polygon `i`.
    ///
    /// Corners are never turned.
    ///
    /// # Panics
    /// If `starts` does not rise from 0 to the number of faces.
    ///
    /// # Complexity
    /// As [`face_order`](Self::face_order).
    #[must_use]
    pub fn polygon_order<'a>(&self, faces: impl Into<Faces<'a>>, starts: &[u32]) -> FaceOrder {
        self.face_order_with(faces, Some(starts), &())
    }

    /// As [`face_order`](Self::face_order), or with `starts` as
    /// [`polygon_order`](Self::polygon_order), with progress reports, for callers who want to stop
    /// the search or limit its time.
    ///
    /// If stopped, the remaining faces are ordered greedily; the order is complete. A greedy that
    /// does it all in one pass, of about a tenth of a second a million faces, reports only its end and
    /// is not stopped.
    ///
    /// # Panics
    /// As [`polygon_order`](Self::polygon_order).
    ///
    /// # Complexity
    /// As [`face_order`](Self::face_order).
    #[must_use]
    pub fn face_order_with<'a>(
        &self,
        faces: impl Into<Faces<'a>>,
        starts: Option<&[u32]>,
        progress: &dyn Progress,
    ) -> FaceOrder {
        let faces = faces.into();
        if let Some(starts) = starts {
            check_starts(starts, faces.len());
        }

        // One pass, where that is enough.
        let is_timed = progress.time_spent().is_some();
        if !is_timed && let Some(greedy) = self.greedy() {
            let order = match is_in_blocks(faces) {
                true => greedy_by_blocks(&greedy, faces, starts),
                false => greedy_order(&greedy, faces, starts),
            };
            let _ = progress.report(1.0);
            return order;
        }

        let search = Search {
            target: self.target,
            // The time limits it: let it look ahead as far as it can.
            effort: if is_timed { Effort::Max } else { self.effort },
            seed: self.seed,
            keep_corners: self.keep_corners,
            budget: self.budget,
            progress,
        };
        if self.target == Target::Universal && starts.is_none() {
            let is_limited = is_timed || self.budget != Budget::Unlimited;
            let tries = if is_limited { 1 } else { tries(search.effort) };
            return Universal { search, tries }.face_order(faces);
        }
        let order = search.face_order(faces, starts);
        let finish = Finish {
            target: self.target,
            effort: self.effort,
            seed: self.seed,
            keep_corners: self.keep_corners,
            starts,
            progress,
        };
        finish.of(faces, order)
    }

    /// Whether it searches, where nothing limits its time; otherwise a greedy does it all in one pass.
    pub(crate) fn is_search(&self) -> bool {
        self.greedy().is_none()
    }

    /// The greedy that does it all in one pass, where there is one.
    fn greedy(&self) -> Option<KCacheReorder> {
        let cache = match self.target {
            Target::Cache(CacheModel::Lru { size }) => CacheModel::fifo(search::lru_as_fifo(size)),
            Target::Cache(cache @ (CacheModel::Fifo { .. } | CacheModel::Controllable { .. })) => {
                cache
            }
            _ => return None,
        };
        (self.effort == Effort::Fast).then(|| KCacheReorder {
            cache,
            keep_corners: self.keep_corners,
            ..KCacheReorder::default()
        })
    }
}

/// How many searches for the universal order are tried, each with another seed, until one is nowhere above the
/// floor.
fn tries(effort: Effort) -> u64 {
    match effort {
        Effort::Fast => 1,
        Effort::Best => 2,
        Effort::Max => 4,
    }
}

fn greedy_order(greedy: &KCacheReorder, faces: Faces<'_>, starts: Option<&[u32]>) -> FaceOrder {
    match starts {
        Some(starts) => greedy.polygon_order(faces, starts),
        None => greedy.face_order(faces),
    }
}

/// The faces block by block, each block as a mesh of its own.
fn greedy_by_blocks(greedy: &KCacheReorder, faces: Faces<'_>, starts: Option<&[u32]>) -> FaceOrder {
    let polygons = starts.map(polygon_of_each_face);
    let BlockFaces { order, blocks } = BlockFaces::new(faces, polygons.as_deref(), false);

    // Each block with its own vertex numbers; whole polygons follow each other in it.
    let mut numbers = FirstUse::new(faces.vertex_count(), 3 * faces.len());
    let mut start = 0;
    let parts = blocks.iter().map(|ends| {
        let members = &order.new_to_old()[start..ends.all];
        let corners = members.iter().map(|&face| faces.as_slice()[face as usize]);
        let corners = corners.map(|face| face.map(|vertex| numbers.number(vertex)));
        let corners: Vec<[u32; 3]> = corners.collect();
        let starts = polygons.as_ref().map(|polygons| {
            let is_first = |&(_, &face): &(u32, &u32)| polygons[face as usize][0] == face;
            let firsts = (0..).zip(members).filter(is_first).map(|(i, _)| i);
            firsts.chain([index32(members.len())]).collect::<Vec<u32>>()
        });
        let offset = index32(std::mem::replace(&mut start, ends.all));
        (offset, corners, numbers.finish().len(), starts)
    });

    let ordered = parallel::map(
        parts.collect(),
        |(offset, corners, vertex_count, starts)| {
            let faces = Faces::of_checked(&corners, vertex_count);
            (offset, greedy_order(greedy, faces, starts.as_deref()))
        },
    );
    let mut new_to_old = Vec::with_capacity(faces.len());
    let mut rotations = Vec::with_capacity(faces.len());
    for (offset, part) in ordered {
        rotations.extend((0..part.len()).map(|i| part.rotation(i)));
        new_to_old.extend(part.new_to_old().iter().map(|&face| offset + face));
    }
    let joined = FaceOrder::new(Permutation::from_algorithm(new_to_old), rotations);
    FaceOrder::from(order).then(&joined.expect("one rotation below 3 a face"))
}
