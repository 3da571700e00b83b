//! The faces that are in no meshlet yet, found by where they are.

use crate::geometry::double::{dot, sub, widened};
use crate::index::index32;

/// Faces in a leaf, at most.
const LEAF: usize = 16;

/// A balanced tree over the middles of faces, halved along the longest side of the box around them: at the top all of them,
/// below node `n` its halves `2n` and `2n + 1`.
#[derive(Debug)]
pub(super) struct Remaining {
    /// The faces, those of a node side by side, and where each is.
    faces: Vec<u32>,
    places: Vec<u32>,
    middles: Vec<[f32; 3]>,
    nodes: Vec<TreeNode>,
    /// How often the faces are halved.
    depth: u32,
    is_taken: Vec<bool>,
}

#[derive(Debug, Clone, Copy)]
struct TreeNode {
    low: [f32; 3],
    high: [f32; 3],
    left: u32,
}

impl Remaining {
    /// Faces by their middles, which are finite.
    pub(super) fn new(middles: &[[f32; 3]]) -> Self {
        let count = middles.len();
        let mut depth = 0;
        while count.div_ceil(1 << depth) > LEAF {
            depth += 1;
        }
        let empty = TreeNode {
            low: [0.0; 3],
            high: [0.0; 3],
            left: 0,
        };
        let mut faces: Vec<u32> = (0..index32(count)).collect();
        let mut nodes = vec![empty; 2 << depth];
        halve(&mut faces, middles, &mut nodes, 1, depth);
        let mut places = vec![0; count];
        for (place, &face) in (0..).zip(&faces) {
            places[face as usize] = place;
        }
        Self {
            middles: faces.iter().map(|&face| middles[face as usize]).collect(),
            is_taken: vec![false; count],
            faces,
            places,
            nodes,
            depth,
        }
    }

    /// Takes a face away.
    pub(super) fn take(&mut self, face: u32) {
        let place = self.places[face as usize] as usize;
        if std::mem::replace(&mut self.is_taken[place], true) {
            return;
        }
        let (mut node, mut start, mut end) = (1, 0_usize, self.faces.len());
        self.nodes[node].left -= 1;
        for _ in 0..self.depth {
            let middle = start.midpoint(end);
            node *= 2;
            if place < middle {
                end = middle;
            } else {
                start = middle;
                node += 1;
            }
            self.nodes[node].left -= 1;
        }
    }

    /// The face nearest to a point of those that are left.
    pub(super) fn nearest(&self, point: [f64; 3]) -> Option<u32> {
        let mut best = (f64::INFINITY, u32::MAX);
        self.search(point, 1, 0..self.faces.len(), &mut best);
        (best.1 != u32::MAX).then_some(best.1)
    }

    fn search(
        &self,
        point: [f64; 3],
        node: usize,
        places: std::ops::Range<usize>,
        best: &mut (f64, u32),
    ) {
        if self.nodes[node].left == 0 {
            return;
        }
        if node >= 1 << self.depth {
            for place in places {
                let square = square_of(sub(widened(self.middles[place]), point));
                let found = (square, self.faces[place]);
                if !self.is_taken[place] && found < *best {
                    *best = found;
                }
            }
            return;
        }

        // The nearer half first.
        let middle = places.start.midpoint(places.end);
        let halves = [places.start..middle, middle..places.end];
        let distances = [0, 1].map(|half| self.nodes[2 * node + half].square_to(point));
        let nearer = usize::from(distances[1] < distances[0]);
        for half in [nearer, 1 - nearer] {
            if distances[half] < best.0 {
                self.search(point, 2 * node + half, halves[half].clone(), best);
            }
        }
    }
}

impl TreeNode {
    /// The square of the distance from a point to the box.
    fn square_to(&self, point: [f64; 3]) -> f64 {
        square_of([0, 1, 2].map(|axis| {
            let [low, high] = [self.low, self.high].map(|end| f64::from(end[axis]));
            (low - point[axis]).max(point[axis] - high).max(0.0)
        }))
    }
}

fn square_of(way: [f64; 3]) -> f64 {
    dot(way, way)
}

/// Sorts the faces of a node into its halves, and those of the halves.
fn halve(faces: &mut [u32], middles: &[[f32; 3]], nodes: &mut [TreeNode], node: usize, depth: u32) {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for &face in &*faces {
        let middle = middles[face as usize];
        low = [0, 1, 2].map(|axis| low[axis].min(middle[axis]));
        high = [0, 1, 2].map(|axis| high[axis].max(middle[axis]));
    }
    nodes[node] = TreeNode {
        low,
        high,
        left: index32(faces.len()),
    };
    let Some(depth) = depth.checked_sub(1) else {
        return;
    };

    let length = |axis: usize| f64::from(high[axis]) - f64::from(low[axis]);
    let longer = |axis: usize, other: usize| {
        if length(other) > length(axis) {
            other
        } else {
            axis
        }
    };
    let axis = longer(longer(0, 1), 2);
    let middle = faces.len() / 2;
    if middle < faces.len() {
        let along = |face: &u32| middles[*face as usize][axis];
        faces.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
    }
    let (first, second) = faces.split_at_mut(middle);
    halve(first, middles, nodes, 2 * node, depth);
    halve(second, middles, nodes, 2 * node + 1, depth);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn the_nearest_is_that_of_all_that_are_left() {
        let mut random = SplitMix64(1);
        for case in 0..60 {
            let count = [0, 1, 2, 17, 33, 300][case % 6];
            let range = [1, 5, 1000][case % 3];
            let mut point = || [(); 3].map(|()| random.below(range) as f32);
            let middles: Vec<[f32; 3]> = (0..count).map(|_| point()).collect();
            let mut remaining = Remaining::new(&middles);
            let mut left: Vec<u32> = (0..index32(count)).collect();
            loop {
                let at = widened(point());
                let square = |face: &u32| square_of(sub(widened(middles[*face as usize]), at));
                let least = left.iter().map(square).min_by(f64::total_cmp);
                let found = remaining.nearest(at);
                assert_eq!(found.as_ref().map(square), least);
                let Some(found) = found else { break };
                remaining.take(found);
                remaining.take(found);
                left.retain(|&face| face != found);
            }
            assert!(left.is_empty());
        }
    }
}
