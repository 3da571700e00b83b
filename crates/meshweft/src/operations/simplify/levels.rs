//! Figures of the levels of an object.

use crate::cache::{CacheModel, acmr};
use crate::faces::Faces;
use crate::order::KCacheReorder;
use crate::progressive::{ProgressiveMesh, Walk};

/// The FIFO caches that misses of levels are counted for.
pub const LEVEL_CACHES: [u32; 2] = [12, 16];

/// A level of an object: how many faces it has, how far it is from the source, and how it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LevelFigures {
    /// How many faces it has.
    pub faces: usize,
    /// How far it is from the source, as an estimate in units of the positions.
    pub error: f32,
    /// Misses per face in FIFO caches of [`LEVEL_CACHES`], in the sequence of the full mesh, which was made for
    /// a cache of one vertex less, edited in place.
    pub edited: [f64; 2],
    /// The same in a sequence of its own.
    pub fresh: [f64; 2],
}

/// So many levels at most, from the full mesh to the coarsest one, their faces in equal ratios.
///
/// Time that of two orders a level.
pub(super) fn figures(progressive: &ProgressiveMesh, count: usize) -> Vec<LevelFigures> {
    let full = progressive.faces().len();
    let coarsest = progressive.face_count(progressive.last_level()).max(1);
    let ratio = coarsest as f64 / full.max(1) as f64;
    let steps = count.saturating_sub(1).max(1);
    let order = |cache: u32| KCacheReorder {
        cache: CacheModel::fifo(cache - 1),
        ..KCacheReorder::default()
    };

    // The sequences to be edited.
    let all = Faces::of_checked(progressive.faces(), progressive.vertex_count());
    let edited = LEVEL_CACHES.map(|cache| order(cache).face_order(all));
    let mut walk = Walk::new(progressive);
    let mut levels: Vec<LevelFigures> = Vec::with_capacity(count);
    for step in 0..=steps {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "at most the number of faces"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a ratio is not negative")]
        let goal = (full as f64 * ratio.powf(step as f64 / steps as f64)).round() as usize;
        let level = progressive.level_of_faces(goal);
        let faces = progressive.face_count(level);
        if faces == 0 || levels.last().is_some_and(|last| last.faces == faces) {
            continue;
        }
        walk.go_to(level);
        let mut left = Vec::with_capacity(faces);
        let figures = [0, 1].map(|which| {
            let cache = LEVEL_CACHES[which];
            let misses = |faces: &[[u32; 3]]| acmr(faces, CacheModel::fifo(cache));
            left.clear();
            let sequence = edited[which].new_to_old().iter();
            left.extend(
                sequence
                    .filter(|&&face| walk.has(face))
                    .map(|&face| walk.face(face)),
            );
            let own = order(cache).face_order(Faces::of_checked(&left, progressive.vertex_count()));
            [misses(&left), misses(&own.apply(&left))]
        });
        levels.push(LevelFigures {
            faces,
            error: progressive.error(level),
            edited: figures.map(|[edited, _]| edited),
            fresh: figures.map(|[_, fresh]| fresh),
        });
    }
    levels
}
