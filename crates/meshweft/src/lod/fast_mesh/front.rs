//! The front: the vertices that are active, and the faces that they make.

use super::changes::{FrontChanges, Touched};
use super::hierarchy::VertexHierarchy;
use super::loader::{BlockLoader, Complete};
use super::missing::BLOCK_POINTS;
use super::queues::BudgetQueues;
use super::tested::TestedPoints;
use crate::index::index32;
use crate::lod::view::{CameraView, DetailBound};
use crate::topology::half_edges::NONE;

/// A mesh as coarse as a view allows, which follows the view from frame to frame.
///
/// The faces are always those of an oriented manifold with the borders of the coarsest mesh, without cracks. They depend on the
/// active points alone, not on how they came to be active.
#[derive(Debug, Clone)]
pub struct Front {
    pub(super) hierarchy: VertexHierarchy,
    /// Of each point its place in one of the two lists, or [`NONE`].
    pub(super) places: Vec<u32>,
    /// Points that may leave and have not.
    pub(super) active: TestedPoints,
    /// Points that left, next below an active one.
    pub(super) waiting: TestedPoints,
    face_count: usize,
    vertex_count: usize,
    touched_points: Touched,
    touched_faces: Touched,
    changes: FrontChanges,
    /// Points that are to be split, each after those above it in the stack.
    pub(super) to_split: Vec<u32>,
    /// Points that no other needs any more.
    pub(super) to_collapse: Vec<u32>,
    /// Points that are new in one of the two lists, if these are noted.
    pub(super) moved: Vec<u32>,
    notes_moves: bool,
    /// Points that were counted, or that wait for others to be split.
    pub(super) looked_at: Touched,
    pub(super) queues: BudgetQueues,
}

/// Places of points that wait have this bit.
const WAITING: u32 = 1 << 31;
/// So many siblings are looked at for the one before a point. More are only in a hierarchy that someone made up.
const MOST_SIBLINGS: u32 = 4096;
/// In the numbers of points that need one, above the four bits of the flags.
const ONE_NEED: u32 = 1 << 4;

impl Front {
    /// The coarsest mesh: only roots are active.
    ///
    /// # Complexity
    /// Time O(vertices), space 4 bytes a vertex and 3 bits, 48 bytes for each that is active, and 48 for each just below.
    #[must_use]
    pub fn new(hierarchy: VertexHierarchy) -> Self {
        let points = hierarchy.nodes.len();
        let mut front = Self {
            places: vec![NONE; points],
            active: TestedPoints::new(0),
            waiting: TestedPoints::new(WAITING),
            face_count: hierarchy.root_faces as usize,
            vertex_count: 0,
            touched_points: Touched::new(points),
            touched_faces: Touched::new(hierarchy.face_slot_count()),
            changes: FrontChanges::default(),
            to_split: Vec::new(),
            to_collapse: Vec::new(),
            moved: Vec::new(),
            notes_moves: false,
            looked_at: Touched::new(points),
            queues: BudgetQueues::default(),
            hierarchy,
        };
        for root in 0..front.hierarchy.roots {
            let child = front.hierarchy.nodes[root as usize].first_child;
            front.wait(child, root);
        }
        front.vertex_count = front.vertices().count();
        front
    }

    /// The hierarchy.
    #[must_use]
    pub fn hierarchy(&self) -> &VertexHierarchy {
        &self.hierarchy
    }

