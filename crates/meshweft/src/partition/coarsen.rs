//! Coarser graphs by heavy-edge matching.

use super::graph::Graph;
use crate::index::index32;
use crate::random::{SplitMix64, shuffled};

/// A graph of about half as many vertices, whose vertices are groups of one or two of this one's,
/// and the group of each vertex; `None` if too few could be paired.
///
/// Each vertex, in random order, is paired with a neighbour that is still alone, the one across the
/// heaviest edge: that edge can no longer be cut. Pairs heavier than `most` are not made, so that
/// the coarsest vertices can still be balanced.
pub(crate) fn coarser(
    graph: &Graph,
    most: u64,
    random: &mut SplitMix64,
) -> Option<(Graph, Vec<u32>)> {
    const ALONE: u32 = u32::MAX;
    let vertex_count = graph.vertex_count();
    let mut group_of = vec![ALONE; vertex_count];
    let mut count = 0;

    for vertex in shuffled(vertex_count, random.next()) {
        if group_of[vertex as usize] != ALONE {
            continue;
        }

        // The heaviest edge; ties to the lightest vertex, so that weights stay similar.
        let weight = u64::from(graph.weights[vertex as usize]);
        let mut best = None;
        let mut best_key = (0, 0);
        for &(other, edge) in graph.row(vertex) {
            let other_weight = graph.weights[other as usize];
            let key = (edge, u32::MAX - other_weight);
            if group_of[other as usize] == ALONE
                && key > best_key
                && weight + u64::from(other_weight) <= most
            {
                best_key = key;
                best = Some(other);
            }
        }

        group_of[vertex as usize] = count;
        if let Some(other) = best {
            group_of[other as usize] = count;
        }
        count += 1;
    }

    // More than 19 of 20 left: another level would not be worth it.
    if count as usize * 20 > vertex_count * 19 {
        return None;
    }

    // Number the groups by their first member, so that what was near in memory stays near.
    let mut number = vec![ALONE; count as usize];
    let mut next = 0;
    for group in &mut group_of {
        let number = &mut number[*group as usize];
        if *number == ALONE {
            *number = next;
            next += 1;
        }
        *group = *number;
    }
    debug_assert_eq!(next, index32(count as usize));

    let coarse = graph.contracted(&group_of, count as usize);
    Some((coarse, group_of))
}
