//! Counting misses: metrics of one cache are computed from a replay, FIFO caches are counted together.

use super::controllable::belady;
use super::drawing::Drawing;
use super::fifos::{self, FifoLimits, LANES};
use super::model::CacheModel;
use crate::faces::Faces;

/// Calls `visit(face number, misses)` for each face in order.
fn replay(faces: Faces<'_>, model: CacheModel, visit: impl FnMut(usize, u8)) {
    match Drawing::new(model, faces.vertex_count()) {
        Some(mut cache) => cache.draw_all(faces.as_slice(), visit),
        None => belady(faces, model.size(), visit, |_| {}),
    }
}

/// How many vertices some face names.
pub(crate) fn used_vertices(faces: Faces<'_>) -> usize {
    let mut used = vec![false; faces.vertex_count()];
    for &v in faces.as_slice().iter().flatten() {
        used[v as usize] = true;
    }
    used.into_iter().filter(|&u| u).count()
}

/// The counts of one cache model on one face order.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CacheReport {
    /// Vertices that were transformed.
    pub misses: u64,
    /// Faces drawn.
    pub faces: usize,
    /// Vertices that at least one face names.
    pub used_vertices: usize,
}

impl CacheReport {
    /// Misses per face; 0 without faces.
    #[must_use]
    pub fn acmr(&self) -> f64 {
        ratio(self.misses, self.faces)
    }

    /// Misses per used vertex; 0 without faces.
    #[must_use]
    pub fn atvr(&self) -> f64 {
        ratio(self.misses, self.used_vertices)
    }
}

/// `count / of`, 0 where there is nothing.
pub(crate) fn ratio(count: u64, of: usize) -> f64 {
    match of {
        0 => 0.0,
        _ => count as f64 / of as f64,
    }
}

/// Misses, faces and used vertices of this face order with this cache.
///
/// # Complexity
/// Time O(faces), for a controllable cache O(faces · log size); space O(vertices), for a
/// controllable cache also 12 bytes a face.
#[must_use]
pub fn report<'a>(faces: impl Into<Faces<'a>>, model: CacheModel) -> CacheReport {
    let faces = faces.into();
    CacheReport {
        misses: misses(faces, model),
        faces: faces.len(),
        used_vertices: used_vertices(faces),
    }
}

/// How many vertices are transformed while the faces are drawn in this order.
///
/// ```
/// use meshweft::{CacheModel, cache};
/// // Two faces that share an edge: three misses, then one.
/// assert_eq!(cache::misses(&[[0, 1, 2], [2, 1, 3]], CacheModel::fifo(16)), 4);
/// ```
///
/// # Complexity
/// As [`report`].
#[must_use]
pub fn misses<'a>(faces: impl Into<Faces<'a>>, model: CacheModel) -> u64 {
    let mut total = 0;
    replay(faces.into(), model, |_, missed| total += u64::from(missed));
    total
}

/// How many vertices are transformed under each model: [`misses`] of each, in much less time.
///
/// ```
/// use meshweft::{CacheModel, cache};
/// let models = [CacheModel::fifo(16), CacheModel::lru(8), CacheModel::AMD];
/// assert_eq!(cache::misses_of(&[[0, 1, 2], [2, 1, 3]], &models), [4, 4, 4]);
/// ```
///
/// # Complexity
/// For each four FIFO caches or batches together, time O(faces) and space 16 bytes a vertex; for any
/// other model as [`report`].
#[must_use]
pub fn misses_of<'a>(faces: impl Into<Faces<'a>>, models: &[CacheModel]) -> Vec<u64> {
    let faces = faces.into();
    let mut counts = vec![0; models.len()];

    // FIFO caches, those without batches first: they take less time if all that are drawn with
    // together are.
    let mut caches = Vec::new();
    for (number, &model) in models.iter().enumerate() {
        match FifoLimits::of(model) {
            Some(limits) => caches.push((number, limits)),
            None => counts[number] = misses(faces, model),
        }
    }
    caches.sort_by_key(|(_, limits)| limits.has_batches());

    for group in caches.chunks(LANES) {
        let limits = std::array::from_fn(|lane| group[lane.min(group.len() - 1)].1);
        for (&(number, _), misses) in group.iter().zip(fifos::misses(faces, limits)) {
            counts[number] = misses;
        }
    }
    counts
}

