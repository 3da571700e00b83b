//! Better orders for the meshes of a document, found before the document is changed.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::algorithm::Algorithm;
use super::better::better_vertex_order;
use super::counts::Counts;
use super::options::Options;
use super::shared_progress::SharedProgress;
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::files::{Document, Edit, FileError, MeshEntry};
use crate::order::Target;
use crate::parallel;
use crate::permutation::{FaceOrder, VertexOrder};
use crate::progress::Progress;

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
}

/// What is to be done to the faces of a mesh.
pub(super) struct FaceChange {
    pub(super) order: FaceOrder,
    /// Why an order that was found is not taken.
    pub(super) reason: Option<&'static str>,
    /// Pushes of the schedule that came with the order, for a controllable cache.
    pub(super) scheduled: Option<u64>,
}

/// Orders faces and vertices. `before` has the counts of each mesh under `models`.
pub(super) fn improve(
    entries: &[MeshEntry],
    options: &Options,
    models: &[CacheModel],
    before: &[Counts],
    progress: &dyn Progress,
) -> Improvement {
    let algorithm = Algorithm::new(options);
    let face_count = entries.iter().map(|entry| entry.mesh.face_count()).sum();
    let shared = SharedProgress::new(progress, face_count);

    // Faces: each mesh has its share of a budget, by where its faces stand among all.
    let mut first_face = 0;
    let jobs = entries.iter().zip(before).map(|(entry, before)| {
        let first = first_face;
        first_face += entry.mesh.face_count();
        (entry, before, first)
    });
    let job = |(entry, before, first)| {
        MeshJob {
            entry,
            before,
            first,
            face_count,
            algorithm: &algorithm,
            models,
        }
        .run(&shared)
    };
    let improved: Vec<(FaceChange, Improved<'_>)> = match shared.is_timed() {
        // One after the other: each has its share of the time.
        true => jobs.map(job).collect(),
        false => parallel::map(jobs.collect(), job),
    };
    let (faces, mut meshes): (Vec<_>, Vec<_>) = improved.into_iter().unzip();

    // Vertices.
    let mut vertices = BTreeMap::new();
    if !options.keep_vertex_order {
        for (group, members) in movable_groups(entries) {
            if let Some(order) = better_order_of_group(&members, &meshes, &faces) {
                let old_to_new = order.permutation().old_to_new();
                for &i in &members {
                    meshes[i].renumber(&old_to_new);
                }
                vertices.insert(group, VertexChange { members, order });
            }
        }
    }

    Improvement {
        faces,
        vertices,
        after: meshes.into_iter().map(Improved::into_counts).collect(),
        is_stopped: shared.finish(),
    }
}

/// The members of each vertex group whose vertices may move.
fn movable_groups(entries: &[MeshEntry]) -> BTreeMap<usize, Vec<usize>> {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, entry) in entries.iter().enumerate() {
        groups.entry(entry.vertex_group).or_default().push(i);
    }
    groups.retain(|_, members| members.iter().all(|&i| entries[i].vertices_movable));
    groups
}

/// The vertices of a group in the order of their first use by all its members, if that is worth it.
fn better_order_of_group(
    members: &[usize],
    meshes: &[Improved<'_>],
    changes: &[FaceChange],
) -> Option<VertexOrder> {
    let vertex_count = meshes[members[0]].counts.vertices;
    let all: Cow<'_, [[u32; 3]]> = match members {
        [only] => meshes[*only].faces.as_ref().into(),
        _ => {
            let all = members.iter().flat_map(|&i| meshes[i].faces.iter());
            all.copied().collect()
        }
    };
    let faces_moved = members.iter().any(|&i| !changes[i].order.is_identity());
    better_vertex_order(Faces::of_checked(&all, vertex_count), faces_moved)
}

/// The faces of one mesh, to be ordered.
struct MeshJob<'a> {
    entry: &'a MeshEntry,
    before: &'a Counts,
    /// How many faces the meshes before it have, and all together.
    first: usize,
    face_count: usize,
    algorithm: &'a Algorithm,
    models: &'a [CacheModel],
}

/// A mesh in its better order.
struct Improved<'a> {
    faces: Cow<'a, [[u32; 3]]>,
    /// Not yet with what is fetched.
    counts: Counts,
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

    /// The mesh as it was, and why.
    fn unchanged(self, reason: Option<&'static str>) -> (FaceChange, Improved<'a>) {
        let change = FaceChange {
            order: FaceOrder::identity(self.entry.record_count()),
            reason,
            scheduled: None,
        };
        let improved = Improved {
            faces: Cow::Borrowed(self.entry.mesh.faces()),
            counts: self.before.clone(),
        };
        (change, improved)
    }
}

impl Improved<'_> {
    /// Gives the vertices their new numbers.
    fn renumber(&mut self, old_to_new: &[u32]) {
        for face in self.faces.to_mut() {
            *face = face.map(|vertex| old_to_new[vertex as usize]);
        }
    }

    /// The counts, with what is fetched where anything moved.
    fn into_counts(mut self) -> Counts {
        if let Cow::Owned(faces) = &self.faces {
            let faces = Faces::of_checked(faces, self.counts.vertices);
            self.counts.count_fetched(faces);
        }
        self.counts
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
        for VertexChange { members, order } in self.vertices.values() {
            document.edit(Edit::order(members[0], None, order))?;
        }
        Ok(())
    }
}
