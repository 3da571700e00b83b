//! Every ordering method by name, for comparison.

use std::fmt;

use super::options::Greedy;
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::mesh::Mesh;
pub use crate::order::InBatches;
pub use crate::order::bogomjakov_gotsman::linear_arrangement_cost;
use crate::order::bogomjakov_gotsman::{LinearArrangement, RecursiveCut};
use crate::order::{Effort, Grid, KCacheReorder, Mode, Optimizer, Target, baselines, vertex_fetch};
use crate::permutation::{FaceOrder, Permutation};

/// A way to order the faces of any mesh.
///
/// Its name says what it is; as text it also says for which cache.
///
/// ```
/// use meshweft::{CacheModel, operations::Method};
/// let method = Method::Tipsify { size: 12 };
/// assert_eq!((method.name(), method.to_string()), ("Tipsify", "Tipsify, K = 12".to_owned()));
/// assert_eq!(method.order(&[[0, 1, 2], [2, 1, 3]]).len(), 2);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Method {
    /// The order that the mesh has.
    AsItIs,
    /// A random order.
    Random {
        /// Where the random numbers start.
        seed: u64,
    },
    /// Sander, Nehab, Barczak 2007, for a FIFO cache.
    Tipsify {
        /// Cache size in vertices.
        size: u32,
    },
    /// Forsyth 2006, with the scores of meshoptimizer's `optimizeVertexCache`: its order.
    LinearSpeed,
    /// Lin, Yu 2006.
    KCacheReorder {
        /// The cache to order for: FIFO or controllable.
        cache: CacheModel,
        /// Its settings.
        greedy: Greedy,
        /// The vertex to start from, instead of what the mode would choose.
        first_focus: Option<u32>,
    },
    /// Bogomjakov, Gotsman 2002, oriented by what is near the cuts.
    RecursiveCut,
    /// The same, oriented by minimum linear arrangement.
    LinearArrangement,
    /// The search for all caches at once.
    Universal {
        /// How much time it is worth.
        effort: Effort,
    },
}

impl Method {
    /// Those that are shown next to each other: the baselines, the greedy, the papers' and the
    /// search's orders for all caches.
    pub const SHOWN: [Self; 10] = [
        Self::Random { seed: 7 },
        Self::Tipsify { size: 12 },
        Self::LinearSpeed,
        Self::k_cache_reorder(12, Mode::Faithful),
        Self::k_cache_reorder(12, Mode::Fast),
        Self::k_cache_reorder(32, Mode::Fast),
        Self::RecursiveCut,
        Self::LinearArrangement,
        Self::Universal {
            effort: Effort::Fast,
        },
        Self::Universal {
            effort: Effort::Best,
        },
    ];

    /// K-Cache-Reorder for a FIFO cache, with the paper's weights.
    ///
    /// # Panics
    /// If `size` is below 3: no face fits.
    #[must_use]
    pub const fn k_cache_reorder(size: u32, mode: Mode) -> Self {
        Self::KCacheReorder {
            cache: CacheModel::fifo(size),
            greedy: Greedy {
                mode,
                k1: None,
                k2: None,
                k3: None,
            },
            first_focus: None,
        }
    }