/// The average cache miss ratio: misses per face, between 0 and 3; 0 without faces.
///
/// ```
/// use meshweft::{CacheModel, cache};
/// assert_eq!(cache::acmr(&[[0, 1, 2], [2, 1, 3]], CacheModel::fifo(16)), 2.0);
/// ```
///
/// # Complexity
/// As [`report`].
#[must_use]
pub fn acmr<'a>(faces: impl Into<Faces<'a>>, model: CacheModel) -> f64 {
    let faces = faces.into();
    ratio(misses(faces, model), faces.len())
}

/// The average transform to vertex ratio: misses per used vertex, at least 1; 0 without faces.
///
/// ```
/// use meshweft::{CacheModel, cache};
/// assert_eq!(cache::atvr(&[[0, 1, 2], [2, 1, 3]], CacheModel::fifo(16)), 1.0);
/// ```
///
/// # Complexity
/// As [`report`].
#[must_use]
pub fn atvr<'a>(faces: impl Into<Faces<'a>>, model: CacheModel) -> f64 {
    report(faces, model).atvr()
}

/// How many corners of each face missed, 0 to 3, as for a heat map.
///
/// # Complexity
/// As [`report`], plus one byte a face.
#[must_use]
pub fn misses_per_face<'a>(faces: impl Into<Faces<'a>>, model: CacheModel) -> Vec<u8> {
    let faces = faces.into();
    let mut missed_at = vec![0; faces.len()];
    replay(faces, model, |number, missed| missed_at[number] = missed);
    missed_at
}

/// Bytes fetched for vertex records of `vertex_size` bytes, over the bytes of the used records.
///
/// At least about 1; 0 without faces. The memory is cached in 64-byte lines by a direct-mapped
/// cache of 128 KiB, the model of meshoptimizer's analyzer, and every index fetches its record.
///
/// # Panics
/// If `vertex_size` is 0 or more than 4 GiB.
///
/// # Complexity
/// Time O(faces · `vertex_size` / 64), space O(vertices).
#[must_use]
pub fn overfetch<'a>(faces: impl Into<Faces<'a>>, vertex_size: usize) -> f64 {
    let faces = faces.into();
    let stored = used_vertices(faces) as u64 * vertex_size as u64;
    match fetched(faces, vertex_size) {
        0 => 0.0,
        fetched => fetched as f64 / stored as f64,
    }
}

