//! Better orders for the meshes of a document, found before the document is changed.

use std::collections::BTreeMap;

use super::algorithm::Algorithm;
use super::options::Options;
use super::rounds::{Round, better_vertex_order, improve_until_settled};
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
    /// By vertex group, for those that may move.
    pub(super) vertices: BTreeMap<usize, VertexChange>,
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
    /// Why an order was rejected, if none was accepted before.
    pub(super) reason: Option<&'static str>,
    /// Pushes of the schedule that came with the order, for a controllable cache.
    pub(super) scheduled: Option<u64>,
}

/// Orders faces and vertices until a round brings no improvement.
pub(super) fn improve(
    entries: &[MeshEntry],
    options: &Options,
    progress: &dyn Progress,
) -> Improvement {
    let algorithm = Algorithm::new(options);
    let mut entries = entries.to_vec();
    let mut faces: Vec<FaceChange> = entries.iter().map(FaceChange::none).collect();
    let mut vertices = vertex_groups(&entries);

    let is_timed = progress.time_spent().is_some();
    let runs_once = algorithm.runs_once(progress);
    let face_count = entries.iter().map(|entry| entry.mesh.face_count()).sum();
    let mut first_faces = Vec::with_capacity(entries.len());
    let mut first_face = 0;
    for entry in &entries {
        first_faces.push(first_face);
        first_face += entry.mesh.face_count();
    }
    let is_stopped = improve_until_settled(progress, face_count, runs_once, |round| {
        let work = |((entry, change), &first): ((&mut MeshEntry, &mut FaceChange), &usize)| {
            change.improve(entry, &algorithm, first, face_count, round)
        };
        let each = entries.iter_mut().zip(&mut faces).zip(&first_faces);
        let moved: Vec<bool> = match is_timed {
            // One after the other: each has its share of the time.
            true => each.map(work).collect(),
            false => parallel::map(each.collect(), work),
        };
        let mut is_changed = moved.contains(&true);
        if !options.keep_vertex_order {
            for change in vertices.values_mut() {
                is_changed |= change.improve(&mut entries, &moved);
            }
        }
        is_changed
    });
    Improvement {
        faces,
        vertices,
        is_stopped,
    }
}

/// The groups whose vertices may move, each with an order that moves nothing.
fn vertex_groups(entries: &[MeshEntry]) -> BTreeMap<usize, VertexChange> {
    let mut groups: BTreeMap<usize, VertexChange> = BTreeMap::new();
    for (i, entry) in entries.iter().enumerate() {
        let group = groups.entry(entry.vertex_group);
        let group = group.or_insert_with(|| VertexChange {
            members: Vec::new(),
            order: VertexOrder::identity(entry.mesh.vertex_count()),
        });
        group.members.push(i);
    }
    let movable = |group: &VertexChange| group.members.iter().all(|&i| entries[i].vertices_movable);
    groups.retain(|_, group| movable(group));
    groups
}

impl FaceChange {
    fn none(entry: &MeshEntry) -> Self {
        Self {
            order: FaceOrder::identity(entry.record_count()),
            reason: None,
            scheduled: None,
        }
    }

    /// Orders the faces of `entry`, which are those from `first` on of the `face_count` faces of all
    /// meshes, if that misses less; whether it did.
    fn improve(
        &mut self,
        entry: &mut MeshEntry,
        algorithm: &Algorithm,
        first: usize,
        face_count: usize,
        round: &Round<'_>,
    ) -> bool {
        // Find an order, run by run.
        let turnable = entry.corners_turnable && entry.polygons.is_none();
        let (mut next, mut scheduled) = (first, 0);
        let order = entry.record_order(|mesh, polygons| {
            let part = round.part(mesh.face_count());
            let range = next..next + mesh.face_count();
            next = range.end;
            let algorithm = algorithm.for_share(range, face_count, turnable);
            let (order, pushes) = algorithm.order(mesh.as_faces(), polygons, &part);
            part.finish();
            scheduled += pushes;
            order
        });
        if order.is_identity() {
            return false;
        }

        // Take it if it is better.
        let target = algorithm.target();
        let before = target.misses(&entry.mesh);
        let mut ordered = entry.clone();
        ordered.apply_faces(&order);
        let after = target.misses(&ordered.mesh);
        if let Some(reason) = algorithm.refusal(before, after) {
            self.reason = self.order.is_identity().then_some(reason);
            return false;
        }
        *entry = ordered;
        self.order = self.order.then(&order);
        self.reason = None;

        // A schedule that comes with an order is one of a whole mesh; of runs and polygons it is the
        // best for the order that was made of them.
        let is_whole = entry.polygons.is_none() && entry.runs.len() <= 1;
        let is_controllable = matches!(target, Target::Cache(CacheModel::Controllable { .. }));
        self.scheduled = is_controllable.then_some(if is_whole { scheduled } else { after });
        true
    }
}

impl VertexChange {
    /// Puts the vertices in the order of their first use, if faces moved or if that fetches less;
    /// whether any moved.
    fn improve(&mut self, entries: &mut [MeshEntry], moved: &[bool]) -> bool {
        let all = self.members.iter().flat_map(|&i| entries[i].mesh.faces());
        let faces: Vec<[u32; 3]> = all.copied().collect();
        let faces = Faces::of_checked(&faces, self.order.len());
        let faces_moved = self.members.iter().any(|&i| moved[i]);
        let Some(order) = better_vertex_order(faces, faces_moved) else {
            return false;
        };
        for &i in &self.members {
            entries[i].apply_vertices(&order);
        }
        self.order = self.order.then(&order);
        true
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
            if !order.is_identity() {
                document.edit(Edit::order(members[0], None, order))?;
            }
        }
        Ok(())
    }
}
