//! Faces that are drawn together.

use super::masks::{self, Mask};
use super::merge::Price;
use crate::index::index32;

/// Faces of one cluster, and the eyes that see something of them.
#[derive(Debug, Clone)]
pub(super) struct FaceCluster<const WORDS: usize> {
    pub(super) faces: Vec<u32>,
    pub(super) mask: Mask<WORDS>,
    pub(super) vertices: usize,
}

/// Clusters in an order, with those joined that follow each other and together cost no more than apart, if nothing of them is
/// shared. Where no vertices are, as in soups, that makes the clusters.
pub(super) fn joined<const WORDS: usize>(
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
