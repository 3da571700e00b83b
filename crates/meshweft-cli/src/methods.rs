//! The methods that are shown side by side.

use meshweft::order::baselines::{random, tipsify};
use meshweft::order::bogomjakov_gotsman::{LinearArrangement, RecursiveCut};
use meshweft::order::{Effort, KCacheReorder, Mode, Optimizer, Target};
use meshweft::{CacheModel, FaceOrder, Mesh};

/// A way to order a mesh.
pub(crate) struct Method {
    pub(crate) name: &'static str,
    pub(crate) order: fn(&Mesh) -> FaceOrder,
}

pub(crate) const METHODS: [Method; 9] = [
    Method {
        name: "random",
        order: |mesh| random(mesh.face_count(), 7).into(),
    },
    Method {
        name: "Tipsify, K = 12",
        order: |mesh| tipsify(mesh, 12),
    },
    Method {
        name: "K-Cache-Reorder, faithful, K = 12",
        order: |mesh| k_cache_reorder(mesh, 12, Mode::Faithful),
    },
    Method {
        name: "K-Cache-Reorder, fast, K = 12",
        order: |mesh| k_cache_reorder(mesh, 12, Mode::Fast),
    },
    Method {
        name: "K-Cache-Reorder, fast, K = 32",
        order: |mesh| k_cache_reorder(mesh, 32, Mode::Fast),
    },
    Method {
        name: "recursive cut",
        order: |mesh| RecursiveCut::default().face_order(mesh),
    },
    Method {
        name: "linear arrangement",
        order: |mesh| LinearArrangement::default().face_order(mesh),
    },
    Method {
        name: "universal, fast",
        order: |mesh| universal(mesh, Effort::Fast),
    },
    Method {
        name: "universal, best",
        order: |mesh| universal(mesh, Effort::Best),
    },
];

/// For a FIFO cache of a size.
pub(crate) fn k_cache_reorder(mesh: &Mesh, size: u32, mode: Mode) -> FaceOrder {
    let algorithm = KCacheReorder {
        cache: CacheModel::fifo(size),
        mode,
        ..KCacheReorder::default()
    };
    algorithm.face_order(mesh)
}

/// For every cache.
pub(crate) fn universal(mesh: &Mesh, effort: Effort) -> FaceOrder {
    let optimizer = Optimizer {
        target: Target::Universal,
        effort,
        ..Optimizer::default()
    };
    optimizer.face_order(mesh)
}
