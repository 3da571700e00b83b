//! Vertices that move together, because meshes share them.
//!
//! A group of more than 65,536 vertices is put in blocks of that many before faces are ordered, by the faces
//! of all its members: these then are ordered block by block. Afterwards it is judged as a whole against
//! the file, in whose numbers the caches that look at them may miss more or less.
//!
//! Where members are levels of detail of others, vertices stand in bands instead, whatever their number, so that what a level uses
//! is a prefix.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::algorithm::Algorithm;
use super::better::{better_vertex_order, fetches_less, is_gain, vertex_order};
use super::counts::Counts;
use super::improved::{FaceChange, Improved};
use crate::cache::CacheModel;
use crate::faces::Faces;
use crate::files::MeshEntry;
use crate::index::BLOCK;
use crate::order::{first_use_in_blocks, vertex_bands};
use crate::parallel;
use crate::permutation::VertexOrder;

/// The members of each vertex group whose vertices may move.
pub(super) fn movable_groups(entries: &[MeshEntry]) -> BTreeMap<usize, Vec<usize>> {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, entry) in entries.iter().enumerate() {
        groups.entry(entry.vertex_group).or_default().push(i);
    }
    groups.retain(|_, members| members.iter().all(|&i| entries[i].vertices_movable));
    groups
}

/// Whether a group has more vertices than a block, and members of several levels of detail.
pub(super) fn has_large_bands(members: &[usize], entries: &[MeshEntry]) -> bool {
    let number = |&i: &usize| entries[i].level.map_or(0, |level| level.number);
    let first = number(&members[0]);
    entries[members[0]].mesh.vertex_count() > BLOCK && members.iter().any(|i| number(i) != first)
}

/// The vertices of a group in the order of their first use by all its members, those of levels of detail in bands, if that is worth it;
/// the members then have the new numbers.
pub(super) fn better_order_of_group(
    members: &[usize],
    entries: &[MeshEntry],
    meshes: &mut [Improved<'_>],
    changes: &[FaceChange],
) -> Option<VertexOrder> {
    let vertex_count = meshes[members[0]].counts.vertices;
    let faces_moved = members.iter().any(|&i| !changes[i].order.is_identity());
    let levels = LevelFaces::new(members, entries, |i| &meshes[i].faces);
    let order = better_vertex_order(&levels.faces(vertex_count), faces_moved)?;
    drop(levels);
    renumber(members, meshes, &order);
    Some(order)
}

/// The faces of some meshes by level of detail, from fine to coarse: those of one level one after the other.
struct LevelFaces<'a> {
    levels: Vec<Cow<'a, [[u32; 3]]>>,
}

impl<'a> LevelFaces<'a> {
    fn new(
        members: &[usize],
        entries: &[MeshEntry],
        faces_of: impl Fn(usize) -> &'a [[u32; 3]],
    ) -> Self {
        let mut by_level: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &i in members {
            let number = entries[i].level.map_or(0, |level| level.number);
            by_level.entry(number).or_default().push(i);
        }
        let all = by_level.values().map(|members| match members[..] {
            [only] => faces_of(only).into(),
            _ => {
                let all = members.iter().flat_map(|&i| faces_of(i));
                all.copied().collect()
            }
        });
        Self {
            levels: all.collect(),
        }
    }

    fn faces(&self, vertex_count: usize) -> Vec<Faces<'_>> {
        let levels = self.levels.iter();
        levels
            .map(|faces| Faces::of_checked(faces, vertex_count))
            .collect()
    }
}