/// Bytes fetched for vertex records of `vertex_size` bytes; see [`overfetch`].
pub(crate) fn fetched(faces: Faces<'_>, vertex_size: usize) -> u64 {
    const LINE: u64 = 64;
    const LINES: usize = 2048;
    assert!(
        u32::try_from(vertex_size).is_ok_and(|size| size > 0),
        "a vertex record has at least one byte and less than 4 GiB"
    );

    let mut cached = [0_u64; LINES];
    let mut fetched = 0;
    let size = vertex_size as u64;
    for &vertex in faces.as_slice().iter().flatten() {
        let start = u64::from(vertex) * size;
        for line in start / LINE..(start + size).div_ceil(LINE) {
            // The number of the line plus one; 0 is an empty slot.
            let slot = &mut cached[usize::try_from(line % LINES as u64).unwrap_or(0)];
            if *slot != line + 1 {
                *slot = line + 1;
                fetched += LINE;
            }
        }
    }
    fetched
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 × 3 quads, two faces each, row by row, 16 vertices.
    fn grid() -> Vec<[u32; 3]> {
        let quad = |x: u32, y: u32| {
            let v = y * 4 + x;
            [[v, v + 1, v + 4], [v + 4, v + 1, v + 5]]
        };
        (0..3)
            .flat_map(|y| (0..3).flat_map(move |x| quad(x, y)))
            .collect()
    }

    #[test]
    fn a_grid_can_be_counted_on_paper() {
        let faces = grid();
        // All 16 vertices fit: each is transformed once.
        assert_eq!(misses(&faces, CacheModel::fifo(16)), 16);
        assert_eq!(atvr(&faces, CacheModel::lru(16)), 1.0);
        // Four entries still hold an edge from one quad to the next, so within a row each face
        // after the first misses one corner; nothing is left of a row when the next one starts.
        let per_face = misses_per_face(&faces[..6], CacheModel::fifo(4));
        assert_eq!(per_face, [3, 1, 1, 1, 1, 1]);
        assert_eq!(misses(&faces, CacheModel::fifo(4)), 24);
        assert_eq!(acmr(&faces, CacheModel::fifo(4)), 24.0 / 18.0);
    }

    /// Bogomjakov & Gotsman 2002, doi:10.1111/1467-8659.00573, Fig. 1: 25 and 14 misses are printed.
    #[test]
    fn a_printed_sequence_has_the_printed_misses() {
        #[rustfmt::skip]
        let faces = [
            [1, 2, 4], [1, 4, 5], [4, 5, 14], [2, 3, 4], [3, 4, 12], [3, 11, 12], [9, 11, 12],
            [9, 10, 11], [7, 9, 13], [7, 8, 9], [6, 7, 13], [6, 13, 14], [9, 12, 13], [4, 12, 14],
            [12, 13, 14], [5, 6, 14],
        ];
        assert_eq!(misses(&faces, CacheModel::fifo(4)), 25);
        assert_eq!(misses(&faces, CacheModel::fifo(16)), 14);
        assert_eq!(format!("{:.2}", acmr(&faces, CacheModel::fifo(4))), "1.56");
        assert_eq!(
            format!("{:.3}", acmr(&faces, CacheModel::fifo(16))),
            "0.875"
        );
    }

    #[test]
    fn no_faces_are_no_misses() {
        for model in [
            CacheModel::fifo(16),
            CacheModel::lru(16),
            CacheModel::controllable(16),
            CacheModel::Nvidia,
        ] {
            let empty = report(&[], model);
            assert_eq!((empty.misses, empty.acmr(), empty.atvr()), (0, 0.0, 0.0));
        }
        assert_eq!(overfetch(&[], 32), 0.0);
    }

    #[test]
    fn models_together_are_counted_as_one_by_one() {
        let models: Vec<CacheModel> = [
            "lru:5",
            "intel",
            "fifo:12",
            "nvidia",
            "batch:9/6/0",
            "controllable:4",
            "amd",
            "fifo:3",
            "batch:65536/0/1",
            "fifo:65536",
            "fifo:12",
        ]
        .map(|name| name.parse().unwrap())
        .to_vec();
        // The grid backwards, and each of its faces again with a corner twice.
        let again = grid()
            .into_iter()
            .rev()
            .flat_map(|[a, b, c]| [[a, b, c], [b, a, b]]);
        let faces: Vec<_> = grid().into_iter().chain(again).collect();
        for some in [&models[..], &models[3..4], &models[1..7], &[]] {
            let one_by_one: Vec<u64> = some.iter().map(|&model| misses(&faces, model)).collect();
            assert_eq!(misses_of(&faces, some), one_by_one);
            assert_eq!(misses_of(&[], some), vec![0; some.len()]);
        }
    }

    #[test]
    fn records_in_use_order_are_fetched_once() {
        // Sixteen records of 64 bytes, each its own line.
        assert_eq!(overfetch(&grid(), 64), 1.0);
        // One record of 16 bytes still costs a line of 64.
        assert_eq!(overfetch(&[[0, 0, 0]], 16), 4.0);
    }
}
