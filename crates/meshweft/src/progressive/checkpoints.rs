//! Orders for some levels, and the sequence in place between them.

use super::progressive_mesh::ProgressiveMesh;
use super::walk::Walk;
use crate::cache::{CacheModel, MIN_CACHE_SIZE};
use crate::error::MeshError;
use crate::faces::Faces;
use crate::index::index32;
use crate::order::{Effort, Optimizer, Target};
use crate::permutation::FaceOrder;

/// Orders made for some levels of a progressive mesh.
///
/// A sequence that is edited in place gets worse with every removal: at half the faces it misses a sixth
/// more than an order of its own would. So orders are stored for levels whose numbers of faces fall by a
/// constant ratio, and each is edited in place only until the next.
///
/// An order that uses a cache to its last entry loses at the first edit. So orders for a FIFO cache of K
/// vertices are best made for K − 1: [`optimized`](Self::optimized) sees to it, and [`new`](Self::new) takes
/// orders of any kind.
///
/// ```
/// use meshweft::progressive::{CheckpointWalk, Checkpoints, Collapses};
/// use meshweft::{CacheModel, Mesh, cache, order::Optimizer};
/// # let positions: Vec<[f32; 3]> = (0..1681_u32).map(|i| {
/// #     let [x, y] = [i % 41, i / 41].map(|i| i as f32 / 10.0);
/// #     [x, y, x.sin() * y.cos()]
/// # }).collect();
/// # let cell = |i: u32| [[i, i + 1, i + 41], [i + 41, i + 1, i + 42]];
/// # let faces: Vec<_> = (0..1640).filter(|i| i % 41 != 40).flat_map(cell).collect();
/// # let mesh = Mesh::new(positions, faces)?;
/// let mesh = mesh.with_face_order(&Optimizer::for_cache(CacheModel::fifo(15)).face_order(&mesh));
/// let progressive = Collapses::default().build(&mesh, &[])?;
/// let optimizer = Optimizer::for_cache(CacheModel::fifo(16));
/// let checkpoints = Checkpoints::optimized(&progressive, 0.8, &optimizer);
///
/// let mut walk = CheckpointWalk::new(&checkpoints);
/// walk.go_to(progressive.level_of_faces(1600));
/// let mut faces = Vec::new();
/// walk.emit(&mut faces);
/// assert_eq!(faces.len(), 1600);
/// assert!(cache::acmr(&faces, CacheModel::fifo(16)) < 0.72);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Checkpoints<'a> {
    pub(super) mesh: &'a ProgressiveMesh,
    /// Fine to coarse; the first is for full resolution.
    pub(super) stored: Vec<Checkpoint>,
}

#[derive(Debug, Clone)]
pub(super) struct Checkpoint {
    pub(super) level: usize,
    /// Numbers of faces in the order of drawing; nothing for the sequence of the mesh itself.
    pub(super) order: Option<Vec<u32>>,
}

