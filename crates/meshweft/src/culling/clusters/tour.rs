//! Clusters one after the other so that what an eye sees is few runs.

use super::masks::{self, Mask};
use crate::geometry::double::add;
use crate::index::index32;

/// How many clusters are known of each that are seen from nearly the same eyes.
const NEAR: usize = 10;

/// Up to this many clusters, each is compared with each.
const FEW: usize = 1500;

/// How many eyes see just one of two.
#[inline]
fn apart<const WORDS: usize>(a: &Mask<WORDS>, b: &Mask<WORDS>) -> u32 {
    masks::count::<WORDS>(&std::array::from_fn(|i| a[i] ^ b[i]))
}

/// More clusters than this stay in the order of a curve.
pub(super) const MOST_TO_ORDER: usize = 20_000;

/// An order of clusters in which few differ from the next, however many there are.
pub(super) fn path<const WORDS: usize>(masks: &[Mask<WORDS>], directions: &[[f64; 3]]) -> Vec<u32> {
    match masks.len() <= MOST_TO_ORDER {
        true => order(masks, directions),
        false => along_a_curve(masks, directions),
    }
}

/// An order of clusters in which the runs that an eye sees are few: a path through their masks on which few bits change.
///
/// Pairs that differ least are joined first, then the ends of what they make; then parts of the path are turned around and
/// moved as long as that makes it shorter.
///
/// # Complexity
/// Time about O(clusters · √clusters); space O(clusters).
fn order<const WORDS: usize>(masks: &[Mask<WORDS>], directions: &[[f64; 3]]) -> Vec<u32> {
    if masks.len() < 3 {
        return (0..index32(masks.len())).collect();
    }
    let near = nearest(masks, directions);
    let mut path = Tour::new(masks, &near);
    path.improve(masks, &near);
    path.order
}

/// Of each cluster some that differ little, the nearest first.
fn nearest<const WORDS: usize>(masks: &[Mask<WORDS>], directions: &[[f64; 3]]) -> Vec<Vec<u32>> {
    let count = index32(masks.len());
    let mut near: Vec<Vec<u32>> = vec![Vec::new(); masks.len()];
    if masks.len() <= FEW {
        for (cluster, near) in (0..).zip(&mut near) {
            near.extend((0..count).filter(|&other| other != cluster));
        }
    } else {
        for (cluster, other) in along_curves(masks, directions) {
            near[cluster as usize].push(other);
            near[other as usize].push(cluster);
        }
    }
    for (mask, near) in masks.iter().zip(&mut near) {
        let mut keyed: Vec<(u32, u32)> = near
            .iter()
            .map(|&other| (apart(mask, &masks[other as usize]), other))
            .collect();
        keyed.sort_unstable();
        keyed.dedup();
        keyed.truncate(NEAR);
        near.clear();
        near.extend(keyed.into_iter().map(|(_, other)| other));
    }
    near
}

/// Pairs that are near each other on one of some curves.
fn along_curves<const WORDS: usize>(
    masks: &[Mask<WORDS>],
    directions: &[[f64; 3]],
) -> Vec<(u32, u32)> {
    let sums: Vec<[f64; 3]> = masks.iter().map(|mask| sum(mask, directions)).collect();
    let mut pairs = Vec::new();
    for shift in [0.0, 0.21, 0.37] {
        let order = along_curve(&sums, shift);
        for step in 1..=NEAR {
            pairs.extend(order.iter().copied().zip(order[step..].iter().copied()));
        }
    }
    pairs
}

/// The clusters along a curve through the sums of the directions that they are seen from.
fn along_a_curve<const WORDS: usize>(masks: &[Mask<WORDS>], directions: &[[f64; 3]]) -> Vec<u32> {
    let sums: Vec<[f64; 3]> = masks.iter().map(|mask| sum(mask, directions)).collect();
    along_curve(&sums, 0.0)
}

/// The mean of the directions of the eyes that see something, over all eyes, from 0 to 1 instead of −1 to 1.
fn sum<const WORDS: usize>(mask: &Mask<WORDS>, directions: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (eye, direction) in directions.iter().enumerate() {
        if mask[eye / 64] >> (eye % 64) & 1 == 1 {
            sum = add(sum, *direction);
        }
    }
    sum.map(|x| 0.5 + 0.5 * x / directions.len() as f64)
}

