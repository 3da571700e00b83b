//! Better orders for the meshes of a file, found before the file is touched.

use std::collections::BTreeMap;

use anyhow::Result;
use meshweft::files::{Document, MeshEntry};
use meshweft::order::{Target, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Faces, VertexOrder, cache};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::algorithm::Algorithm;
use super::arguments::Optimize;
use crate::count::ratio;

/// Most rounds; see [`improve`].
const MAX_ROUNDS: usize = 64;
/// Bytes of a vertex record that overfetch is compared for.
const VERTEX_SIZE: usize = 32;

/// What is to be done to each mesh and each vertex group.
pub(super) struct Improvement {
    faces: Vec<FaceChange>,
    /// By vertex group, for those that may move.
    vertices: BTreeMap<usize, VertexChange>,
}

struct VertexChange {
    /// The meshes of the group.
    members: Vec<usize>,
    order: VertexOrder,
}

struct FaceChange {
    order: FaceOrder,
    /// Why faces stay although they could move.
    reason: Option<&'static str>,
    /// Pushes of the schedule that came with the order.
    scheduled: Option<u64>,
}

/// Orders faces and vertices until that improves nothing any more.
///
/// A second round starts from another state and may find another order; it is taken if it misses
/// less. The last round finds nothing, and the program run on its own output starts with just that
/// round: it changes nothing. The faithful mode runs once, as the paper does, and so does a search
/// that was given its time.
pub(super) fn improve(
    entries: &[MeshEntry],
    algorithm: &Algorithm,
    arguments: &Optimize,
) -> Improvement {
    // Orders go by connectivity alone.
    let mut entries: Vec<MeshEntry> = entries.iter().map(MeshEntry::without_positions).collect();
    let unchanged = |entry: &MeshEntry| FaceChange {
        order: FaceOrder::identity(entry.record_count()),
        reason: None,
        scheduled: None,
    };
    let mut improvement = Improvement {
        faces: entries.iter().map(unchanged).collect(),
        vertices: vertex_groups(&entries),
    };

    let once = algorithm.runs_once() || arguments.allow_worse;
    let rounds = if once { 1 } else { MAX_ROUNDS };
    let face_count = entries.iter().map(|entry| entry.mesh.face_count()).sum();
    for _ in 0..rounds {
        let work = |(entry, change): (&mut MeshEntry, &mut FaceChange)| {
            change.improve(entry, algorithm, face_count, arguments.allow_worse)
        };
        let each = (&mut entries, &mut improvement.faces);
        let moved: Vec<bool> = match arguments.time_budget {
            None => each.into_par_iter().with_max_len(1).map(work).collect(),
            // One after the other: each has its share of the time.
            Some(_) => each.0.iter_mut().zip(each.1).map(work).collect(),
        };

        let mut changed = moved.iter().any(|&moved| moved);
        if !arguments.keep_vertex_order {
            changed |= improvement.improve_vertices(&mut entries, &moved);
        }
        if !changed {
            break;
        }
    }
    improvement
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
    /// Orders the faces of `entry`, one of the meshes with `face_count` faces together, if that
    /// misses less; whether it did.
    fn improve(
        &mut self,
        entry: &mut MeshEntry,
        algorithm: &Algorithm,
        face_count: usize,
        allow_worse: bool,
    ) -> bool {
        let turnable = entry.corners_turnable && entry.polygons.is_none();
        let target = algorithm.target();
        let mut scheduled = 0;
        let order = entry.record_order(|mesh, polygons| {
            let share = ratio(mesh.face_count() as f64, face_count);
            let (order, pushes) = algorithm.for_mesh(share, turnable).order(mesh, polygons);
            scheduled += pushes;
            order
        });
        if order.is_identity() {
            return false;
        }

        let before = target.misses(entry.mesh.faces());
        let mut ordered = entry.clone();
        ordered.apply_faces(&order);
        let after = target.misses(ordered.mesh.faces());
        if !algorithm.is_gain(before, after) && !allow_worse {
            if self.order.is_identity() {
                self.reason = Some("the order found does not miss less");
            }
            return false;
        }

        *entry = ordered;
        self.order = self.order.then(&order);
        self.reason = None;
        let is_controllable = matches!(target, Target::Cache(CacheModel::Controllable { .. }));
        self.scheduled = is_controllable.then_some(scheduled);
        true
    }
}