impl<'a> Checkpoints<'a> {
    /// Checkpoints at full resolution and wherever the number of faces fell to `ratio` times that of the one
    /// before. `order` is asked for each but the first, which is the sequence of the mesh itself; corners
    /// are not turned.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if an order is of another number of faces.
    ///
    /// # Panics
    /// If `ratio` is not between 0 and 1.
    ///
    /// # Complexity
    /// Time of all orders, which have `ratio` / (1 − `ratio`) times the faces of the full mesh together; space 4
    /// bytes for each of these.
    pub fn new(
        mesh: &'a ProgressiveMesh,
        ratio: f64,
        mut order: impl FnMut(Faces<'_>) -> FaceOrder,
    ) -> Result<Self, MeshError> {
        let mut walk = Walk::new(mesh);
        let full = Checkpoint {
            level: 0,
            order: None,
        };
        let mut stored = vec![full];
        while let Some(level) = next_level(mesh, walk.level(), ratio) {
            walk.go_to(level);
            let (numbers, faces) = present(&walk);
            let order = order(Faces::of_checked(&faces, mesh.vertex_count()));
            if order.len() != faces.len() {
                return Err(MeshError::LengthMismatch {
                    what: "face order",
                    expected: faces.len(),
                    found: order.len(),
                });
            }
            let order = Some(order.permutation().apply(&numbers));
            stored.push(Checkpoint { level, order });
        }
        Ok(Self { mesh, stored })
    }

    /// Checkpoints as by [`new`](Self::new), with the orders of an optimizer, for its target.
    ///
    /// An order for one FIFO, LRU or controllable cache is made for one vertex less, so that it stays good while
    /// it is edited. On few faces an order may be good or bad by chance, so several are tried: two on up to
    /// 65,536 faces, four on up to 16,384, eight on up to 2,048 (effort `fast`: two on up to 16,384), by turns for
    /// one and two vertices less, with other seeds. The order is stored that costs least at the next checkpoint
    /// and half way to it; if the cost of a face would rise by more than a twentieth, the next checkpoint is put
    /// half way. At full resolution the sequence of the mesh itself is the first that is tried.
    ///
    /// # Panics
    /// If `ratio` is not between 0 and 1.
    ///
    /// # Complexity
    /// As [`new`](Self::new), times the tries of levels that have some; for `ratio` .8 and effort `best` about five
    /// times the time of one order of the full mesh, if that has many faces.
    #[must_use]
    pub fn optimized(mesh: &'a ProgressiveMesh, ratio: f64, optimizer: &Optimizer) -> Self {
        let mut walk = Walk::new(mesh);
        let mut stored = Vec::new();
        let mut level = Some(0);
        while let Some(at) = level {
            walk.go_to(at);
            let (numbers, faces) = present(&walk);
            let faces = Faces::of_checked(&faces, mesh.vertex_count());
            let tries = tries(optimizer, faces.len());
            let mut orders: Vec<Option<Vec<u32>>> = (tries.enumerate())
                .map(|(i, tried)| match (at, i) {
                    (0, 0) => None,
                    _ => Some(tried.face_order(faces).permutation().apply(&numbers)),
                })
                .collect();

            level = next_level(mesh, at, ratio);
            let mut order = orders.swap_remove(0);
            if !orders.is_empty() {
                // The least cost; of equals the first.
                let end = level.unwrap_or(mesh.last_level());
                let middle = at.midpoint(end);
                let mut cost = |order: &Option<Vec<u32>>, level: usize| {
                    let order = order.as_ref().unwrap_or(&numbers);
                    cost(&mut walk, order, level, optimizer.target)
                };
                let mut later = |order: &Option<Vec<u32>>| cost(order, middle) + cost(order, end);
                let mut least = later(&order);
                for other in orders {
                    let its = later(&other);
                    if its < least {
                        (order, least) = (other, its);
                    }
                }

                let limit = cost(&order, at) / 20 * 21;
                if cost(&order, end) > limit && middle > at {
                    level = level.map(|_| middle);
                }
            }
            stored.push(Checkpoint { level: at, order });
        }
        Self { mesh, stored }
    }

    /// The levels that have an order, fine to coarse.
    #[must_use]
    pub fn levels(&self) -> Vec<usize> {
        self.stored
            .iter()
            .map(|checkpoint| checkpoint.level)
            .collect()
    }
}

/// The next coarser level with at most `ratio` times the faces.
fn next_level(mesh: &ProgressiveMesh, level: usize, ratio: f64) -> Option<usize> {
    assert!(ratio > 0.0 && ratio < 1.0, "a ratio between 0 and 1");
    let faces = mesh.face_count(level);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "at most the number of faces"
    )]
    let most = (faces as f64 * ratio) as usize;
    let next = mesh.level_of_faces(most.min(faces.saturating_sub(1)));
    // Rounding, or records that take no face away.
    (level < mesh.last_level()).then(|| next.max(level + 1))
}

/// The numbers and the corners of the faces that are there, in the sequence of the mesh.
fn present(walk: &Walk<'_>) -> (Vec<u32>, Vec<[u32; 3]>) {
    let all = 0..index32(walk.mesh().faces().len());
    let numbers: Vec<u32> = all.filter(|&face| walk.has(face)).collect();
    let faces = numbers.iter().map(|&face| walk.face(face)).collect();
    (numbers, faces)
}

/// What orders a level, by its number of faces: several if it has few, of which the best is taken.
fn tries(optimizer: &Optimizer, faces: usize) -> impl Iterator<Item = Optimizer> {
    let count = match (optimizer.effort, faces) {
        (Effort::Fast, 0..=16_384) => 2,
        (Effort::Fast, _) => 1,
        (_, 0..=2_048) => 8,
        (_, 2_049..=16_384) => 4,
        (_, 16_385..=65_536) => 2,
        _ => 1,
    };
    (0..count).map(|i| {
        let target = narrowed(optimizer.target, 1 + i % 2);
        let seeds = if target == optimizer.target { i } else { i / 2 };
        Optimizer {
            target,
            seed: optimizer.seed.wrapping_add(u64::from(seeds)),
            ..optimizer.clone()
        }
    })
}

/// The target with fewer vertices in its cache, if it is a single cache.
fn narrowed(target: Target, by: u32) -> Target {
    let less = |size: u32| size.saturating_sub(by).max(MIN_CACHE_SIZE);
    match target {
        Target::Cache(CacheModel::Fifo { size }) => CacheModel::fifo(less(size)).into(),
        Target::Cache(CacheModel::Lru { size }) => CacheModel::lru(less(size)).into(),
        Target::Cache(CacheModel::Controllable { size }) => {
            CacheModel::controllable(less(size)).into()
        }
        _ => target,
    }
}

/// What a face of a level costs in an order, in 2⁻²⁰ of a miss.
fn cost(walk: &mut Walk<'_>, order: &[u32], level: usize, target: Target) -> u64 {
    let mut faces = Vec::new();
    walk.go_to(level);
    walk.emit_in(order, &mut faces);
    let cost = target.cost(Faces::of_checked(&faces, walk.mesh().vertex_count()));
    (cost << 20) / (faces.len() as u64).max(1)
}
