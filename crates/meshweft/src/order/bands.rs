//! Vertices of several levels of detail in one buffer, so that what each level uses is a prefix of it.

use crate::cache::{fetched, ratio, used_vertices};
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{Permutation, VertexOrder};

/// The vertices in bands: first those of the coarsest level, then what each finer one adds.
///
/// `levels` are the faces of each level from fine to coarse, over the same vertices. The vertices that a level
/// and all coarser ones use are a prefix. Inside a band vertices are by first use: in the finest level that uses them, or in the
/// coarsest, whichever fetches less of all levels together, each by what it needs. The finest is better where it is in a good order: it has
/// the most to fetch, and takes 1.17 bytes for each that is needed, of scanned meshes
/// with 32-byte vertices and four levels, where [`vertex_fetch()`](super::vertex_fetch()) of the finest alone comes to 1.14, and
/// to 1.7 to 2 on the others. Unused vertices come last, in file order.
///
/// # Panics
/// If the levels have different numbers of vertices.
///
/// # Complexity
/// Time O(vertices + faces of all levels), space O(vertices).
///
/// ```
/// use meshweft::{Faces, order::vertex_bands};
/// let fine = Faces::new(&[[4, 3, 0], [0, 3, 1], [1, 2, 0]], 6)?;
/// let coarse = Faces::new(&[[2, 4, 0]], 6)?;
/// assert_eq!(vertex_bands(&[fine, coarse]).new_to_old(), [4, 0, 2, 3, 1, 5]);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[must_use]
pub fn vertex_bands(levels: &[Faces<'_>]) -> VertexOrder {
    let vertex_count = levels.first().map_or(0, |faces| faces.vertex_count());
    for faces in levels {
        let message = "levels over different vertices";
        assert_eq!(faces.vertex_count(), vertex_count, "{message}");
    }

    // The coarsest level that has each vertex, as its distance from the coarsest of all; unused ones after the last.
    let unused = levels.len();
    let mut band_of = vec![unused; vertex_count];
    for (band, faces) in levels.iter().rev().enumerate() {
        for &vertex in faces.as_slice().as_flattened() {
            let known = &mut band_of[vertex as usize];
            *known = band.min(*known);
        }
    }

    // First use in the finest level, or in the coarsest.
    let finest = in_bands(&band_of, levels.iter());
    let coarsest = in_bands(&band_of, levels.iter().rev());
    let [from_finest, from_coarsest] = [&finest, &coarsest].map(|order| overfetch(levels, order));
    match from_coarsest < from_finest {
        true => coarsest,
        false => finest,
    }
}

/// The vertices in bands, inside them by first use in these levels, one after the other.
fn in_bands<'a>(band_of: &[usize], levels: impl Iterator<Item = &'a Faces<'a>>) -> VertexOrder {
    // Where the next vertex of each band goes.
    let band_count = band_of.iter().max().map_or(0, |&last| last + 1);
    let mut next = vec![0; band_count + 1];
    for &band in band_of {
        next[band + 1] += 1;
    }
    for band in 0..band_count {
        next[band + 1] += next[band];
    }

    let mut seen = vec![false; band_of.len()];
    let mut new_to_old = vec![0; band_of.len()];
    let uses = levels.flat_map(|faces| faces.as_slice().as_flattened());
    for vertex in uses.copied().chain(0..index32(band_of.len())) {
        if !std::mem::replace(&mut seen[vertex as usize], true) {
            let place = &mut next[band_of[vertex as usize]];
            new_to_old[*place] = vertex;
            *place += 1;
        }
    }
    Permutation::from_algorithm(new_to_old).into()
}

/// Bytes fetched over bytes needed of vertices with 32 bytes in an order, summed over the levels.
fn overfetch(levels: &[Faces<'_>], order: &VertexOrder) -> f64 {
    const VERTEX_SIZE: usize = 32;
    let of_level = |faces: &Faces<'_>| {
        let renumbered = order.renumber(faces.as_slice());
        let renumbered = Faces::of_checked(&renumbered, faces.vertex_count());
        let needed = VERTEX_SIZE * used_vertices(renumbered);
        ratio(fetched(renumbered, VERTEX_SIZE), needed)
    };
    levels.iter().map(of_level).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::order::vertex_fetch;
    use crate::random::SplitMix64;

    #[test]
    fn the_numbers_of_vertices_follow_from_bands_and_first_use() {
        let levels: [&[[u32; 3]]; 3] = [&[[7, 6, 5]], &[[1, 6, 2]], &[[2, 0, 6]]];
        let levels = levels.map(|faces| Faces::of_checked(faces, 9));
        // The coarsest: 6 of the finest, 2 of the next, 0 of its own. Then 1, then 7 and 5; 3, 4 and 8 are unused.
        let order = vertex_bands(&levels);
        assert_eq!(order.new_to_old(), [6, 2, 0, 1, 7, 5, 3, 4, 8]);
    }

    #[test]
    fn one_level_is_ordered_by_first_use() {
        let faces = [[4, 2, 7], [7, 2, 0], [1, 4, 0]];
        let faces = Faces::of_checked(&faces, 10);
        assert_eq!(vertex_bands(&[faces]), vertex_fetch(faces));
        assert_eq!(vertex_bands(&[]).len(), 0);
        let none = vertex_bands(&[Faces::of_checked(&[], 3); 2]);
        assert!(none.is_identity() && none.len() == 3);
    }

    #[test]
    #[should_panic(expected = "levels over different vertices")]
    fn levels_have_the_same_vertices() {
        let _ = vertex_bands(&[Faces::of_checked(&[], 3), Faces::of_checked(&[], 4)]);
    }

    /// Levels of random faces, each with vertices of its own: all that a level and those below use is a prefix, and
    /// nothing moves any more.
    #[test]
    fn each_level_and_all_coarser_ones_have_a_prefix() {
        let mut numbers = SplitMix64(5);
        for case in 0..200 {
            let vertex_count = 1 + numbers.below(60);
            let mut vertex = || index32(numbers.below(vertex_count));
            let mut level = |count: usize| -> Vec<[u32; 3]> {
                (0..count).map(|_| [vertex(), vertex(), vertex()]).collect()
            };
            let levels = [level(case % 23), level(case % 11), level(case % 4)];
            let order = vertex_bands(
                &levels
                    .each_ref()
                    .map(|it| Faces::of_checked(it, vertex_count)),
            );

            let after = levels.each_ref().map(|it| order.renumber(it));
            let mut is_used = vec![false; vertex_count];
            for faces in after.iter().rev() {
                for &vertex in faces.as_flattened() {
                    is_used[vertex as usize] = true;
                }
                assert!(is_used.is_sorted_by(|a, b| a >= b), "case {case}");
            }
            let again = vertex_bands(
                &after
                    .each_ref()
                    .map(|it| Faces::of_checked(it, vertex_count)),
            );
            assert!(again.is_identity(), "case {case}");
        }
    }
}
