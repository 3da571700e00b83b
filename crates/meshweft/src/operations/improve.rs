//! Better orders for the meshes of a document, found before the document is changed.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use super::algorithm::Algorithm;
use super::counts::Counts;
use super::improved::{FaceChange, Improved};
use super::options::Options;
use super::shared_progress::SharedProgress;
use super::vertex_groups::{
    Judgement, LargeGroups, better_order_of_group, has_large_bands, movable_groups,
};
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::files::{Document, Edit, FileError, MeshEntry};
use crate::order::{Mode, Target};
use crate::parallel;
use crate::permutation::VertexOrder;
use crate::progress::{Budget, PartOfWork, Progress};

/// How often large bands are ordered again at most. Each time misses less than the one before, and once is mostly enough.
const MOST_ROUNDS: usize = 16;

/// What is to be done to each mesh and each vertex group.
pub(super) struct Improvement {
    pub(super) faces: Vec<FaceChange>,
    /// By vertex group, for those that move.
    pub(super) vertices: BTreeMap<usize, VertexChange>,
    /// The counts of each mesh afterwards.
    pub(super) after: Vec<Counts>,
    /// Whether the caller stopped it.
    pub(super) is_stopped: bool,
}

/// What is to be done to the vertices of a group.
pub(super) struct VertexChange {
    /// The meshes of the group.
    members: Vec<usize>,
    pub(super) order: VertexOrder,
    /// Whether it was found last, so that what follows from it is not known.
    is_unsettled: bool,
}

/// Orders faces and vertices. `before` has the counts of each mesh under `models`.
pub(super) fn improve(
    entries: &[MeshEntry],
    options: &Options,
    models: &[CacheModel],
    before: &[Counts],
    progress: &dyn Progress,
) -> Improvement {
    improve_some(entries, |_| true, options, models, before, progress)
}

/// The same for the vertex groups that are chosen. All others stay as they are.
fn improve_some(
    entries: &[MeshEntry],
    is_chosen: impl Fn(usize) -> bool + Sync,
    options: &Options,
    models: &[CacheModel],
    before: &[Counts],
    progress: &dyn Progress,
) -> Improvement {
    let algorithm = Algorithm::new(options);
    let face_count = entries.iter().map(|entry| entry.mesh.face_count()).sum();
    let shared = SharedProgress::new(progress, face_count);

    // Large groups of vertices are put in blocks or bands first: faces are then ordered in these numbers.
    let mut groups = match options.keep_vertex_order {
        true => BTreeMap::new(),
        false => movable_groups(entries),
    };
    groups.retain(|&group, _| is_chosen(group));
    let large_groups = LargeGroups::new(entries, &groups);

    // Faces: each mesh has its share of a budget, by where its faces stand among all.
    let mut first_face = 0;
    let jobs = entries.iter().zip(before).enumerate();
    let jobs = jobs.map(|(i, (entry, before))| {
        let first = first_face;
        first_face += entry.mesh.face_count();
        (i, entry, before, first)
    });
    let job = |(i, entry, before, first)| {
        let renumbered = large_groups.entry(i);
        let job = MeshJob {
            entry: renumbered.unwrap_or(entry),
            is_renumbered: renumbered.is_some(),
            before,
            first,
            face_count,
            algorithm: &algorithm,
            models,
        };
        match is_chosen(job.entry.vertex_group) {
            true => job.run(&shared),
            false => job.unchanged(None),
        }
    };
    let improved: Vec<(FaceChange, Improved<'_>)> = match shared.is_timed() {
        // One after the other: each has its share of the time.
        true => jobs.map(job).collect(),
        false => parallel::map(jobs.collect(), job),
    };
    let (mut faces, mut meshes): (Vec<_>, Vec<_>) = improved.into_iter().unzip();

    // Vertices.
    let mut vertices = BTreeMap::new();
    for (group, members) in groups {
        let settled = match large_groups.order(group) {
            None => better_order_of_group(&members, entries, &mut meshes, &faces),
            Some(numbered) => Judgement {
                members: &members,
                entries,
                before,
                algorithm: &algorithm,
                models,
            }
            .settle(numbered, &mut meshes, &mut faces),
        };
        if let Some(order) = settled {
            let change = VertexChange {
                members,
                order,
                is_unsettled: true,
            };
            vertices.insert(group, change);
        }
    }

    Improvement {
        faces,
        vertices,
        after: meshes.into_iter().map(Improved::into_counts).collect(),
        is_stopped: shared.finish(),
    }
}

/// The faces of one mesh, to be ordered.
struct MeshJob<'a> {
    entry: &'a MeshEntry,
    /// Whether its vertices have other numbers than in the file, which is what was counted before.
    is_renumbered: bool,
    before: &'a Counts,
    /// How many faces the meshes before it have, and all together.
    first: usize,
    face_count: usize,
    algorithm: &'a Algorithm,
    models: &'a [CacheModel],
}

