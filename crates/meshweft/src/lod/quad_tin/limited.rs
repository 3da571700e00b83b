//! The surface that a view needs most, of a limited size.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap, HashSet};

use super::descent::{Descent, TinSurface};
use super::triangle::{BisectionTree as _, Detail, DrawnTree, NodeBound, TinTriangle};
use crate::lod::view::{CameraView, Urgency};

/// What a surface may have at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TinLimit {
    /// A number of faces.
    Faces(usize),
    /// A number of vertices.
    Vertices(usize),
}

/// Draws what a view needs, the worst first, as long as there is room.
pub(super) fn draw_within(
    mut drawn: impl DrawnTree,
    view: &CameraView,
    limit: TinLimit,
    surface: &mut TinSurface,
) {
    let mut refined = Refined {
        drawn: &mut drawn,
        view,
        limit,
    };

    // What is cut anyhow: along borders and holes.
    let mut waiting: BTreeMap<u32, Vec<Waiting>> = BTreeMap::new();
    let mut first = Vec::new();
    for root in refined.drawn.tree().roots() {
        refined.add(&root, 0, Some(&mut first), &mut |it| {
            waiting.entry(it.urgency.step()).or_default().push(it);
        });
    }
    let mut room = match limit {
        TinLimit::Faces(most) => most.saturating_sub(first.len()),
        TinLimit::Vertices(most) => most.saturating_sub(distinct(first.into_flattened())),
    };

    // Step by step less urgent: whatever a triangle comes from is needed at least as much.
    let mut cut = Cut::default();
    while let Some((step, triangles)) = waiting.pop_last() {
        match refined.cost_of_all(step, &triangles, room, &mut waiting) {
            Some(cost) => room -= cost,
            None => {
                cut = Cut {
                    last_step: step,
                    of_last_step: refined.worst_of(triangles, room),
                };
                break;
            }
        }
    }

    let needs = |split, bound: &NodeBound| {
        let urgency = view.needed_urgency(&bound.detail());
        urgency.is_some_and(|it| cut.has(split, it.step()))
    };
    Descent::new(&mut drawn, needs, surface).run();
}

/// How many numbers are different.
fn distinct(mut numbers: Vec<u32>) -> usize {
    numbers.sort_unstable();
    numbers.dedup();
    numbers.len()
}

/// What is cut: all of higher steps, and of the last one only some.
#[derive(Debug, Default)]
struct Cut {
    last_step: u32,
    of_last_step: HashSet<u32>,
}

impl Cut {
    fn has(&self, split: u32, step: u32) -> bool {
        step > self.last_step || step == self.last_step && self.of_last_step.contains(&split)
    }
}

struct Refined<'a, D> {
    drawn: &'a mut D,
    view: &'a CameraView,
    limit: TinLimit,
}

/// A triangle that may be cut.
#[derive(Debug, Clone, Copy)]
struct Waiting {
    urgency: Urgency,
    depth: u32,
    triangle: TinTriangle,
    is_surface: bool,
}

impl<D: DrawnTree> Refined<'_, D> {
    /// A triangle: its faces that are drawn whatever is cut later, if they are collected, and what may be cut.
    fn add(
        &mut self,
        triangle: &TinTriangle,
        depth: u32,
        mut faces: Option<&mut Vec<[u32; 3]>>,
        wait: &mut dyn FnMut(Waiting),
    ) {
        let is_surface = match triangle.detail_in(self.drawn) {
            Detail::Outside | Detail::Missing(_) => false,
            Detail::Finest => self.drawn.tree().is_surface(triangle),
            Detail::Crossing => {
                for half in self.drawn.tree().halves(triangle) {
                    self.add(&half, depth + 1, faces.as_deref_mut(), wait);
                }
                return;
            }
            Detail::Inside(bound) => {
                let is_surface = bound.surface[usize::from(triangle.side)];
                if let Some(urgency) = self.view.needed_urgency(&bound.detail()) {
                    wait(Waiting {
                        urgency,
                        depth,
                        triangle: *triangle,
                        is_surface,
                    });
                }
                is_surface
            }
        };
        if is_surface && let Some(faces) = faces {
            faces.push([triangle.apex, triangle.left, triangle.right]);
        }
    }

    /// The halves of a triangle.
    fn add_halves(&mut self, cut: &Waiting, wait: &mut dyn FnMut(Waiting)) {
        for half in self.drawn.tree().halves(&cut.triangle) {
            self.add(&half, cut.depth + 1, None, wait);
        }
    }

    /// How much room it takes to cut all triangles of a step, with those of it that come then; `None` if there is not as much. What is
    /// less urgent waits.
    fn cost_of_all(
        &mut self,
        step: u32,
        triangles: &[Waiting],
        room: usize,
        waiting: &mut BTreeMap<u32, Vec<Waiting>>,
    ) -> Option<usize> {
        // Two triangles at most are cut at a vertex.
        let most = match self.limit {
            TinLimit::Faces(_) => room,
            TinLimit::Vertices(_) => room.saturating_mul(2),
        };
        let mut stack = triangles.to_vec();
        let mut splits = Vec::new();
        while let Some(cut) = stack.pop() {
            if cut.is_surface {
                splits.push(cut.triangle.split);
            }
            if splits.len() > most {
                return None;
            }
            self.add_halves(&cut, &mut |it| match it.urgency.step() {
                less if less < step => waiting.entry(less).or_default().push(it),
                _ => stack.push(it),
            });
        }
        let cost = match self.limit {
            TinLimit::Faces(_) => splits.len(),
            TinLimit::Vertices(_) => distinct(splits),
        };
        (cost <= room).then_some(cost)
    }

    /// Where triangles are cut, the most urgent first, until there is no room left.
    fn worst_of(&mut self, triangles: Vec<Waiting>, mut room: usize) -> HashSet<u32> {
        let mut cut = HashSet::new();
        let mut queue = BinaryHeap::from(triangles);
        while let Some(first) = queue.pop() {
            // Both triangles of a diamond are in the queue: whatever they come from is needed at least as much.
            let split = first.triangle.split;
            let is_other = |it: &Waiting| it.triangle.split == split;
            let other = queue.peek().is_some_and(is_other);
            let other = other.then(|| queue.pop()).flatten();
            let diamond = [Some(first), other];

            // A triangle of the surface becomes two.
            let diamond = diamond.iter().flatten();
            let faces = diamond.clone().filter(|it| it.is_surface).count();
            let cost = match self.limit {
                TinLimit::Faces(_) => faces,
                TinLimit::Vertices(_) => faces.min(1),
            };
            if cost > room {
                break;
            }
            room -= cost;
            cut.insert(split);
            for waiting in diamond {
                self.add_halves(waiting, &mut |it| queue.push(it));
            }
        }
        cut
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of equal urgency, coarse ones first; the two of a diamond follow each other.
        self.urgency
            .order(other.urgency)
            .then(other.depth.cmp(&self.depth))
            .then(self.triangle.split.cmp(&other.triangle.split))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
