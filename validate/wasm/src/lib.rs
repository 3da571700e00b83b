//! The library behind plain exports, and the same calls natively.
//!
//! What is asked for comes as numbers and text, so that both sides take the same words: a host of
//! wasm32 through [`exports`], the program `native` through standard input.

pub mod compressed;
pub mod exports;

use meshweft::operations::{IndexOptions, VertexIndex, optimize_indices};
use meshweft::order::{Effort, Target};
use meshweft::{Budget, CacheModel, Faces, MeshError, cache};

/// Flag: corners are not turned.
pub const KEEP_CORNERS: u32 = 1;
/// Flag: vertices are renumbered.
pub const RENUMBER_VERTICES: u32 = 2;
/// This number of steps stands for no budget.
pub const UNLIMITED: u64 = u64::MAX;
/// Stands for misses that cannot be counted.
pub const NO_COUNT: u64 = u64::MAX;

/// How a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Status {
    /// The indices are in order.
    Done = 0,
    /// No such target.
    UnknownTarget = 1,
    /// The last face is not whole.
    PartialFace = 2,
    /// An index is past the last vertex.
    IndexOutOfRange = 3,
    /// Any other error.
    OtherError = 4,
}

/// How indices are to be ordered.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The name of a target.
    pub target: &'a str,
    /// 0 fast, 1 best, 2 max.
    pub effort: u32,
    /// The budget in steps, or [`UNLIMITED`].
    pub steps: u64,
    /// Seed of the search.
    pub seed: u64,
    /// [`KEEP_CORNERS`] and [`RENUMBER_VERTICES`], added up.
    pub flags: u32,
}

/// Orders the indices in place.
///
/// # Panics
/// If there is no such effort. The checks use this to see what happens on a panic.
pub fn optimize<I: VertexIndex>(
    indices: &mut [I],
    vertex_count: usize,
    request: &Request<'_>,
) -> Status {
    let Ok(target) = request.target.parse::<Target>() else {
        return Status::UnknownTarget;
    };
    let options = IndexOptions {
        target,
        effort: match request.effort {
            0 => Effort::Fast,
            1 => Effort::Best,
            2 => Effort::Max,
            other => panic!("{other} is not an effort: 0, 1 or 2"),
        },
        seed: request.seed,
        budget: match request.steps {
            UNLIMITED => Budget::Unlimited,
            steps => Budget::Steps(steps),
        },
        keep_corners: request.flags & KEEP_CORNERS != 0,
        renumber_vertices: request.flags & RENUMBER_VERTICES != 0,
        allow_worse: false,
    };
    match optimize_indices(indices, vertex_count, &options) {
        Ok(_) => Status::Done,
        Err(MeshError::PartialFace { .. }) => Status::PartialFace,
        Err(MeshError::IndexOutOfRange { .. }) => Status::IndexOutOfRange,
        Err(_) => Status::OtherError,
    }
}

/// Misses of this order; [`NO_COUNT`] if there is no such cache, or the indices are not valid.
#[must_use]
pub fn misses(indices: &[u32], vertex_count: usize, cache: &str) -> u64 {
    let Ok(model) = cache.parse::<CacheModel>() else {
        return NO_COUNT;
    };
    Faces::from_indices(indices, vertex_count).map_or(NO_COUNT, |faces| cache::misses(faces, model))
}
