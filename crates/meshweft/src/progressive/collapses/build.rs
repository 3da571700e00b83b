//! The loop: which point is removed next, and what is noted of it.

use super::balance::{self, HierarchyBalance};
use super::costs::RemovalCosts;
use super::fan::{Move, Precision};
use super::link::{self, Marks};
use super::parts::ConnectedParts;
use super::queue::RemovalQueue;
use super::remaining::{FanFace, NONE, RemainingMesh};
use super::settings::Collapses;
use crate::attribute::Attribute;
use crate::index::index32;
use crate::progress::Progress;
use crate::progressive::records::{Records, SidePair};

/// Points that are looked at between two reports of the progress.
const TOLD_AFTER: u64 = 1024;

/// What is known while points are removed.
pub(super) struct Builder<'a> {
    settings: Collapses,
    rest: RemainingMesh<'a>,
    queue: RemovalQueue,
    is_locked: Vec<bool>,
    costs: RemovalCosts,
    parts: Option<ConnectedParts>,
    /// Where removals are for a hierarchy.
    balance: Option<HierarchyBalance>,
    records: Records,
    largest_error: f32,
    marks: Marks,
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        settings: Collapses,
        mut rest: RemainingMesh<'a>,
        attributes: &[&Attribute],
    ) -> Self {
        let points = rest.point_count();
        let parts = settings.drop_parts.then(|| ConnectedParts::new(&mut rest));
        Self {
            settings,
            queue: RemovalQueue::new(points + parts.as_ref().map_or(0, ConnectedParts::len)),
            is_locked: link::locked(&mut rest, settings.lock_border),
            costs: RemovalCosts::new(&settings, &rest, attributes),
            parts,
            balance: None,
            records: Records::default(),
            largest_error: 0.0,
            marks: Marks::new(points),
            rest,
        }
    }

    /// The same, but removals are for a hierarchy: none is far above another, and each can be undone as soon as those around it
    /// are.
    pub(super) fn for_hierarchy(mut self) -> Self {
        self.balance = Some(HierarchyBalance::new(self.rest.point_count()));
        self
    }

    /// What a move costs, all in all.
    fn cost(&self, point: u32, found: &Move) -> f64 {
        match &self.balance {
            Some(balance) => balance.cost(point, found, self.costs.area_for_balance(&self.rest)),
            None => found.cost,
        }
    }

    /// The place of the cheapest move.
    fn cheapest(&self, point: u32) -> Option<usize> {
        let moves = &self.costs.moves;
        let cost = |at: usize| self.cost(point, &moves[at]);
        (0..moves.len()).min_by(|&a, &b| cost(a).total_cmp(&cost(b)))
    }

    /// Removes points as long as there are too many faces; returns what was done and whether the error was
    /// the limit.
    pub(super) fn run(mut self, progress: &dyn Progress) -> (Records, bool) {
        self.leave_degenerate();
        let first = self.rest.live_faces().max(1);
        let (mut turns, mut is_stopped) = (0_u64, false);
        while !is_stopped && self.rest.live_faces() > self.settings.faces {
            let before = self.records.len();
            self.enqueue_all();
            while self.rest.live_faces() > self.settings.faces
                && !is_stopped
                && let Some(next) = self.queue.pop()
            {
                turns += 1;
                if turns.is_multiple_of(TOLD_AFTER) {
                    let left = self.rest.live_faces() as f64 / first as f64;
                    is_stopped = progress.report(1.0 - left).is_break();
                }
                match (next as usize).checked_sub(self.rest.point_count()) {
                    None => self.visit(next),
                    Some(part) => self.drop_part(index32(part)),
                }
            }
            // What was in the way of a point may have gone without a change of its own faces.
            if self.records.len() == before {
                break;
            }
        }
        (self.records, self.costs.is_limited)
    }

    /// Faces with two corners at one point leave first.
    fn leave_degenerate(&mut self) {
        let before = self.rest.live_faces();
        if before == self.rest.face_count() as usize || before <= self.settings.faces {
            return;
        }
        for face in 0..self.rest.face_count() {
            if !self.rest.is_live(face) {
                self.records.push_leaving(face);
            }
        }
        self.records.finish(0.0);
    }

    /// Every point that may go waits for its turn, by a cost that is not too high.
    fn enqueue_all(&mut self) {
        for point in 0..index32(self.rest.point_count()) {
            if self.is_locked[point as usize]
                || self.queue.has(point)
                || !self.costs.look_around(&mut self.rest, point)
            {
                continue;
            }
            let costs = self.costs.moves.iter().map(|it| self.cost(point, it));
            if let Some(least) = costs.min_by(f64::total_cmp) {
                self.push(point, self.costs.key(least));
            }
        }
        if let Some(parts) = &self.parts {
            for part in 0..index32(parts.len()) {
                self.push_if_stuck(part);
            }
        }
    }

    fn push(&mut self, point: u32, key: f32) {
        self.queue.push(point, key);
        if let Some(parts) = &mut self.parts {
            parts.begin(point);
        }
    }

    /// The next point: it is removed, or waits again where that costs more than it seemed to.
    fn visit(&mut self, point: u32) {
        self.try_to_remove(point);
        if let Some(parts) = &mut self.parts {
            parts.end(point);
            let part = parts.of(point);
            self.push_if_stuck(part);
        }
    }

    fn try_to_remove(&mut self, point: u32) {
        if !self.costs.look_around(&mut self.rest, point) {
            return;
        }
        let mut is_gathered = false;

        // A removal for a hierarchy does not join borders.
        let closes_holes = self.settings.drop_parts && self.balance.is_none();

        // The cheapest move first, and only what it may cost at least is worth knowing more of.
        while let Some(at) = self.cheapest(point) {
            let found = self.costs.moves[at];
            let key = self.costs.key(self.cost(point, &found));
            if self.queue.is_later(key) {
                self.push(point, key);
                return;
            }
            match found.precision {
                Precision::Planes => {
                    if !self.costs.measure(&mut self.rest, point, at) {
                        self.costs.moves.swap_remove(at);
                    }
                    continue;
                }
                Precision::Point if self.costs.has_witnesses() => {
                    if !is_gathered {
                        is_gathered = true;
                        self.costs.gather_witnesses(&self.rest, point);
                    }
                    self.costs.ask_witnesses(&self.rest, at);
                    continue;
                }
                _ => {}
            }
            self.costs.moves.swap_remove(at);
            let is_allowed = self.costs.fan.keeps_sides(found.to, found.step)
                && link::keeps_topology(
                    &mut self.rest,
                    &mut self.marks,
                    &self.costs.fan,
                    point,
                    found.to,
                    closes_holes,
                )
                && self.costs.pair(&mut self.rest, found.to)
                && (self.balance.is_none() || self.can_return(found.to));
            if is_allowed {
                self.collapse(point, found);
                return;
            }
        }
    }

    /// Whether a removal can be undone alone.
    fn can_return(&mut self, to: u32) -> bool {
        balance::can_return(&mut self.rest, &self.costs.fan, to, &self.costs.pairs)
    }

    /// Removes the point whose fan and pairs were found last.
    fn collapse(&mut self, point: u32, found: Move) {
        let error = self.costs.remove(point, found);
        self.largest_error = self.largest_error.max(error);
        if let Some(balance) = &mut self.balance {
            balance.removed(point, found.to);
        }
        let fan = &self.costs.fan;

        // Faces that leave.
        let leaving = |face: &&FanFace| face.ring.contains(&found.to);
        for face in fan.faces.iter().filter(leaving) {
            self.rest.remove(face.face());
            self.records.push_leaving(face.face());
        }
        self.rest.forget(point);

        // Corners that change, vertex by vertex; then vertices that no corner changes for.
        self.costs.pairs.retain(|&pair| {
            let mut is_last = true;
            for (face, _) in fan.staying(found.to) {
                if self.rest.side(face.corner) == pair.from {
                    self.rest.set_corner(face.corner, found.to, pair.to);
                    self.records.push_corner(face.corner);
                    is_last = false;
                }
            }
            if !is_last {
                self.records.push_pair(pair);
            }
            is_last
        });
        for at in 0..self.costs.pairs.len() {
            let SidePair { from, to } = self.costs.pairs[at];
            let to = self.in_use(to, found.to);
            self.records.push_pair(SidePair { from, to });
        }
        self.unused_leave(found.to);
        self.records.finish(self.largest_error);

        // Neighbours that could not go may be able to now.
        for at in 0..self.costs.fan.faces.len() {
            for neighbour in self.costs.fan.faces[at].ring {
                if !self.is_locked[neighbour as usize] && !self.queue.has(neighbour) {
                    self.push(neighbour, 0.0);
                }
            }
        }
    }

    /// A vertex at a point, or the one that stands for it if no face has it any more.
    fn in_use(&mut self, side: u32, point: u32) -> u32 {
        if self.rest.is_side_used(side) {
            return side;
        }
        let sides = &mut self.costs.sides;
        sides.stand_in(&mut self.rest, side, point).unwrap_or(side)
    }

    /// At points that stay, vertices that only leaving faces had go to others there.
    fn unused_leave(&mut self, to: u32) {
        if self.rest.is_seamless() {
            return;
        }
        let mut seen = [NONE; 4];
        let mut count = 0;
        for at in 0..self.costs.fan.faces.len() {
            let face = self.costs.fan.faces[at];
            if !face.ring.contains(&to) {
                continue;
            }
            for (point, corner) in face.ring.into_iter().zip(face.others()) {
                let from = self.rest.side(corner);
                if self.rest.is_side_used(from) || seen.contains(&from) {
                    continue;
                }
                seen[count] = from;
                count += 1;
                let to = self.in_use(from, point);
                self.records.push_pair(SidePair { from, to });
            }
        }
    }

    /// A part none of whose points can go waits to leave as a whole.
    fn push_if_stuck(&mut self, part: u32) {
        let entry = index32(self.rest.point_count()) + part;
        let Some(parts) = self.parts.as_ref().filter(|parts| parts.is_stuck(part)) else {
            return;
        };
        let extent = parts.extent(&self.rest, part);
        if extent > f64::from(self.settings.error) {
            self.costs.is_limited = true;
        } else if extent > 0.0 && !self.queue.has(entry) {
            let cost = self.costs.of_distance(&self.rest, extent);
            self.queue.push(entry, self.costs.key(cost));
        }
    }

    /// The faces of a part leave, unless no others would be left.
    fn drop_part(&mut self, part: u32) {
        let Some(parts) = self.parts.as_ref().filter(|parts| parts.is_stuck(part)) else {
            return;
        };
        let points: Vec<u32> = parts.points(&self.rest, part).collect();
        let extent = parts.extent(&self.rest, part);
        let mut corners = Vec::new();
        for point in points {
            self.rest.visit(point, |face| {
                corners.push(face.corner);
                true
            });
        }
        let distinct = |mut numbers: Vec<u32>| {
            numbers.sort_unstable();
            numbers.dedup();
            numbers
        };
        let vertices = distinct(
            corners
                .iter()
                .map(|&corner| self.rest.side(corner))
                .collect(),
        );
        let faces = distinct(corners.iter().map(|corner| corner / 3).collect());
        if faces.is_empty() || faces.len() == self.rest.live_faces() {
            return;
        }

        for from in vertices {
            self.records.push_pair(SidePair { from, to: from });
        }
        for face in faces {
            self.rest.remove(face);
            self.records.push_leaving(face);
        }
        #[expect(clippy::cast_possible_truncation, reason = "an estimate")]
        let error = extent as f32;
        self.largest_error = self.largest_error.max(error);
        self.records.finish(self.largest_error);
    }
}
