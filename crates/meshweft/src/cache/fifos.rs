//! Four FIFO caches at once, their time stamps side by side.
//!
//! A replay of one cache spends its time on branches that are predicted wrong and on waiting for
//! memory. Here each vertex has one record with a stamp for each cache, and all caches are tested,
//! pushed to and emptied without a branch: four numbers of 32 bits fill a vector register.

use super::model::{BatchModel, CacheModel, MAX_CACHE_SIZE};
use crate::faces::Faces;

/// Caches that are drawn with at once.
pub(super) const LANES: usize = 4;

/// One number a cache.
type Lanes = [i32; LANES];

/// Where a clock begins: past any size and any limit of a batch, so that stamp 0 is never in a cache.
const FIRST_TIME: i32 = 1 << 17;
/// A clock that has come so far is set back to [`FIRST_TIME`].
const LAST_TIME: i32 = 1 << 30;
/// Faces between two looks at the clocks. A face moves them by 3 pushes and a size at most.
const FACES_BETWEEN_LOOKS: usize = 1 << 12;

/// A limit that no batch reaches.
const NO_LIMIT: i32 = i32::MAX;

// What is added to a clock at its limit before the next look does not overflow.
const _: () = {
    let most_added = FACES_BETWEEN_LOOKS as u64 * (MAX_CACHE_SIZE as u64 + 4);
    assert!(FIRST_TIME > MAX_CACHE_SIZE as i32 + 1);
    assert!(LAST_TIME as u64 + most_added < i32::MAX as u64);
};

/// A FIFO cache, with the limits of its batches.
#[derive(Debug, Clone, Copy)]
pub(super) struct FifoLimits {
    size: i32,
    /// [`NO_LIMIT`] for none.
    batch_vertices: i32,
    /// [`NO_LIMIT`] for none.
    batch_faces: i32,
}

impl FifoLimits {
    /// `None` if it is not a FIFO cache, or has larger numbers than are read from text.
    pub(super) fn of(model: CacheModel) -> Option<Self> {
        let batch = match model {
            CacheModel::Fifo { size } => BatchModel::new(size, 0, 0),
            CacheModel::Batch(batch) => batch,
            _ => return None,
        };
        let number = |number| match number {
            0 => Some(NO_LIMIT),
            1..=MAX_CACHE_SIZE => i32::try_from(number).ok(),
            _ => None,
        };
        let batch_vertices = number(batch.batch_vertices())?;
        let batch_faces = number(batch.batch_faces())?;
        // What no batch can fill makes no difference, but it would move the clock between batches.
        let size = number(batch.cache_size())?.min(batch_vertices);
        Some(Self {
            size: size.min(batch_faces.saturating_mul(3)),
            batch_vertices,
            batch_faces,
        })
    }

    /// Whether it is ever emptied.
    pub(super) fn has_batches(&self) -> bool {
        self.batch_vertices != NO_LIMIT || self.batch_faces != NO_LIMIT
    }
}

/// How many vertices each cache transforms while the faces are drawn in this order.
///
/// Time O(faces), space 16 bytes a vertex.
pub(super) fn misses(faces: Faces<'_>, limits: [FifoLimits; LANES]) -> [u64; LANES] {
    misses_from(FIRST_TIME, faces, limits)
}

/// As [`misses`], with clocks that begin at `time`.
fn misses_from(time: i32, faces: Faces<'_>, limits: [FifoLimits; LANES]) -> [u64; LANES] {
    let mut entered = vec![[0; LANES]; faces.vertex_count()];
    let mut clocks = Clocks {
        size: limits.map(|cache| cache.size),
        now: [time; LANES],
    };
    let mut batches = CurrentBatches::new(limits, time);
    let has_batches = limits.iter().any(FifoLimits::has_batches);

    let mut misses = [0; LANES];
    for faces in faces.as_slice().chunks(FACES_BETWEEN_LOOKS) {
        let before = clocks.now;
        let jumped = match has_batches {
            false => draw(faces, &mut clocks, &mut entered),
            true => draw_in_batches(faces, &mut clocks, &mut batches, &mut entered),
        };
        for (lane, misses) in misses.iter_mut().enumerate() {
            let pushes = clocks.now[lane] - before[lane] - jumped[lane];
            *misses += u64::from(pushes.unsigned_abs());
        }

        if clocks.now.iter().any(|&time| time >= LAST_TIME) {
            set_back(&mut clocks, &mut batches, &mut entered);
        }
    }
    misses
}

