//! The best mesh of at most a number of vertices, and updates that may take several frames.

use std::cmp::Reverse;

use super::changes::FrontChanges;
use super::front::{Front, WAITING};
use super::queues::{BudgetQueues, Queued};
use super::view::CameraView;

/// What a frame may have and may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameBudget {
    /// How many vertices may be active at most. The coarsest mesh is kept, however small this is.
    pub vertices: usize,
    /// How many points may be split and collapsed, but for the points that these need in turn. The next frame goes on.
    pub changes: usize,
}

impl Default for FrameBudget {
    /// No limits.
    fn default() -> Self {
        Self {
            vertices: usize::MAX,
            changes: usize::MAX,
        }
    }
}

/// What the next step of an update is.
enum FrontStep {
    Split(u32),
    Collapse(u32),
}

impl Front {
    /// Makes the mesh what a view asks for, as far as a budget allows; returns whether that is all that it allows, or whether the
    /// next frame has something to do even if the camera stays.
    ///
    /// The errors that are seen most leave first. With few vertices these go where the errors are largest on the screen: the
    /// largest one that is left is that of the next split, which does not fit, and no vertex with a smaller one is active
    /// but those that others need. `hysteresis` is as for [`update`](Self::update); below 1, a vertex only makes room for another whose
    /// error is larger by that.
    ///
    /// # Complexity
    /// Time O(n log n) for n vertices that are active, a hundred nanoseconds each or so.
    ///
    /// # Panics
    /// If `hysteresis` is not above 0 and at most 1.
    pub fn update_within(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        budget: FrameBudget,
    ) -> (&FrontChanges, bool) {
        self.begin(hysteresis);
        let mut queues = std::mem::take(&mut self.queues);
        for list in [&self.waiting, &self.active] {
            self.moved.extend(list.points());
        }
        self.put_moved(view, &mut queues);

        let mut left = budget.changes;
        let mut is_done = false;
        while left > 0 {
            let Some(step) = self.next_step(&mut queues, hysteresis, budget.vertices) else {
                is_done = true;
                break;
            };
            left -= 1;
            match step {
                FrontStep::Split(point) => self.split(point),
                FrontStep::Collapse(point) => self.collapse(point),
            }
            self.put_moved(view, &mut queues);
        }

        queues.splits.clear();
        queues.collapses.clear();
        self.queues = queues;
        (self.settle(), is_done)
    }

    /// The most urgent split if there is room, or else the least urgent collapse.
    fn next_step(
        &mut self,
        queues: &mut BudgetQueues,
        hysteresis: f64,
        most_vertices: usize,
    ) -> Option<FrontStep> {
        // Points that were split with others, or left the list, are passed.
        // Points that were split with others, or that others need by now, are passed.
        while let Some(top) = queues.splits.peek()
            && !self.is_waiting(top.point)
        {
            queues.splits.pop();
        }
        while let Some(Reverse(top)) = queues.collapses.peek()
            && !self.can_collapse(top.point)
        {
            queues.collapses.pop();
        }
        let least = queues.collapses.peek().map(|it| it.0);

        if self.vertex_count() > most_vertices {
            return least.map(|it| FrontStep::Collapse(it.point));
        }
        let Some(&most) = queues.splits.peek() else {
            let is_hidden = |it: &Queued| !it.urgency.is_above(hysteresis);
            return least
                .filter(is_hidden)
                .map(|it| FrontStep::Collapse(it.point));
        };
        let room = most_vertices - self.vertex_count();
        if self.needs_at_most(most.point, room) {
            return Some(FrontStep::Split(most.point));
        }
        let makes_room = |it: &Queued| it.urgency.is_below(most.urgency, hysteresis);
        least
            .filter(makes_room)
            .map(|it| FrontStep::Collapse(it.point))
    }

    /// Whether a split adds at most this number of vertices, with those of the points that it needs.
    fn needs_at_most(&mut self, point: u32, room: usize) -> bool {
        let mut count = 0;
        self.to_split.push(point);
        while let Some(point) = self.to_split.pop() {
            if self.is_active(point) || !self.looked_at.touch(point, false) {
                continue;
            }
            count += self.hierarchy.vertices_of(point).count();
            if count > room {
                self.to_split.clear();
            } else {
                self.to_split.extend(self.hierarchy.needed_by(point));
            }
        }
        self.looked_at.drain(|_, _| {});
        count <= room
    }

    /// Points that are new in their lists, and those that no other needs any more, go into the queues.
    fn put_moved(&mut self, view: &CameraView, queues: &mut BudgetQueues) {
        while let Some(point) = self.moved.pop().or_else(|| self.to_collapse.pop()) {
            let queued = |bound| Queued {
                urgency: view.urgency(bound),
                point,
            };
            if self.is_waiting(point) {
                let queued = queued(self.waiting.bound(self.places[point as usize] - WAITING));
                if queued.urgency.is_above(1.0) {
                    queues.splits.push(queued);
                }
            } else if self.can_collapse(point) {
                let queued = queued(self.active.bound(self.places[point as usize]));
                queues.collapses.push(Reverse(queued));
            }
        }
    }
}
