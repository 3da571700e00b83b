//! The surface that a view needs most, of a limited size.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

use super::descent::{Descent, TinSurface};
use super::triangle::{BisectionTree, Detail, NodeBound, TinTriangle};
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
pub(super) fn draw_within<T: BisectionTree>(
    tree: &T,
    view: &CameraView,
    limit: TinLimit,
    surface: &mut TinSurface,
) {
    let mut refined = Refined {
        tree,
        view,
        queue: BinaryHeap::new(),
        missing: Vec::new(),
    };

    // What is cut anyhow: along borders and holes.
    let mut faces = 0;
    let mut always = HashSet::new();
    for root in tree.roots() {
        faces += refined.add(&root, 0, &mut always);
    }
    let mut room = match limit {
        TinLimit::Faces(most) => most.saturating_sub(faces),
        TinLimit::Vertices(most) => most.saturating_sub(always.len()),
    };

    // Both triangles of a diamond are in the queue: whatever they come from is needed at least as much.
    let mut cut = HashSet::new();
    while let Some(first) = refined.queue.pop() {
        let split = first.triangle.split;
        let is_other = |it: &Waiting| it.triangle.split == split;
        let other = refined.queue.peek().is_some_and(is_other);
        let other = other.then(|| refined.queue.pop()).flatten();
        let diamond = [Some(first), other];
        let cost = refined.cost(diamond.iter().flatten(), limit);
        if cost > room {
            break;
        }
        room -= cost;
        cut.insert(split);
        for waiting in diamond.iter().flatten() {
            for half in tree.halves(&waiting.triangle) {
                refined.add(&half, waiting.depth + 1, &mut always);
            }
        }
    }

    let missing = refined.missing;
    let needs = |split, _: &NodeBound| cut.contains(&split);
    Descent {
        tree,
        needs,
        surface,
    }
    .run();
    surface.missing = missing;
}

struct Refined<'a, T> {
    tree: &'a T,
    view: &'a CameraView,
    queue: BinaryHeap<Waiting>,
    missing: Vec<usize>,
}

/// A triangle that may be cut.
struct Waiting {
    urgency: Urgency,
    depth: u32,
    triangle: TinTriangle,
    is_surface: bool,
}

impl<T: BisectionTree> Refined<'_, T> {
    /// A triangle of the surface: how many faces it is. Vertices of what is cut anyhow are collected.
    fn add(&mut self, triangle: &TinTriangle, depth: u32, always: &mut HashSet<u32>) -> usize {
        let is_surface = match self.tree.detail(triangle) {
            Detail::Outside => false,
            Detail::Finest => self.tree.is_surface(triangle),
            Detail::Missing(block) => {
                self.missing.push(block);
                false
            }
            Detail::Crossing => {
                let halves = self.tree.halves(triangle);
                return halves
                    .map(|it| self.add(&it, depth + 1, always))
                    .iter()
                    .sum();
            }
            Detail::Inside(bound) => {
                let detail = bound.detail();
                if self.view.needs(&detail) {
                    self.queue.push(Waiting {
                        urgency: self.view.urgency(&detail),
                        depth,
                        triangle: *triangle,
                        is_surface: bound.is_surface,
                    });
                }
                bound.is_surface
            }
        };
        if is_surface {
            always.extend([triangle.apex, triangle.left, triangle.right]);
        }
        usize::from(is_surface)
    }

    /// How much room it takes to cut a diamond.
    fn cost<'b>(&self, diamond: impl Iterator<Item = &'b Waiting>, limit: TinLimit) -> usize {
        // A triangle inside becomes two.
        let faces = diamond.filter(|it| it.is_surface).count();
        match limit {
            TinLimit::Faces(_) => faces,
            TinLimit::Vertices(_) => faces.min(1),
        }
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