/// Points in the order of a curve that goes through the eighths of a cube, and those of each.
fn along_curve(points: &[[f64; 3]], shift: f64) -> Vec<u32> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to 2¹⁰"
    )]
    let code = |point: &[f64; 3]| {
        let cells = point.map(|x| ((x + shift) * 640.0) as u32);
        (0..10).fold(0_u32, |code, bit| {
            let bits = cells.map(|cell| cell >> (9 - bit) & 1);
            code << 3 | bits[0] << 2 | bits[1] << 1 | bits[2]
        })
    };
    let mut keyed: Vec<(u32, u32)> = points.iter().map(code).zip(0..).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, place)| place).collect()
}

struct Tour {
    order: Vec<u32>,
    place_of: Vec<u32>,
}

impl Tour {
    fn new<const WORDS: usize>(masks: &[Mask<WORDS>], near: &[Vec<u32>]) -> Self {
        // The shortest steps first, each cluster in two, none that closes a ring.
        let mut steps = Vec::new();
        for (cluster, near) in (0_u32..).zip(near) {
            for &other in near {
                steps.push((
                    apart(&masks[cluster as usize], &masks[other as usize]),
                    cluster.min(other),
                    cluster.max(other),
                ));
            }
        }
        steps.sort_unstable();
        steps.dedup();
        let mut beside = vec![[u32::MAX; 2]; masks.len()];
        let mut end_of: Vec<u32> = (0..index32(masks.len())).collect();
        let mut join = |a: u32, b: u32, beside: &mut Vec<[u32; 2]>| {
            let is_free =
                |cluster: u32, beside: &[[u32; 2]]| beside[cluster as usize][1] == u32::MAX;
            if !is_free(a, beside) || !is_free(b, beside) || end_of[a as usize] == b {
                return;
            }
            for (from, to) in [(a, b), (b, a)] {
                let slot = usize::from(beside[from as usize][0] != u32::MAX);
                beside[from as usize][slot] = to;
            }
            let (far_a, far_b) = (end_of[a as usize], end_of[b as usize]);
            end_of[far_a as usize] = far_b;
            end_of[far_b as usize] = far_a;
        };
        for (_, a, b) in steps {
            join(a, b, &mut beside);
        }

        // Pieces, one after the other: next the one with the nearest end.
        let mut is_in = vec![false; masks.len()];
        let ends =
            (0..index32(masks.len())).filter(|&cluster| beside[cluster as usize][1] == u32::MAX);
        let mut ends: Vec<u32> = ends.collect();
        let mut order = Vec::with_capacity(masks.len());
        let mut at = ends[0];
        loop {
            let mut from = u32::MAX;
            loop {
                order.push(at);
                is_in[at as usize] = true;
                let next = beside[at as usize]
                    .into_iter()
                    .find(|&next| next != from && next != u32::MAX);
                from = at;
                match next {
                    Some(next) => at = next,
                    None => break,
                }
            }
            ends.retain(|&end| !is_in[end as usize]);
            let next = ends
                .iter()
                .min_by_key(|&&end| (apart(&masks[at as usize], &masks[end as usize]), end));
            match next {
                Some(&next) => at = next,
                None => break,
            }
        }
        let mut place_of = vec![0; masks.len()];
        for (place, &cluster) in (0..).zip(&order) {
            place_of[cluster as usize] = place;
        }
        Self { order, place_of }
    }

    fn improve<const WORDS: usize>(&mut self, masks: &[Mask<WORDS>], near: &[Vec<u32>]) {
        let count = self.order.len();
        let zero = [0; WORDS];
        // Before the first and after the last cluster nothing is seen.
        let mut queue: Vec<u32> = self.order.clone();
        let mut is_queued = vec![true; count];
        let mut left = 60 * count;
        while let Some(cluster) = queue.pop() {
            is_queued[cluster as usize] = false;
            if left == 0 {
                break;
            }
            left -= 1;
            let changed = self.better(cluster, masks, near, &zero);
            for cluster in changed.into_iter().flatten() {
                if !is_queued[cluster as usize] {
                    is_queued[cluster as usize] = true;
                    queue.push(cluster);
                }
            }
        }
    }