fn renumber(members: &[usize], meshes: &mut [Improved<'_>], order: &VertexOrder) {
    let old_to_new = order.permutation().old_to_new();
    for &i in members {
        meshes[i].renumber(&old_to_new);
    }
}

/// Large groups with their vertices in blocks, or in bands.
pub(super) struct LargeGroups {
    orders: BTreeMap<usize, VertexOrder>,
    /// The members of those groups whose vertices have new numbers.
    entries: BTreeMap<usize, MeshEntry>,
}

impl LargeGroups {
    /// Time as [`vertex_fetch`](crate::order::vertex_fetch()), and a copy of the meshes of groups that are renumbered.
    pub(super) fn new(entries: &[MeshEntry], groups: &BTreeMap<usize, Vec<usize>>) -> Self {
        let vertex_count = |members: &[usize]| entries[members[0]].mesh.vertex_count();
        let large = groups
            .iter()
            .filter(|(_, members)| vertex_count(members) > BLOCK);
        let orders = parallel::map(large.collect(), |(&group, members)| {
            let levels = LevelFaces::new(members, entries, |i| entries[i].mesh.faces());
            (group, vertex_order(&levels.faces(vertex_count(members))))
        });
        let orders: BTreeMap<usize, VertexOrder> = orders.into_iter().collect();

        let moved = orders.iter().filter(|(_, order)| !order.is_identity());
        let renumbered = moved.flat_map(|(group, order)| {
            let (members, old_to_new) = (groups[group].iter(), order.permutation().old_to_new());
            members.map(move |&i| {
                let mut entry = entries[i].clone();
                entry.renumber_vertices(&old_to_new);
                (i, entry)
            })
        });
        Self {
            entries: renumbered.collect(),
            orders,
        }
    }

    /// The numbering of a large group.
    pub(super) fn order(&self, group: usize) -> Option<&VertexOrder> {
        self.orders.get(&group)
    }

    /// A mesh with its new numbers, if it has some.
    pub(super) fn entry(&self, mesh: usize) -> Option<&MeshEntry> {
        self.entries.get(&mesh)
    }
}

/// A large group, its faces ordered, to be judged.
pub(super) struct Judgement<'m, 'a> {
    pub(super) members: &'m [usize],
    /// All meshes as the file has them, and their counts.
    pub(super) entries: &'a [MeshEntry],
    pub(super) before: &'a [Counts],
    pub(super) algorithm: &'a Algorithm,
    /// What was counted.
    pub(super) models: &'a [CacheModel],
}

impl<'a> Judgement<'_, 'a> {
    /// What becomes of the vertices, which were `numbered` in blocks or bands: they move by first use inside these, if
    /// that and the orders of the faces are worth it; otherwise nothing in the group moves.
    pub(super) fn settle(
        &self,
        numbered: &VertexOrder,
        meshes: &mut [Improved<'a>],
        changes: &mut [FaceChange],
    ) -> Option<VertexOrder> {
        // By first use. A vertex may leave its block only where there are bands, so that what looks at blocks is counted again.
        let vertex_count = numbered.len();
        let levels = LevelFaces::new(self.members, self.entries, |i| &meshes[i].faces);
        let has_bands = levels.levels.len() > 1;
        let inside = match levels.faces(vertex_count)[..] {
            [only] => first_use_in_blocks(only),
            ref levels => vertex_bands(levels),
        };
        drop(levels);
        let order = numbered.then(&inside);
        renumber(self.members, meshes, &inside);
        if has_bands && !inside.is_identity() {
            for &i in self.members {
                let Improved { faces, counts } = &mut meshes[i];
                *counts = counts.reordered(Faces::of_checked(faces, vertex_count), self.models);
            }
        }

        // Judged as a whole.
        if !self.is_worth(&order, meshes, changes) {
            for &i in self.members {
                let reason = changes[i].reason.or_else(|| {
                    let is_found = !changes[i].order.is_identity();
                    is_found.then_some("the order found does not miss less")
                });
                changes[i] = FaceChange::none(&self.entries[i], reason);
                meshes[i] = Improved {
                    faces: Cow::Borrowed(self.entries[i].mesh.faces()),
                    counts: self.before[i].clone(),
                };
            }
            return None;
        }
        Some(order).filter(|order| !order.is_identity())
    }

    /// Whether all members together cost less in their new numbers, or are fetched better.
    ///
    /// Orders of faces were judged mesh by mesh: where one is taken, the sum decides whether the numbers
    /// cost other members more.
    fn is_worth(
        &self,
        order: &VertexOrder,
        meshes: &[Improved<'_>],
        changes: &[FaceChange],
    ) -> bool {
        let target = self.algorithm.target();
        let members = self.members.iter();
        let before: u64 = members
            .clone()
            .map(|&i| self.before[i].cost_for(target))
            .sum();
        let after: u64 = members
            .clone()
            .map(|&i| meshes[i].counts.cost_for(target))
            .sum();
        if members.clone().any(|&i| !changes[i].order.is_identity()) {
            return after < before || self.algorithm.allows_worse();
        }

        let fetches_less = || {
            let faces_of = |i: usize| self.entries[i].mesh.faces();
            let levels = LevelFaces::new(self.members, self.entries, faces_of);
            fetches_less(order, &levels.faces(order.len()))
        };
        !order.is_identity() && (is_gain(before, after) || after <= before && fetches_less())
    }
}
