//! The optimum against all there is to choose, and the policies against the optimum.

use std::collections::BTreeMap;

use super::{EvictionPolicy, GeometryCache, RecordedPath};
use crate::random::SplitMix64;

fn inserts(path: &RecordedPath, slots: usize, errors: &[f32], eviction: EvictionPolicy) -> u64 {
    let mut cache = GeometryCache::new(slots, errors.to_vec(), eviction).unwrap();
    let mut inserts = 0;
    for (added, removed) in path.frames() {
        let statistics = cache.change(added, removed).unwrap().statistics();
        assert_eq!(statistics.overruled, 0);
        inserts += statistics.inserts as u64;
    }
    inserts
}

/// The fewest inserts by trying every set of residents that each frame could leave.
fn by_trying_all(frames: &[u32], vertices: u32, slots: u32) -> u64 {
    let mut fewest: BTreeMap<u32, u64> = [(0, 0)].into();
    for &active in frames {
        let mut next = BTreeMap::new();
        for (&resident, &inserts) in &fewest {
            let inserts = inserts + u64::from((active & !resident).count_ones());
            let may_stay = active | resident;
            for left in 0..1 << vertices {
                if left & active == active
                    && left & !may_stay == 0
                    && u32::count_ones(left) <= slots
                {
                    let least = next.entry(left).or_insert(inserts);
                    *least = inserts.min(*least);
                }
            }
        }
        fewest = next;
    }
    fewest.into_values().min().unwrap()
}

#[test]
fn no_choice_is_better_than_the_optimum() {
    let random = &mut SplitMix64(1);
    let mut above_distinct = 0;
    for case in 0..300 {
        let vertices = 4 + random.below(4);
        let slots = 3 + random.below(2);
        let mut path = RecordedPath::new(vertices);
        let mut frames = Vec::new();
        for _ in 0..12 {
            let active: Vec<u32> = (0..random.below(slots + 1))
                .map(|_| u32::try_from(random.below(vertices)).unwrap())
                .collect();
            frames.push(active.iter().fold(0, |bits, vertex| bits | 1 << vertex));
            match case % 2 {
                0 => path.push_active(&active).unwrap(),
                // Whatever was active is removed, and some of it added again.
                _ => {
                    let all: Vec<u32> = (0..u32::try_from(vertices).unwrap()).collect();
                    path.push_change(&active, &all).unwrap();
                }
            }
        }
        let fewest = by_trying_all(
            &frames,
            u32::try_from(vertices).unwrap(),
            u32::try_from(slots).unwrap(),
        );
        assert_eq!(path.fewest_inserts(slots), Some(fewest));
        assert!(fewest >= path.distinct_vertices() as u64);
        above_distinct += u32::from(fewest > path.distinct_vertices() as u64);
        assert_eq!(
            path.fewest_inserts(vertices),
            Some(path.distinct_vertices() as u64)
        );
        let all: u32 = frames.iter().map(|active| active.count_ones()).sum();
        assert_eq!(path.all_active(), u64::from(all));
        let most = frames
            .iter()
            .map(|active| active.count_ones() as usize)
            .max();
        assert_eq!(Some(path.most_active()), most);
        assert!(most == Some(0) || path.fewest_inserts(path.most_active() - 1).is_none());

        let errors: Vec<f32> = (0..vertices).map(|_| random.below(9) as f32).collect();
        for eviction in EvictionPolicy::ALL {
            assert!(
                inserts(&path, slots, &errors, eviction) >= fewest,
                "{eviction}"
            );
        }
    }
    assert!(above_distinct > 100, "{above_distinct}");
}

/// A square as a hierarchy of cells: the finer, the nearer the eye must be; what is behind the eye is not active.
struct Cells {
    /// Middle and size of each.
    cells: Vec<[f32; 3]>,
}

impl Cells {
    fn new(levels: u32) -> Self {
        let mut cells = Vec::new();
        for level in 0..levels {
            let side = 1_u16 << level;
            let size = 1.0 / f32::from(side);
            let middle = |i: u16| (f32::from(i) + 0.5) * size;
            for y in 0..side {
                cells.extend((0..side).map(|x| [middle(x), middle(y), size]));
            }
        }
        Self { cells }
    }

    fn errors(&self) -> Vec<f32> {
        self.cells.iter().map(|&[.., size]| size).collect()
    }

    /// A path of an eye and where it looks, by the time from 0 to 1.
    fn path(&self, frames: u16, eye: impl Fn(f32) -> ([f32; 2], f32)) -> RecordedPath {
        let mut path = RecordedPath::new(self.cells.len());
        for frame in 0..frames {
            let ([x, y], angle) = eye(f32::from(frame) / f32::from(frames));
            let is_active = |&[cell_x, cell_y, size]: &[f32; 3]| {
                let [to_x, to_y] = [cell_x - x, cell_y - y];
                let distance = to_x.hypot(to_y);
                let ahead = to_x * angle.cos() + to_y * angle.sin();
                distance < 3.0 * size && ahead > 0.6 * distance - size
            };
            let active: Vec<u32> = (0..)
                .zip(&self.cells)
                .filter_map(|(number, cell)| is_active(cell).then_some(number))
                .collect();
            path.push_active(&active).unwrap();
        }
        path
    }
}

/// The order of the paper's tables, on a circle, on a flight with turns, and on a look to and fro.
#[test]
fn policies_come_in_the_order_of_the_paper() {
    let cells = Cells::new(7);
    let turn = std::f32::consts::TAU;
    let circle = cells.path(300, |t| {
        let [sin, cos] = [(turn * t).sin(), (turn * t).cos()];
        ([0.5 + 0.25 * cos, 0.5 + 0.25 * sin], turn * (t + 0.25))
    });
    let flight = cells.path(400, |t| {
        let place = [
            0.5 + 0.3 * (8.2 * t).sin(),
            0.5 + 0.3 * (13.0 * t + 0.7).sin(),
        ];
        (place, 10.7 * t + 1.2 * (25.0 * t).sin())
    });
    let rotations = cells.path(300, |t| ([0.5, 0.5], 0.9 * (6.0 * turn * t).sin()));
    let errors = cells.errors();
    for (path, name) in [
        (circle, "circle"),
        (flight, "flight"),
        (rotations, "rotations"),
    ] {
        for slots in [path.most_active() * 5 / 4, path.most_active() * 2] {
            let found =
                EvictionPolicy::ALL.map(|eviction| inserts(&path, slots, &errors, eviction));
            let fewest = path.fewest_inserts(slots).unwrap();
            let [none, first_available, lru, queued, finest] = found;
            assert_eq!(none, path.all_active());
            assert!(none > 10 * first_available);
            assert!(first_available >= lru && lru >= queued);
            // Where a look goes to and fro over few slots, the oldest is the best choice.
            assert!(finest <= queued || name == "rotations");
            assert!(finest as f64 <= 1.15 * fewest as f64);
            assert!(finest >= fewest && fewest >= path.distinct_vertices() as u64);
        }
    }
}