/// Sets the clocks back to [`FIRST_TIME`], and all times with them.
///
/// What is further back than that has left its cache; at 0 it still has.
fn set_back(clocks: &mut Clocks, batches: &mut CurrentBatches, entered: &mut [Lanes]) {
    let now = clocks.now;
    let earlier = |times: &Lanes| each(|lane| (times[lane] - now[lane] + FIRST_TIME).max(0));
    clocks.now = earlier(&now);
    batches.start = earlier(&batches.start);
    for entered in entered {
        *entered = earlier(entered);
    }
}

/// A number made for each cache.
#[inline]
fn each(number: impl Fn(usize) -> i32) -> Lanes {
    std::array::from_fn(number)
}

/// All bits set if it is so, otherwise none.
#[inline]
fn mask(is_so: bool) -> i32 {
    -i32::from(is_so)
}

/// The numbers `set` where `mask` is set, `clear` elsewhere: by bits, without a branch.
#[inline]
fn where_set(mask: Lanes, set: Lanes, clear: Lanes) -> Lanes {
    each(|lane| (set[lane] & mask[lane]) | (clear[lane] & !mask[lane]))
}

/// The time of each cache: its pushes, and a jump past all stamps where it was emptied.
#[derive(Clone, Copy)]
struct Clocks {
    size: Lanes,
    now: Lanes,
}

impl Clocks {
    /// In which caches a vertex with these stamps misses, as a [`mask`].
    #[inline]
    fn missed(&self, entered: &Lanes) -> Lanes {
        each(|lane| mask(self.now[lane] - entered[lane] > self.size[lane]))
    }

    /// Uses a vertex: pushes it where it misses.
    #[inline]
    fn use_vertex(&mut self, entered: &mut Lanes) {
        let missed = self.missed(entered);
        *entered = where_set(missed, self.now, *entered);
        self.now = each(|lane| self.now[lane] - missed[lane]);
    }
}

/// The current batch of each cache.
#[derive(Clone, Copy)]
struct CurrentBatches {
    most_vertices: Lanes,
    most_faces: Lanes,
    /// The time at which it began: every push since is a vertex of it.
    start: Lanes,
    /// Its faces, where they are counted.
    faces: Lanes,
    /// 1 where faces are counted.
    face: Lanes,
}

impl CurrentBatches {
    fn new(limits: [FifoLimits; LANES], time: i32) -> Self {
        Self {
            most_vertices: limits.map(|cache| cache.batch_vertices),
            most_faces: limits.map(|cache| cache.batch_faces),
            start: [time; LANES],
            faces: [0; LANES],
            face: limits.map(|cache| i32::from(cache.batch_faces != NO_LIMIT)),
        }
    }
}

/// Draws faces with caches without batches.
///
/// Returns by how much the clocks jumped, which is never.
// A function of its own, here and below: inlined, it was not compiled to vector instructions.
#[inline(never)]
fn draw(faces: &[[u32; 3]], clocks: &mut Clocks, entered: &mut [Lanes]) -> Lanes {
    // A copy stays in registers.
    let mut now = *clocks;
    for &vertex in faces.as_flattened() {
        now.use_vertex(&mut entered[vertex as usize]);
    }
    *clocks = now;
    [0; LANES]
}

