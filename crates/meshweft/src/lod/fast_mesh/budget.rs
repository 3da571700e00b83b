//! The best mesh of at most a number of vertices, and updates that may take several frames.

use std::cmp::Reverse;

use super::changes::FrontChanges;
use super::front::Front;
use super::loader::{BlockLoader, Complete};
use super::queues::{BudgetQueues, Queued};
use crate::lod::view::{CameraView, DetailBound};

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

/// So many splits are passed in a frame at most, because they need more room than there can be.
const MOST_PASSED: usize = 16;

/// What the next step of an update is.
enum FrontStep {
    Split(u32),
    Collapse(u32),
    /// Of this point more is known than when it was put into the queue.
    LookAgain(u32),
}

impl Front {
    /// Makes the mesh what a view asks for, as far as a budget allows. Returns what changed, and whether that is all: if not, the
    /// next frame has something to do even if the camera stays.
    ///
    /// The largest errors on the screen are removed first. Where vertices are few, those whose errors are seen less make room for a split,
    /// if that can be enough for it; a split that cannot fit is passed, 16 in a frame at most. `hysteresis` is as for [`update`](Self::update); below 1, a vertex only makes room for another whose
    /// error is larger by that.
    ///
    /// # Complexity
    /// Time O(n log n) for n vertices that are active.
    ///
    /// # Panics
    /// If `hysteresis` is not above 0 and at most 1.
    pub fn update_within(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        budget: FrameBudget,
    ) -> (&FrontChanges, bool) {
        let Ok(is_done) = self.update_within_by(view, hysteresis, budget, &mut Complete);
        (self.changes(), is_done)
    }

    /// The same where points may be missing. If one cannot be read, the mesh is somewhere between, and what changed is said.
    pub(super) fn update_within_by<L: BlockLoader>(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        budget: FrameBudget,
        loader: &mut L,
    ) -> Result<bool, L::Error> {
        self.begin(hysteresis, true);
        let mut queues = std::mem::take(&mut self.queues);
        for list in [&self.waiting, &self.active] {
            self.moved.extend(list.points());
        }
        self.put_moved(view, &mut queues);

        let mut left = budget.changes;
        let result = loop {
            let step = self.next_step(&mut queues, hysteresis, budget.vertices, loader);
            let changed = match step {
                Ok(Some(FrontStep::LookAgain(point))) => {
                    self.moved.push(point);
                    Ok(())
                }
                Ok(Some(_)) if left == 0 => break Ok(false),
                Ok(Some(FrontStep::Split(point))) => {
                    left -= 1;
                    queues.splits.pop();
                    self.split(point, loader)
                }
                Ok(Some(FrontStep::Collapse(point))) => {
                    left -= 1;
                    self.collapse(point);
                    Ok(())
                }
                Ok(None) => break Ok(true),
                Err(error) => Err(error),
            };
            if let Err(error) = changed {
                break Err(error);
            }
            self.put_moved(view, &mut queues);
        };

        queues.room_for = None;
        queues.passed = 0;
        queues.splits.clear();
        queues.collapses.clear();
        self.queues = queues;
        self.settle();
        result
    }

    /// The most urgent split if there is room, or can be, or else the least urgent collapse.
    fn next_step<L: BlockLoader>(
        &mut self,
        queues: &mut BudgetQueues,
        hysteresis: f64,
        most_vertices: usize,
        loader: &mut L,
    ) -> Result<Option<FrontStep>, L::Error> {
        loop {
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
                return Ok(least.map(|it| FrontStep::Collapse(it.point)));
            }
            let most = queues.splits.peek().copied();
            let Some(most) = most.filter(|_| queues.passed < MOST_PASSED) else {
                let is_hidden = |it: &Queued| !it.urgency.is_above(hysteresis);
                let hidden = least.filter(is_hidden);
                return Ok(hidden.map(|it| FrontStep::Collapse(it.point)));
            };

            // What was not read before may be less urgent than it seemed to be.
            let is_new = self.fetch(most.point, loader)?;
            if is_new || !self.waiting_bound(most.point).is_same(&most.bound) {
                queues.splits.pop();
                return Ok(Some(FrontStep::LookAgain(most.point)));
            }

            let room = most_vertices - self.vertex_count();
            let added = self.count_needed(most.point, most_vertices, loader)?;
            if added <= room {
                return Ok(Some(FrontStep::Split(most.point)));
            }
            let makes_room = |it: &Queued| it.urgency.is_below(most.urgency, hysteresis);
            if queues.room_for != Some(most.point) {
                // With all that stays: the roots, and what is as urgent. A point may be in the queue twice.
                let stays = queues
                    .collapses
                    .iter()
                    .filter(|Reverse(it)| !makes_room(it));
                let mut staying = 0;
                for Reverse(it) in stays {
                    let is_active = self.is_leaving_active(it.point);
                    staying += usize::from(is_active && self.looked_at.touch(it.point, true));
                }
                self.looked_at.drain(|_, _| {});
                if self.hierarchy.roots as usize + staying + added > most_vertices {
                    queues.splits.pop();
                    queues.passed += 1;
                    continue;
                }
                queues.room_for = Some(most.point);
            }
            match least.filter(makes_room) {
                Some(least) => return Ok(Some(FrontStep::Collapse(least.point))),
                None => {
                    queues.splits.pop();
                    queues.passed += 1;
                }
            }
        }
    }

    /// How many vertices a split adds, with those of the points that it needs; one more than a number if that is above it.
    fn count_needed<L: BlockLoader>(
        &mut self,
        point: u32,
        most: usize,
        loader: &mut L,
    ) -> Result<usize, L::Error> {
        let mut count = 0;
        let mut result = Ok(());
        self.to_split.push(point);
        while let Some(point) = self.to_split.pop() {
            if self.is_active(point) || !self.looked_at.touch(point, false) {
                continue;
            }
            count += self.hierarchy.vertices_of(point).count();
            result = self.fetch(point, loader).map(|_| ());
            if count > most || result.is_err() {
                self.to_split.clear();
            } else {
                self.to_split.extend(self.hierarchy.needed_by(point));
            }
        }
        self.looked_at.drain(|_, _| {});
        result.map(|()| count.min(most.saturating_add(1)))
    }

    /// Points that are new in their lists, and those that no other needs any more, go into the queues.
    fn put_moved(&mut self, view: &CameraView, queues: &mut BudgetQueues) {
        while let Some(point) = self.moved.pop().or_else(|| self.to_collapse.pop()) {
            let queued = |bound: &DetailBound| Queued {
                urgency: view.urgency(bound),
                bound: *bound,
                point,
            };
            if self.is_waiting(point) {
                let queued = queued(self.waiting_bound(point));
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
