//! Turning the corners of a given order for a cache.

use crate::cache::{CacheModel, Drawing};
use crate::faces::{Faces, turned};
use crate::order::greedy::HITS_FIRST;
use crate::permutation::FaceOrder;

/// The order with the corners of each face turned so that those that are in the cache come first.
///
/// A FIFO cache may lose a vertex of a face to another corner of it; with its hits first no face
/// pushes a vertex that was there when it started. For orders that come from elsewhere: those made
/// here are turned already, unless that was forbidden. Existing rotations are replaced; for a
/// controllable cache they become 0.
///
/// # Panics
/// If the order is of another number of faces.
///
/// # Complexity
/// Time and space O(vertices + faces).
///
/// ```
/// use meshweft::{CacheModel, FaceOrder, cache, order::turn_corners};
/// let faces = [[0, 1, 2], [3, 0, 2]];
/// let order = turn_corners(&faces, &FaceOrder::identity(2), CacheModel::fifo(3));
/// assert_eq!(order.apply(&faces), [[0, 1, 2], [0, 2, 3]]);
/// // Pushed first, vertex 3 takes the place of vertex 0, which the same face needs.
/// assert_eq!(cache::misses(&faces, CacheModel::fifo(3)), 5);
/// assert_eq!(cache::misses(&order.apply(&faces), CacheModel::fifo(3)), 4);
/// ```
#[must_use]
pub fn turn_corners<'a>(
    faces: impl Into<Faces<'a>>,
    order: &FaceOrder,
    cache: CacheModel,
) -> FaceOrder {
    let faces = faces.into();
    assert_eq!(order.len(), faces.len(), "face order of another length");
    let permutation = order.permutation().clone();
    let Some(mut cache) = Drawing::new(cache, faces.vertex_count()) else {
        return permutation.into();
    };

    // FIFO caches, which the universal order is turned for, have a loop of their own.
    let of_set = |[a, b, c]: [bool; 3]| {
        let [a, b, c] = [a, b, c].map(usize::from);
        HITS_FIRST[a | b << 1 | c << 2]
    };
    let drawn = order.new_to_old().iter();
    let drawn = drawn.map(|&face| faces.as_slice()[face as usize]);
    let rotations = match &mut cache {
        Drawing::Fifo(fifo) => {
            let turn = |corners: [u32; 3]| {
                let rotation = of_set(corners.map(|vertex| !fifo.contains(vertex)));
                for vertex in turned(corners, rotation) {
                    fifo.miss(vertex);
                }
                rotation
            };
            drawn.map(turn).collect()
        }
        cache => {
            let turn = |corners: [u32; 3]| {
                let rotation = of_set(cache.missing(corners));
                cache.draw(turned(corners, rotation));
                rotation
            };
            drawn.map(turn).collect()
        }
    };
    FaceOrder::new(permutation, rotations).expect("one rotation below 3 a face")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache;
    use crate::order::baselines::random;

    #[test]
    fn no_corner_misses_that_was_there() {
        let faces: Vec<[u32; 3]> = (0..200)
            .map(|i| [i % 40, (i * 7) % 40, (i * i) % 41])
            .collect();
        let order: FaceOrder = random(faces.len(), 3).into();
        let models = ["fifo:5", "lru:5", "nvidia", "amd", "batch:6/9/7"];
        for model in models.map(|name| name.parse::<CacheModel>().unwrap()) {
            let after = turn_corners(&faces, &order, model);
            assert_eq!(after.permutation(), order.permutation());
            let ordered = after.apply(&faces);

            // Counted by the plain rule: distinct corners that are missing before the face is
            // drawn.
            let mut cache = Drawing::new(model, 41).unwrap();
            for (face, missed) in ordered.iter().zip(cache::misses_per_face(&ordered, model)) {
                let missing = cache.missing(*face);
                let mut expected: Vec<u32> =
                    (0..3).filter(|&i| missing[i]).map(|i| face[i]).collect();
                expected.sort_unstable();
                expected.dedup();
                assert_eq!(usize::from(missed), expected.len(), "{model}: {face:?}");
                cache.draw(*face);
            }
        }

        let controllable = turn_corners(&faces, &order, CacheModel::controllable(5));
        assert_eq!(controllable, order);
    }
}