impl<'a> MeshJob<'a> {
    /// Orders the faces, if that misses less.
    fn run(self, progress: &SharedProgress<'_>) -> (FaceChange, Improved<'a>) {
        let entry = self.entry;
        let is_whole = entry.polygons.is_none() && entry.runs.len() <= 1;

        // Find an order, run by run.
        let target = self.algorithm.target();
        let misses = self.before.cost_for(target);
        let of_whole = is_whole.then_some(misses);
        let turnable = entry.corners_turnable && entry.polygons.is_none();
        let (mut next, mut scheduled, mut reason) = (self.first, 0, None);
        let order = entry.record_order(|mesh, polygons| {
            let range = next..next + mesh.face_count();
            next = range.end;
            let algorithm = self.algorithm.for_share(range, self.face_count, turnable);
            let run = algorithm.run_order(mesh.as_faces(), polygons, of_whole, progress);
            scheduled += run.scheduled;
            reason = reason.or(run.reason);
            run.order
        });
        if order.is_identity() {
            return self.unchanged(reason);
        }

        // Take it if it is better for the whole mesh.
        let faces = entry.ordered_faces(&order);
        let counts = self.before.reordered(
            Faces::of_checked(&faces, entry.mesh.vertex_count()),
            self.models,
        );
        let after = counts.cost_for(target);
        let refusal = self.algorithm.refusal(misses, after);
        if refusal.is_some() {
            return self.unchanged(refusal);
        }

        // A schedule that comes with an order is one of a whole mesh; of runs and polygons it is the
        // best for the order that was made of them.
        let is_controllable = matches!(target, Target::Cache(CacheModel::Controllable { .. }));
        let change = FaceChange {
            order,
            reason: None,
            scheduled: is_controllable.then_some(if is_whole { scheduled } else { after }),
        };
        let faces = Cow::Owned(faces);
        (change, Improved { faces, counts })
    }

    /// The faces as they were, and why.
    fn unchanged(self, reason: Option<&'static str>) -> (FaceChange, Improved<'a>) {
        let faces = self.entry.mesh.faces();
        let counts = match self.is_renumbered {
            true => self
                .before
                .reordered(self.entry.mesh.as_faces(), self.models),
            false => self.before.clone(),
        };
        let improved = Improved {
            faces: Cow::Borrowed(faces),
            counts,
        };
        (FaceChange::none(self.entry, reason), improved)
    }
}

impl Improvement {
    /// Does it to the document.
    pub(super) fn apply(&self, document: &mut Document) -> Result<(), FileError> {
        for (i, change) in self.faces.iter().enumerate() {
            if !change.order.is_identity() {
                document.edit(Edit::order(i, &change.order, None))?;
            }
        }
        for VertexChange { members, order, .. } in self.vertices.values() {
            document.edit(Edit::order(members[0], None, order))?;
        }
        Ok(())
    }

    /// Orders again what a run on the result might order again, until that finds nothing; `document` has been changed as this says, and is
    /// changed further.
    ///
    /// In bands of more than 65,536 vertices faces were ordered in other numbers than these have now, which caches that look at them may
    /// tell apart. What is not checked elsewhere is not checked here.
    pub(super) fn settle(
        mut self,
        document: &mut Document,
        options: &Options,
        models: &[CacheModel],
        progress: &dyn Progress,
    ) -> Result<Self, FileError> {
        let is_limited = progress.time_spent().is_some() || options.budget != Budget::Unlimited;
        let is_faithful = options
            .greedy
            .is_some_and(|greedy| greedy.mode == Mode::Faithful);
        if is_limited || is_faithful || options.allow_worse {
            return Ok(self);
        }
        for _ in 0..MOST_ROUNDS {
            let entries = document.meshes();
            let moved = self.vertices.iter();
            let moved = moved.filter(|(_, change)| {
                change.is_unsettled && has_large_bands(&change.members, entries)
            });
            let groups: BTreeSet<usize> = moved.map(|(&group, _)| group).collect();
            if groups.is_empty() || self.is_stopped {
                break;
            }
            let is_chosen = |group: usize| groups.contains(&group);
            let rest = PartOfWork::new(progress, 1.0, 1.0);
            let next = improve_some(entries, is_chosen, options, models, &self.after, &rest);
            next.apply(document)?;
            self = self.then(next);
        }
        Ok(self)
    }

    /// One that has the effect of this one, followed by `next`.
    fn then(mut self, next: Self) -> Self {
        for (change, next) in self.faces.iter_mut().zip(next.faces) {
            if !next.order.is_identity() {
                *change = FaceChange {
                    order: change.order.then(&next.order),
                    ..next
                };
            }
        }
        for change in self.vertices.values_mut() {
            change.is_unsettled = false;
        }
        for (group, next) in next.vertices {
            let order = match self.vertices.get(&group) {
                Some(change) => change.order.then(&next.order),
                None => next.order.clone(),
            };
            self.vertices.insert(group, VertexChange { order, ..next });
        }
        self.after = next.after;
        self.is_stopped |= next.is_stopped;
        self
    }
}