/// Draws faces; a batch that a face does not fit in ends before it.
///
/// Returns by how much the clocks jumped.
#[inline(never)]
fn draw_in_batches(
    block: &[[u32; 3]],
    clocks: &mut Clocks,
    batches: &mut CurrentBatches,
    entered: &mut [Lanes],
) -> Lanes {
    let mut now = *clocks;
    let mut batch = *batches;
    let mut jumped = [0; LANES];
    for &face in block {
        // Whether it fits is decided from the state before it, corner by corner.
        let [a, b, c] = face.map(|vertex| now.missed(&entered[vertex as usize]));
        let pushes = each(|lane| now.now[lane] - batch.start[lane] - a[lane] - b[lane] - c[lane]);
        let is_full = each(|lane| {
            mask(pushes[lane] > batch.most_vertices[lane])
                | mask(batch.faces[lane] == batch.most_faces[lane])
        });

        // Empty the caches where it does not.
        let jump = each(|lane| (now.size[lane] + 1) & is_full[lane]);
        now.now = each(|lane| now.now[lane] + jump[lane]);
        jumped = each(|lane| jumped[lane] + jump[lane]);
        batch.start = where_set(is_full, now.now, batch.start);
        batch.faces = each(|lane| (batch.faces[lane] & !is_full[lane]) + batch.face[lane]);

        // Draw it.
        for vertex in face {
            now.use_vertex(&mut entered[vertex as usize]);
        }
    }
    (*clocks, *batches) = (now, batch);
    jumped
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Drawing;
    use super::*;
    use crate::random::SplitMix64;

    /// The replay of one cache.
    fn replayed(faces: &[[u32; 3]], vertex_count: usize, model: CacheModel) -> u64 {
        let mut cache = Drawing::new(model, vertex_count).unwrap();
        faces.iter().map(|&face| u64::from(cache.draw(face))).sum()
    }

    /// Faces of vertices close to each other, one in eight degenerate.
    fn soup(random: &mut SplitMix64, faces: usize, vertex_count: usize) -> Vec<[u32; 3]> {
        let spread = 1 + random.below(vertex_count);
        let mut vertex = |face: usize| {
            let near = face * vertex_count / faces + random.below(spread);
            u32::try_from(near % vertex_count).unwrap()
        };
        let mut face = |number| {
            let corners = [vertex(number), vertex(number), vertex(number)];
            match number % 8 {
                0 => [corners[0], corners[1], corners[0]],
                _ => corners,
            }
        };
        (0..faces).map(&mut face).collect()
    }

    #[test]
    fn four_caches_at_once_are_four_replays() {
        let mut random = SplitMix64(3);
        for case in 0..300 {
            let vertex_count = 1 + random.below(if case % 2 == 0 { 20 } else { 600 });
            let face_count = 1 + random.below(800);
            let faces = soup(&mut random, face_count, vertex_count);
            let mut number = |least: u32| least + u32::try_from(random.below(70)).unwrap();
            let models = [0, 1, 2, 3].map(|lane| {
                let vertices = number(2);
                let vertices = if vertices == 2 { 0 } else { vertices };
                match (case + lane) % 3 {
                    0 => CacheModel::fifo(number(3)),
                    1 => CacheModel::Batch(BatchModel::new(number(3), vertices, number(0))),
                    _ => CacheModel::Batch(BatchModel::new(MAX_CACHE_SIZE, vertices, 0)),
                }
            });
            let counted = misses(
                Faces::of_checked(&faces, vertex_count),
                models.map(|model| FifoLimits::of(model).unwrap()),
            );
            let expected = models.map(|model| replayed(&faces, vertex_count, model));
            assert_eq!(counted, expected, "{models:?}, case {case}");
        }
    }

    /// Clocks that reach their last time in any block, also several times.
    #[test]
    fn clocks_are_set_back_unseen() {
        let mut random = SplitMix64(5);
        for models in [
            [
                CacheModel::fifo(16),
                CacheModel::fifo(3),
                CacheModel::fifo(MAX_CACHE_SIZE),
                CacheModel::INTEL,
            ],
            [
                CacheModel::fifo(64),
                CacheModel::AMD,
                CacheModel::MESHOPT_NVIDIA,
                CacheModel::INTEL,
            ],
        ] {
            let vertex_count = 3000;
            let faces = soup(&mut random, 5 * FACES_BETWEEN_LOOKS, vertex_count);
            let limits = models.map(|model| FifoLimits::of(model).unwrap());
            let expected = models.map(|model| replayed(&faces, vertex_count, model));
            for before_the_last in [0, 1, 1000, 10_000, 20_000, 50_000] {
                let faces = Faces::of_checked(&faces, vertex_count);
                let counted = misses_from(LAST_TIME - before_the_last, faces, limits);
                assert_eq!(counted, expected, "{models:?}, {before_the_last}");
            }
        }
    }

    #[test]
    fn what_is_no_fifo_cache_or_too_large_is_left_to_others() {
        let large = MAX_CACHE_SIZE + 1;
        for model in [
            CacheModel::lru(16),
            CacheModel::controllable(16),
            CacheModel::fifo(large),
            CacheModel::Batch(BatchModel::new(3, large, 0)),
            CacheModel::Batch(BatchModel::new(3, 0, u32::MAX)),
        ] {
            assert!(FifoLimits::of(model).is_none(), "{model}");
        }
    }
}
