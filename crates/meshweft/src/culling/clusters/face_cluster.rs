//! Faces that are drawn together.

use super::masks::{self, Mask};
use super::merge::Price;
use super::seen::Seen;
use super::tour::{self, MOST_TO_ORDER};
use crate::index::index32;

/// Faces of one cluster, and the eyes that see something of them.
#[derive(Debug, Clone)]
pub(super) struct FaceCluster<const WORDS: usize> {
    pub(super) faces: Vec<u32>,
    pub(super) mask: Mask<WORDS>,
    pub(super) vertices: usize,
}

/// The clusters of faces that come in runs, each with the number of its cluster, below the number of faces; clusters come
/// in the order of their first run, as the runs in each.
pub(super) fn gathered<'a, const WORDS: usize>(
    seen: &Seen<'_, WORDS>,
    runs: impl Iterator<Item = (&'a [u32], u32)>,
) -> Vec<FaceCluster<WORDS>> {
    // Faces and eyes.
    let mut number = vec![u32::MAX; seen.faces.len()];
    let mut clusters: Vec<FaceCluster<WORDS>> = Vec::new();
    for (faces, cluster) in runs {
        let number = &mut number[cluster as usize];
        if *number == u32::MAX {
            *number = index32(clusters.len());
            clusters.push(FaceCluster {
                faces: Vec::new(),
                mask: [0; WORDS],
                vertices: 0,
            });
        }
        let cluster = &mut clusters[*number as usize];
        cluster.faces.extend_from_slice(faces);
        for &face in faces {
            cluster.mask = masks::union(&cluster.mask, &seen.masks[seen.place(face)]);
        }
    }

    // Vertices.
    let mut last_user = vec![u32::MAX; seen.mesh.vertex_count()];
    for (number, cluster) in (0..).zip(&mut clusters) {
        for &face in &cluster.faces {
            for vertex in seen.mesh.faces()[face as usize] {
                let last = &mut last_user[vertex as usize];
                cluster.vertices += usize::from(*last != number);
                *last = number;
            }
        }
    }
    clusters
}

/// Clusters in the order of a tour, with those joined that follow each other and together cost no more than apart.
pub(super) fn in_tour<const WORDS: usize>(
    mut clusters: Vec<FaceCluster<WORDS>>,
    directions: &[[f64; 3]],
    price: Price,
) -> Vec<FaceCluster<WORDS>> {
    let masks = |clusters: &[FaceCluster<WORDS>]| {
        let masks = clusters.iter().map(|cluster| cluster.mask);
        masks.collect::<Vec<_>>()
    };
    if clusters.len() > MOST_TO_ORDER {
        let along = tour::path(&masks(&clusters), directions);
        clusters = joined(clusters, &along, price);
    }
    if clusters.len() <= MOST_TO_ORDER {
        let tour = tour::path(&masks(&clusters), directions);
        clusters = joined(clusters, &tour, price);
    }
    clusters
}

/// Clusters in an order, with those joined that follow each other and together cost no more than apart, if nothing of them is
/// shared. Where no vertices are, as in soups, that makes the clusters.
fn joined<const WORDS: usize>(
    clusters: Vec<FaceCluster<WORDS>>,
    order: &[u32],
    price: Price,
) -> Vec<FaceCluster<WORDS>> {
    let mut clusters: Vec<Option<FaceCluster<WORDS>>> = clusters.into_iter().map(Some).collect();
    let mut joined: Vec<FaceCluster<WORDS>> = Vec::with_capacity(clusters.len());
    for &cluster in order {
        let Some(next) = clusters[cluster as usize].take() else {
            continue;
        };
        if let Some(last) = joined.last_mut() {
            let both = masks::union(&last.mask, &next.mask);
            let cost = |mask: &Mask<WORDS>, weight: f32| masks::count(mask) as f32 * weight;
            let [last_weight, next_weight] = [&*last, &next].map(|members| {
                price.weight(index32(members.vertices), index32(members.faces.len()))
            });
            let together = last_weight + next_weight - price.draw;
            if cost(&last.mask, last_weight) + cost(&next.mask, next_weight)
                >= cost(&both, together)
            {
                last.faces.extend(next.faces);
                last.vertices += next.vertices;
                last.mask = both;
                continue;
            }
        }
        joined.push(next);
    }
    joined
}