    /// Turns a part around, or moves up to three clusters, if that makes the path shorter; the clusters whose steps
    /// changed.
    fn better<const WORDS: usize>(
        &mut self,
        cluster: u32,
        masks: &[Mask<WORDS>],
        near: &[Vec<u32>],
        zero: &Mask<WORDS>,
    ) -> [Option<u32>; 6] {
        let mask_at = |order: &[u32], place: isize| match usize::try_from(place)
            .ok()
            .and_then(|place| order.get(place))
        {
            Some(&cluster) => &masks[cluster as usize],
            None => zero,
        };
        let step = |order: &[u32], a: isize, b: isize| {
            i64::from(apart(mask_at(order, a), mask_at(order, b)))
        };
        let at = |order: &[u32], place: isize| {
            usize::try_from(place)
                .ok()
                .and_then(|place| order.get(place))
                .copied()
        };
        let i = self.place_of[cluster as usize] as isize;
        for &other in &near[cluster as usize] {
            let j = self.place_of[other as usize] as isize;
            let direct = i64::from(apart(&masks[cluster as usize], &masks[other as usize]));
            let order = &self.order;
            let (low, high) = (i.min(j), i.max(j));
            // Their next ones change: a-b … c-d becomes a-c … b-d; or their last ones.
            let after =
                step(order, i, i + 1) + step(order, j, j + 1) - direct - step(order, i + 1, j + 1);
            let before =
                step(order, i - 1, i) + step(order, j - 1, j) - direct - step(order, i - 1, j - 1);
            let turn = match after >= before {
                true if after > 0 => Some((low + 1, high)),
                false if before > 0 => Some((low, high - 1)),
                _ => None,
            };
            if let Some((from, to)) = turn {
                let ends = [
                    at(order, from - 1),
                    at(order, from),
                    at(order, to),
                    at(order, to + 1),
                    None,
                    None,
                ];
                self.turn(from, to);
                return ends;
            }

            // Up to three clusters that begin or end with this one go beside the other.
            for length in 1..=3_isize {
                for (from, to) in [(i, i + length - 1), (i - length + 1, i)] {
                    if from < 0 || to >= self.order.len() as isize || (from <= j && j <= to) {
                        continue;
                    }
                    let order = &self.order;
                    let gone = step(order, from - 1, from) + step(order, to, to + 1)
                        - step(order, from - 1, to + 1);
                    let tail = if from == i { to } else { from };
                    for (a, b) in [(j, j + 1), (j - 1, j)] {
                        if a == to || b == from {
                            continue;
                        }
                        let outer = if a == j { b } else { a };
                        let new = direct + step(order, tail, outer) - step(order, a, b);
                        if gone > new {
                            let ends = [
                                at(order, from - 1),
                                at(order, to + 1),
                                at(order, a),
                                at(order, b),
                                at(order, from),
                                at(order, to),
                            ];
                            let is_turned = (a == j) != (from == i);
                            self.shift(from, to, a, is_turned);
                            return ends;
                        }
                    }
                }
            }
        }
        [None; 6]
    }

    fn turn(&mut self, from: isize, to: isize) {
        let (from, to) = (from.unsigned_abs(), to.unsigned_abs());
        self.order[from..=to].reverse();
        self.renumber(from, to);
    }

    /// Moves a part to where it follows place `after`.
    fn shift(&mut self, from: isize, to: isize, after: isize, is_turned: bool) {
        let (first, last) = (from.unsigned_abs(), to.unsigned_abs());
        if is_turned {
            self.order[first..=last].reverse();
        }
        let length = last - first + 1;
        match after > to {
            true => {
                let end = after.unsigned_abs();
                self.order[first..=end].rotate_left(length);
                self.renumber(first, end);
            }
            false => {
                let start = (after + 1).unsigned_abs();
                self.order[start..=last].rotate_right(length);
                self.renumber(start, last);
            }
        }
    }

    fn renumber(&mut self, from: usize, to: usize) {
        for (place, &cluster) in (index32(from)..).zip(&self.order[from..=to]) {
            self.place_of[cluster as usize] = place;
        }
    }
}