    /// The order in which to draw the faces.
    ///
    /// # Panics
    /// If the cache of K-Cache-Reorder is neither FIFO nor controllable, or its first focus names no
    /// vertex.
    #[must_use]
    pub fn order<'a>(&self, faces: impl Into<Faces<'a>>) -> FaceOrder {
        let faces = faces.into();
        match *self {
            Self::AsItIs => FaceOrder::identity(faces.len()),
            Self::Random { seed } => Permutation::random(faces.len(), seed).into(),
            Self::Tipsify { size } => baselines::tipsify(faces, size),
            Self::LinearSpeed => baselines::linear_speed(faces),
            Self::KCacheReorder {
                cache,
                greedy,
                first_focus,
            } => k_cache_reorder(cache, greedy, first_focus).face_order(faces),
            Self::RecursiveCut => RecursiveCut::default().face_order(faces),
            Self::LinearArrangement => LinearArrangement::default().face_order(faces),
            Self::Universal { effort } => {
                let optimizer = Optimizer {
                    target: Target::Universal,
                    effort,
                    ..Optimizer::default()
                };
                optimizer.face_order(faces)
            }
        }
    }

    /// The mesh with its faces in this order, and its vertices in the order of their first use.
    ///
    /// # Panics
    /// As [`order`](Self::order).
    #[must_use]
    pub fn applied(&self, mesh: &Mesh) -> Mesh {
        let mesh = mesh.with_face_order(&self.order(mesh));
        mesh.with_vertex_order(&vertex_fetch(&mesh))
    }

    /// The order for a controllable cache and the pushes of the schedule that comes with it; of
    /// other methods, no pushes.
    ///
    /// # Panics
    /// As [`order`](Self::order).
    #[must_use]
    pub fn scheduled_order<'a>(&self, faces: impl Into<Faces<'a>>) -> (FaceOrder, u64) {
        let faces = faces.into();
        match *self {
            Self::KCacheReorder {
                cache,
                greedy,
                first_focus,
            } => {
                let algorithm = k_cache_reorder(cache, greedy, first_focus);
                let (order, schedule) = algorithm.schedule(faces);
                (order, schedule.pushes())
            }
            _ => (self.order(faces), 0),
        }
    }

    /// What it is called, without the cache that it orders for.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::AsItIs => "as it comes",
            Self::Random { .. } => "random",
            Self::Tipsify { .. } => "Tipsify",
            Self::LinearSpeed => "linear-speed",
            Self::KCacheReorder { greedy, .. } => match greedy.mode {
                Mode::Fast => "K-Cache-Reorder, fast",
                Mode::Faithful => "K-Cache-Reorder, faithful",
            },
            Self::RecursiveCut => "recursive cut",
            Self::LinearArrangement => "linear arrangement",
            Self::Universal { effort } => match effort {
                Effort::Fast => "universal, fast",
                Effort::Best => "universal, best",
                Effort::Max => "universal, max",
            },
        }
    }
}

fn k_cache_reorder(cache: CacheModel, greedy: Greedy, first_focus: Option<u32>) -> KCacheReorder {
    KCacheReorder {
        first_focus,
        ..greedy.for_cache(cache, false)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        match self {
            Self::Tipsify { size } => write!(f, ", K = {size}"),
            Self::KCacheReorder { cache, .. } => match cache {
                CacheModel::Fifo { size } => write!(f, ", K = {size}"),
                cache => write!(f, ", {cache}"),
            },
            _ => Ok(()),
        }
    }
}

/// A regular grid of squares, each cut in two, as a mesh without positions, and its special orders
/// by name: there and back, along Hilbert's curve, and in strips for a FIFO cache.
///
/// # Panics
/// If there are more than (2³² − 1) / 3 faces or 2³² − 1 vertices, or the cache has fewer than five
/// entries.
///
/// # Complexity
/// Time O(faces · log faces).
#[must_use]
pub fn grid_orders(
    columns: u32,
    rows: u32,
    cache_size: u32,
) -> (Mesh, [(&'static str, Permutation); 3]) {
    let grid = Grid { columns, rows };
    let vertices = (columns as usize + 1) * (rows as usize + 1);
    let mesh = Mesh::connectivity_only(vertices, grid.faces());
    let orders = [
        ("snake", grid.snake()),
        ("Hilbert", grid.hilbert()),
        ("primed rows", grid.primed_rows(cache_size)),
    ];
    (mesh.expect("a grid names its own vertices"), orders)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_method_orders_all_faces_and_has_a_name_of_its_own() {
        let (mesh, orders) = grid_orders(9, 7, 8);
        for (_, order) in orders {
            assert_eq!(order.len(), mesh.face_count());
        }
        let mut names = Vec::new();
        for method in Method::SHOWN {
            let order = method.order(&mesh);
            assert_eq!(order.len(), mesh.face_count());
            names.push(method.to_string());
            let applied = method.applied(&mesh);
            assert_eq!(applied.face_count(), mesh.face_count());
            assert_eq!(applied.faces()[0], [0, 1, 2], "vertices by first use");
        }
        names.sort();
        names.dedup();
        assert_eq!(names.len(), Method::SHOWN.len());
        let controllable = Method::KCacheReorder {
            cache: CacheModel::controllable(9),
            greedy: Greedy::default(),
            first_focus: None,
        };
        assert_eq!(
            controllable.to_string(),
            "K-Cache-Reorder, fast, controllable:9"
        );
        let (order, pushes) = controllable.scheduled_order(&mesh);
        assert_eq!((order.len(), pushes >= 80), (mesh.face_count(), true));
    }
}
