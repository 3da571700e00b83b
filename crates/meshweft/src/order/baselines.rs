//! Orders to compare with: random, Tipsify, and linear-speed vertex cache optimisation.

use crate::cache::Fifo;
use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};
use crate::random::shuffled;
use crate::topology::{Adjacency, distinct};

pub use super::linear_speed::linear_speed;

/// `len` numbers in a random order, the same for the same seed on every platform.
///
/// Numbers are drawn by SplitMix64 (Steele, Lea, Flood 2014, doi:10.1145/2714064.2660195).
///
/// # Panics
/// If `len` is more than 2³² − 1.
///
/// # Complexity
/// Time and space O(len).
#[must_use]
pub fn random(len: usize, seed: u64) -> Permutation {
    Permutation::from_algorithm(shuffled(len, seed))
}

/// A rendering sequence by Tipsify, for a FIFO cache of `cache_size` vertices.
///
/// Pedro V. Sander, Diego Nehab, Joshua Barczak: *Fast Triangle Reordering for Vertex Locality and
/// Reduced Overdraw*, ACM Transactions on Graphics 26(3), 2007, doi:10.1145/1276377.1276489. It
/// draws fans around one vertex after the other. The next vertex is the one of the last fan that
/// entered the cache first, among those whose own fan still fits; else the last used vertex with
/// faces left; else the next in file order.
///
/// # Complexity
/// Time O(vertices + faces), space 16 bytes a vertex and 29 a face.
#[must_use]
pub fn tipsify<'a>(faces: impl Into<Faces<'a>>, cache_size: u32) -> FaceOrder {
    let faces = faces.into();

    let adjacency = Adjacency::new(faces);
    let all_vertices = 0..index32(faces.vertex_count());
    let mut live: Vec<u32> = all_vertices
        .clone()
        .map(|vertex| adjacency.degree(vertex))
        .collect();
    let mut cache = Fifo::new(cache_size, faces.vertex_count());
    let mut dead_ends: Vec<u32> = Vec::new();
    let mut drawn = vec![false; faces.len()];
    let mut new_to_old = Vec::with_capacity(faces.len());
    let mut in_file_order = all_vertices;

    let mut fan = in_file_order.next();
    while let Some(vertex) = fan {
        // Draw the live faces of the vertex.
        let fan_start = dead_ends.len();
        for &face in adjacency.faces_of(vertex) {
            if std::mem::replace(&mut drawn[face as usize], true) {
                continue;
            }
            new_to_old.push(face);
            let corners = faces.as_slice()[face as usize];
            for corner in corners {
                dead_ends.push(corner);
                cache.miss(corner);
            }
            for corner in distinct(corners) {
                live[corner as usize] -= 1;
            }
        }

        // Go on with one of its neighbours. Of those whose remaining fan still fits, the one that
        // has been in the cache longest is worth most.
        let worth = |&v: &u32| {
            let age = cache.age(v);
            let fits = age + 2 * u64::from(live[v as usize]) <= u64::from(cache_size);
            if fits { age } else { 0 }
        };
        let candidates = dead_ends[fan_start..].iter().copied();
        let next = candidates
            .filter(|&v| live[v as usize] > 0)
            .reduce(|best, v| if worth(&v) > worth(&best) { v } else { best });

        // At a dead end, go back.
        fan = next.or_else(|| {
            while let Some(vertex) = dead_ends.pop() {
                if live[vertex as usize] > 0 {
                    return Some(vertex);
                }
            }
            in_file_order.find(|&vertex| live[vertex as usize] > 0)
        });
    }
    Permutation::from_algorithm(new_to_old).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache::{self, CacheModel};
    use crate::mesh::Mesh;

    #[test]
    fn random_orders_depend_on_the_seed_alone() {
        assert_eq!(random(1000, 7), random(1000, 7));
        assert_ne!(random(1000, 7), random(1000, 8));
        assert_eq!(random(0, 7).len(), 0);
        assert_eq!(random(1, 7).new_to_old(), [0]);
    }

    #[test]
    fn random_orders_are_uniform() {
        // Each of the six orders of three things, 6000 draws: 1000 ± 5 standard deviations.
        let mut counts = std::collections::BTreeMap::new();
        for seed in 0..6000 {
            *counts
                .entry(random(3, seed).new_to_old().to_vec())
                .or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 6);
        assert!(
            counts.values().all(|c| (850..1150).contains(c)),
            "{counts:?}"
        );
    }

    #[test]
    fn tipsify_walks_a_strip_from_end_to_end() {
        let faces: Vec<[u32; 3]> = (0..40).map(|i| [i, i + 1, i + 2]).collect();
        let shuffled = random(40, 3).apply(&faces);
        let mesh = Mesh::connectivity_only(42, shuffled).unwrap();
        let ordered = mesh.with_face_order(&tipsify(&mesh, 8));
        assert_eq!(cache::misses(ordered.faces(), CacheModel::fifo(8)), 42);
    }
}
