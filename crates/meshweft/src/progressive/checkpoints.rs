//! Orders for some levels, and the sequence in place between them.

use super::progressive_mesh::ProgressiveMesh;
use super::walk::Walk;
use crate::error::MeshError;
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::FaceOrder;

/// Orders made for some levels of a progressive mesh.
///
/// A sequence that is edited in place gets worse with every removal: at half the faces it misses a sixth
/// more than an order of its own would. So orders are stored for levels whose numbers of faces fall by a
/// constant ratio, and each is edited in place only until the next. An order that uses a cache to its last
/// entry loses at the first edit; so orders for a FIFO cache of K vertices are best made for K − 1.
///
/// ```
/// use meshweft::progressive::{CheckpointWalk, Checkpoints, Collapses};
/// use meshweft::{CacheModel, Mesh, cache, order::KCacheReorder};
/// # let positions: Vec<[f32; 3]> = (0..1681_u32).map(|i| {
/// #     let [x, y] = [i % 41, i / 41].map(|i| i as f32 / 10.0);
/// #     [x, y, x.sin() * y.cos()]
/// # }).collect();
/// # let cell = |i: u32| [[i, i + 1, i + 41], [i + 41, i + 1, i + 42]];
/// # let faces: Vec<_> = (0..1640).filter(|i| i % 41 != 40).flat_map(cell).collect();
/// # let mesh = Mesh::new(positions, faces)?;
/// let order = KCacheReorder { cache: CacheModel::fifo(15), ..KCacheReorder::default() };
/// let mesh = mesh.with_face_order(&order.face_order(&mesh));
/// let progressive = Collapses::default().build(&mesh, &[])?;
/// let checkpoints = Checkpoints::new(&progressive, 0.8, |faces| order.face_order(faces))?;
///
/// let mut walk = CheckpointWalk::new(&checkpoints);
/// walk.go_to(progressive.level_of_faces(1600));
/// let mut faces = Vec::new();
/// walk.emit(&mut faces);
/// assert_eq!(faces.len(), 1600);
/// assert!(cache::acmr(&faces, CacheModel::fifo(16)) < 0.75);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Checkpoints<'a> {
    mesh: &'a ProgressiveMesh,
    /// Fine to coarse; the first is the mesh itself.
    stored: Vec<Checkpoint>,
}

#[derive(Debug, Clone)]
struct Checkpoint {
    level: usize,
    /// Numbers of faces in the order of drawing; empty at full resolution, which is in its own order.
    order: Vec<u32>,
}

impl<'a> Checkpoints<'a> {
    /// Checkpoints at full resolution and wherever the number of faces fell to `ratio` times that of the one
    /// before. `order` is asked for each but the first; corners are not turned.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if an order is of another number of faces.
    ///
    /// # Panics
    /// If `ratio` is not between 0 and 1.
    ///
    /// # Complexity
    /// Time of all orders, which have 1 / (1 − ratio) times the faces of the full mesh together; space 4
    /// bytes for each of these.
    pub fn new(
        mesh: &'a ProgressiveMesh,
        ratio: f64,
        mut order: impl FnMut(Faces<'_>) -> FaceOrder,
    ) -> Result<Self, MeshError> {
        assert!(ratio > 0.0 && ratio < 1.0, "a ratio between 0 and 1");
        let full = Checkpoint {
            level: 0,
            order: Vec::new(),
        };
        let mut stored = vec![full];
        let mut walk = Walk::new(mesh);
        let mut goal = mesh.faces().len() as f64;
        loop {
            goal *= ratio;
            #[expect(
                clippy::cast_possible_truncation,
                reason = "at most the number of faces"
            )]
            let level = mesh.level_of_faces(goal as usize);
            if level == walk.level() {
                // The last level, or ratios so near 1 that no removal is between.
                if goal < 1.0 || level == mesh.last_level() {
                    break;
                }
                continue;
            }
            walk.go_to(level);
            let numbers = (0..index32(mesh.faces().len())).filter(|&face| walk.has(face));
            let numbers: Vec<u32> = numbers.collect();
            let faces: Vec<[u32; 3]> = numbers.iter().map(|&face| walk.face(face)).collect();
            let order = order(Faces::of_checked(&faces, mesh.vertex_count()));
            if order.len() != faces.len() {
                return Err(MeshError::LengthMismatch {
                    what: "face order",
                    expected: faces.len(),
                    found: order.len(),
                });
            }
            let order = order.permutation().apply(&numbers);
            stored.push(Checkpoint { level, order });
            if level == mesh.last_level() {
                break;
            }
        }
        Ok(Self { mesh, stored })
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

/// A progressive mesh at a level that changes, drawn in the order of the nearest finer checkpoint.
///
/// On the way to coarser levels it goes on with an order for 2 % of the faces beyond the next checkpoint, so
/// that a level which goes to and fro there does not change the whole sequence each time.
#[derive(Debug, Clone)]
pub struct CheckpointWalk<'a> {
    checkpoints: &'a Checkpoints<'a>,
    walk: Walk<'a>,
    current: usize,
}

/// The share of its faces for which a checkpoint waits.
const HYSTERESIS: usize = 50;

impl<'a> CheckpointWalk<'a> {
    /// At full resolution.
    #[must_use]
    pub fn new(checkpoints: &'a Checkpoints<'a>) -> Self {
        Self {
            checkpoints,
            walk: Walk::new(checkpoints.mesh),
            current: 0,
        }
    }

    /// The level that the faces have.
    #[must_use]
    pub fn level(&self) -> usize {
        self.walk.level()
    }

    /// The level of the checkpoint whose order is used.
    #[must_use]
    pub fn checkpoint(&self) -> usize {
        self.checkpoints.stored[self.current].level
    }

    /// Goes to a level; returns whether the faces are now drawn in the order of another checkpoint.
    ///
    /// # Complexity
    /// Time O(removals between + checkpoints); no memory.
    ///
    /// # Panics
    /// If there is no such level.
    pub fn go_to(&mut self, level: usize) -> bool {
        self.walk.go_to(level);
        let (mesh, stored) = (self.checkpoints.mesh, &self.checkpoints.stored);
        let before = self.current;
        while stored[self.current].level > level {
            self.current -= 1;
        }
        let faces = mesh.face_count(level);
        while let Some(next) = stored.get(self.current + 1)
            && next.level <= level
            && (faces + next.order.len() / HYSTERESIS <= next.order.len()
                || level == mesh.last_level())
        {
            self.current += 1;
        }
        before != self.current
    }

    /// Writes the faces of the level to `out`, in the order of drawing.
    ///
    /// # Complexity
    /// Time O(faces of the checkpoint); memory only if `out` is too small.
    pub fn emit(&self, out: &mut Vec<[u32; 3]>) {
        let checkpoint = &self.checkpoints.stored[self.current];
        if checkpoint.level == 0 {
            return self.walk.emit(out);
        }
        out.clear();
        out.resize(self.checkpoints.mesh.face_count(self.level()) + 1, [0; 3]);
        let mut at = 0;
        for &face in &checkpoint.order {
            out[at] = self.walk.face(face);
            at += usize::from(self.walk.has(face));
        }
        out.truncate(at);
    }
}