    /// How many vertices are active, roots and all vertices at one point included.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many faces there are.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.face_count
    }

    /// The largest error of the vertices that are not active; 0 if all are. It is that of the whole surface, seen or not.
    ///
    /// # Complexity
    /// Time O(vertices).
    #[must_use]
    pub fn largest_error_left(&self) -> f32 {
        let points = self.hierarchy.leaving_points();
        let inactive = points.filter(|&point| !self.is_leaving_active(point));
        // Of a block that was not read all points are inactive.
        let errors = inactive.map(|point| {
            let missing = self.hierarchy.missing.largest_error(point);
            missing.unwrap_or(self.hierarchy.nodes[point as usize].error)
        });
        errors.fold(0.0, f32::max)
    }

    /// What the last update changed.
    #[must_use]
    pub fn changes(&self) -> &FrontChanges {
        &self.changes
    }

    /// Whether a point is active.
    #[inline]
    pub(super) fn is_active(&self, point: u32) -> bool {
        !self.hierarchy.may_leave(point) || self.is_leaving_active(point)
    }

    /// The three vertices of a face, counterclockwise as seen from outside; `None` if it is not there.
    #[must_use]
    pub fn face(&self, face: u32) -> Option<[u32; 3]> {
        if face as usize >= self.hierarchy.face_slot_count() {
            return None;
        }
        let point = self.hierarchy.point_of_face(face);
        let is_there = point.is_none_or(|point| self.is_active(point));
        let corners = self.hierarchy.edges.face(face);
        (is_there && !corners.contains(&NONE)).then_some(corners)
    }

    /// All faces that are there, with their numbers, in no particular order.
    pub fn faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> {
        let root_faces = 0..self.hierarchy.root_faces;
        let others = self.active.points().flat_map(|point| {
            let first = self.hierarchy.root_faces + 2 * (point - self.hierarchy.roots);
            [first, first + 1]
        });
        root_faces
            .chain(others)
            .filter_map(|face| Some((face, self.face(face)?)))
    }

    /// All vertices that are active, in no particular order.
    pub fn vertices(&self) -> impl Iterator<Item = u32> {
        let points = (0..self.hierarchy.roots).chain(self.active.points());
        points.flat_map(|point| self.hierarchy.vertices_of(point))
    }

    /// Makes the mesh what a view asks for: where the error can be seen it gets finer, where it cannot it gets coarser.
    ///
    /// With `hysteresis` 1 the result depends on the view alone: every point whose error can be seen is active, and those that it
    /// needs. Below 1, a point stays active until its error is that part of the tolerance, so that small moves of the camera back and
    /// forth change nothing.
    ///
    /// # Complexity
    /// Time O(vertices that are active + vertices that change), no allocation once the lists have grown.
    ///
    /// # Panics
    /// If `hysteresis` is not above 0 and at most 1.
    pub fn update(&mut self, view: &CameraView, hysteresis: f64) -> &FrontChanges {
        let Ok(()) = self.update_by(view, hysteresis, &mut Complete);
        &self.changes
    }

    /// The same where points may be missing. If one cannot be read, the mesh is somewhere between, and what changed is said.
    pub(super) fn update_by<L: BlockLoader>(
        &mut self,
        view: &CameraView,
        hysteresis: f64,
        loader: &mut L,
    ) -> Result<(), L::Error> {
        self.begin(hysteresis, false);
        let result = self.refine(view, loader);
        if result.is_ok() {
            self.coarsen(&view.with_tolerance(hysteresis));
        }
        self.settle();
        result
    }

    /// Makes every point active: the mesh of the input.
    pub fn refine_fully(&mut self) -> &FrontChanges {
        let Ok(()) = self.refine_fully_by(&mut Complete);
        &self.changes
    }

    /// The same where points may be missing.
    pub(super) fn refine_fully_by<L: BlockLoader>(
        &mut self,
        loader: &mut L,
    ) -> Result<(), L::Error> {
        self.begin(1.0, false);
        let mut points = self.hierarchy.leaving_points();
        let result = points.try_for_each(|point| self.split(point, loader));
        self.settle();
        result
    }

    /// Nothing changed yet. `notes_moves` says whether points that come into a list are noted.
    pub(super) fn begin(&mut self, hysteresis: f64, notes_moves: bool) {
        let is_part = hysteresis > 0.0 && hysteresis <= 1.0;
        assert!(is_part, "hysteresis is above 0 and at most 1");
        self.changes.clear();
        self.moved.clear();
        self.notes_moves = notes_moves;
        self.to_collapse.clear();
    }

    fn refine<L: BlockLoader>(
        &mut self,
        view: &CameraView,
        loader: &mut L,
    ) -> Result<(), L::Error> {
        self.waiting.rewind();
        while let Some(point) = self.waiting.next(|bound| view.needs(bound)) {
            // What was known of it before it was read may have asked for too much.
            let is_new = self.fetch(point, loader)?;
            if !is_new || view.needs(self.waiting_bound(point)) {
                self.split(point, loader)?;
            }
        }
        Ok(())
    }

    /// Reads the block of a point that may leave, if it is missing; whether it was.
    pub(super) fn fetch<L: BlockLoader>(
        &mut self,
        point: u32,
        loader: &mut L,
    ) -> Result<bool, L::Error> {
        let missing = &self.hierarchy.missing;
        if missing.largest_error(point).is_none() {
            return Ok(false);
        }
        let block = missing.block_of(point);
        loader.load(block, &mut self.hierarchy)?;

        // The tests know more of those that wait.
        let points = self.hierarchy.leaving_points();
        let first = points.start + index32(block) * BLOCK_POINTS;
        for point in first..first.saturating_add(BLOCK_POINTS).min(points.end) {
            if self.is_waiting(point) {
                let bound = self.hierarchy.bound(point);
                self.waiting.set_bound(self.places[point as usize], bound);
            }
        }
        Ok(true)
    }

    /// What the test needs of a point that waits.
    pub(super) fn waiting_bound(&self, point: u32) -> &DetailBound {
        self.waiting.bound(self.places[point as usize])
    }

    fn coarsen(&mut self, view: &CameraView) {
        self.active.rewind();
        while let Some(point) = self.active.next(|bound| !view.needs(bound)) {
            // What a collapse sets free is tried at once, as it may have been passed.
            self.to_collapse.push(point);
            while let Some(point) = self.to_collapse.pop() {
                if self.can_collapse(point)
                    && !view.needs(self.active.bound(self.places[point as usize]))
                {
                    self.collapse(point);
                }
            }
        }
    }

    /// Whether a point is active and no other needs it.
    pub(super) fn can_collapse(&self, point: u32) -> bool {
        self.is_leaving_active(point) && self.hierarchy.needs[point as usize] < ONE_NEED
    }

    /// Whether a point may leave and is active.
    pub(super) fn is_leaving_active(&self, point: u32) -> bool {
        self.places[point as usize] < WAITING
    }

    /// Makes a point active, and before it those that it needs.
    pub(super) fn split<L: BlockLoader>(
        &mut self,
        point: u32,
        loader: &mut L,
    ) -> Result<(), L::Error> {
        let mut result = Ok(());
        self.to_split.push(point);

        // Each waits on the stack for those that it needs.
        while let Some(&point) = self.to_split.last() {
            if self.is_active(point) {
                self.to_split.pop();
                continue;
            }
            result = self.fetch(point, loader).map(|_| ());
            if result.is_err() {
                self.to_split.clear();
                break;
            }
            let is_missing = |it: &u32| !self.is_active(*it);
            let missing = self.hierarchy.needed_by(point).find(is_missing);
            match missing {
                // In a hierarchy that someone made up, points may need each other: then one is split without the other.
                Some(other) if self.looked_at.touch(other, false) => self.to_split.push(other),
                _ => self.split_one(point),
            }
        }

        self.looked_at.drain(|_, _| {});
        result
    }

    /// Makes a point active; those that it needs are.
    fn split_one(&mut self, point: u32) {
        if self.places[point as usize] != NONE {
            self.waiting.take(point, &mut self.places);
        }
        let bound = self.hierarchy.bound(point);
        self.active.add(point, bound, &mut self.places);
        self.note_move(point);
        self.touched_points.touch(point, false);
        self.count_needs(point, true);

        let edge = self.hierarchy.edge(point);
        for face in edge.faces() {
            self.touched_faces.touch(face, false);
            self.face_count += 1;
        }
        let flags = self.hierarchy.needs[point as usize] % ONE_NEED;
        let touched = &mut self.touched_faces;
        edge.split(flags, &mut self.hierarchy.edges, |half_edge| {
            touched.touch(half_edge / 3, true);
        });
        self.vertex_count += self.hierarchy.vertices_of(point).count();

        let node = self.hierarchy.nodes[point as usize];
        self.wait(node.first_child, point);
        self.wait(node.next_sibling, point);
    }

    /// A point leaves that no other needs.
    pub(super) fn collapse(&mut self, point: u32) {
        self.vertex_count -= self.hierarchy.vertices_of(point).count();
        let edge = self.hierarchy.edge(point);
        for face in edge.faces() {
            self.touched_faces.touch(face, true);
            // Links that someone made up may bring a face that was not counted.
            self.face_count = self.face_count.saturating_sub(1);
        }
        let touched = &mut self.touched_faces;
        edge.collapse(&mut self.hierarchy.edges, |half_edge| {
            touched.touch(half_edge / 3, true);
        });

        self.active.take(point, &mut self.places);
        self.touched_points.touch(point, true);
        self.count_needs(point, false);
        let node = self.hierarchy.nodes[point as usize];
        for below in [node.first_child, node.next_sibling] {
            if below != NONE && self.is_waiting(below) {
                self.waiting.take(below, &mut self.places);
            }
        }
        if self.is_above_active(point) {
            self.wait(point, point);
        }
    }

    pub(super) fn is_waiting(&self, point: u32) -> bool {
        let place = self.places[point as usize];
        place != NONE && place >= WAITING
    }

    /// Whether the point just above one is active, or it is not known which that is: it was not read yet.
    fn is_above_active(&self, point: u32) -> bool {
        // Siblings are as many as the forest is deep at most.
        let nodes = &self.hierarchy.nodes;
        let parent = nodes[point as usize].parent;
        let mut above = parent;
        let mut at = nodes[parent as usize].first_child;
        for _ in 0..MOST_SIBLINGS {
            if at == point {
                return self.is_active(above);
            }
            if at == NONE {
                break;
            }
            above = at;
            at = nodes[at as usize].next_sibling;
        }
        true
    }

    /// A point just below another is to be tested, unless it is active or is tested already.
    fn wait(&mut self, point: u32, above: u32) {
        if point != NONE && self.places[point as usize] == NONE {
            let bound = match self.hierarchy.missing.largest_error(point) {
                None => self.hierarchy.bound(point),
                Some(error) => self.hierarchy.bound_below(above, error),
            };
            self.waiting.add(point, bound, &mut self.places);
            self.note_move(point);
        }
    }

    fn note_move(&mut self, point: u32) {
        if self.notes_moves {
            self.moved.push(point);
        }
    }

    /// One more point needs those that a point needs, or one less.
    fn count_needs(&mut self, point: u32, is_more: bool) {
        // At most five: the parent and those around two faces.
        let mut needed = [NONE; 5];
        for (place, other) in needed.iter_mut().zip(self.hierarchy.needed_by(point)) {
            *place = other;
        }
        for other in needed.into_iter().filter(|&it| it != NONE) {
            let needs = &mut self.hierarchy.needs[other as usize];
            if is_more {
                *needs = needs.saturating_add(ONE_NEED);
            } else {
                *needs = needs.saturating_sub(ONE_NEED);
                if *needs < ONE_NEED {
                    self.to_collapse.push(other);
                }
            }
        }
    }

    /// Says what changed in all.
    pub(super) fn settle(&mut self) -> &FrontChanges {
        let mut touched = std::mem::take(&mut self.touched_points);
        let mut changes = std::mem::take(&mut self.changes);
        touched.drain(|point, was_active| {
            let list = match (was_active, self.is_active(point)) {
                (false, true) => &mut changes.added_vertices,
                (true, false) => &mut changes.removed_vertices,
                _ => return,
            };
            list.extend(self.hierarchy.vertices_of(point));
        });
        self.touched_points = touched;

        let mut touched = std::mem::take(&mut self.touched_faces);
        touched.drain(|face, was_there| {
            let list = match (was_there, self.face(face).is_some()) {
                (false, true) => &mut changes.added_faces,
                (true, false) => &mut changes.removed_faces,
                (true, true) => &mut changes.changed_faces,
                (false, false) => return,
            };
            list.push(face);
        });
        self.touched_faces = touched;
        self.changes = changes;
        &self.changes
    }
}