impl Improvement {
    /// Puts vertices in the order of their first use, in groups where faces moved or where that
    /// fetches less; whether any moved.
    fn improve_vertices(&mut self, entries: &mut [MeshEntry], moved: &[bool]) -> bool {
        let mut changed = false;
        for VertexChange {
            members,
            order: total,
        } in self.vertices.values_mut()
        {
            let faces = |entries: &[MeshEntry]| -> Vec<[u32; 3]> {
                let all = members.iter().flat_map(|&i| entries[i].mesh.faces());
                all.copied().collect()
            };
            let now = faces(entries);
            let order = vertex_fetch(Faces::new(&now, total.len()).expect("faces of meshes"));
            if order.is_identity() {
                continue;
            }
            let overfetch = |faces: &[[u32; 3]]| cache::overfetch(faces, VERTEX_SIZE);
            let faces_moved = members.iter().any(|&i| moved[i]);
            if !faces_moved && overfetch(&order.renumber(&now)) >= overfetch(&now) {
                continue;
            }

            for &i in members.iter() {
                entries[i].apply_vertices(&order);
            }
            *total = total.then(&order);
            changed = true;
        }
        changed
    }

    /// Does it to the file.
    pub(super) fn apply(&self, document: &mut Document) -> Result<()> {
        for (i, change) in self.faces.iter().enumerate() {
            if !change.order.is_identity() {
                document.apply(i, &change.order, None)?;
            }
        }
        for VertexChange { members, order } in self.vertices.values() {
            if !order.is_identity() {
                let still = FaceOrder::identity(document.meshes()[members[0]].record_count());
                document.apply(members[0], &still, Some(order))?;
            }
        }
        Ok(())
    }

    /// Whether anything is moved.
    pub(super) fn changes(&self) -> bool {
        let faces = self.faces.iter().any(|change| !change.order.is_identity());
        let mut vertices = self.vertices.values();
        faces || vertices.any(|change| !change.order.is_identity())
    }

    /// Whether faces of this mesh are moved or turned.
    pub(super) fn moved_faces(&self, mesh: usize) -> bool {
        !self.faces[mesh].order.is_identity()
    }

    /// Whether the vertices of this mesh are moved.
    pub(super) fn moved_vertices(&self, entry: &MeshEntry) -> bool {
        self.vertex_order(entry)
            .is_some_and(|order| !order.is_identity())
    }

    fn vertex_order(&self, entry: &MeshEntry) -> Option<&VertexOrder> {
        let group = self.vertices.get(&entry.vertex_group);
        group.map(|change| &change.order)
    }

    /// Why the faces of this mesh stay.
    pub(super) fn reason(&self, mesh: usize) -> Option<&'static str> {
        self.faces[mesh].reason
    }

    /// Pushes of the schedule of this mesh, for a controllable cache.
    pub(super) fn scheduled(&self, mesh: usize) -> Option<u64> {
        self.faces[mesh].scheduled
    }

    /// The same for all meshes, if each has a schedule.
    pub(super) fn scheduled_total(&self) -> Option<u64> {
        let total: Option<u64> = self.faces.iter().map(|change| change.scheduled).sum();
        total.filter(|_| !self.faces.is_empty())
    }

    /// What was done: `out[i] = in[new_to_old[i]]`, faces counted as the file's records.
    pub(super) fn permutation_json(&self, document: &Document) -> Value {
        let meshes = document.meshes().iter().zip(&self.faces);
        let meshes: Vec<Value> = meshes
            .map(|(entry, change)| {
                let order = &change.order;
                let rotations: Vec<u8> = (0..order.len()).map(|i| order.rotation(i)).collect();
                let vertices = self.vertex_order(entry).filter(|o| !o.is_identity());
                json!({
                    "name": entry.name,
                    "face_new_to_old": order.new_to_old(),
                    "corner_rotations": rotations,
                    "vertex_new_to_old": vertices.map(VertexOrder::new_to_old),
                })
            })
            .collect();
        json!({
            "schema": 1,
            "file": document.path().display().to_string(),
            "convention": "out[i] = in[new_to_old[i]]; new corner j = old corner (j + rotation) % 3",
            "meshes": meshes,
        })
    }
}
