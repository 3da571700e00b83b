//! Which faces and vertices of a document stay: what a caller asks for, checked, and as a plan.
//!
//! A selection is done in two steps. First everything that is not selected leaves, and what stays
//! keeps its order: the formats do this, by a [`SelectPlan`], whose records and vertices rise. Then
//! the rest is put in the order that was asked for, as by [`Edit::Order`](super::Edit::Order).

use std::collections::BTreeMap;

use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use crate::error::MeshError;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// A face that stays, for [`Edit::Select`](super::Edit::Select).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SelectedFace {
    /// Its number in [`MeshEntry::mesh`].
    pub face: u32,
    /// Its vertices from now on, by their numbers before the edit.
    pub corners: [u32; 3],
}

/// The faces of a mesh that stay, for [`Edit::Select`](super::Edit::Select).
#[derive(Debug, Clone, Copy)]
pub struct SelectedFaces<'a> {
    /// The number of the mesh.
    pub mesh: usize,
    /// Its faces, in the order in which they are drawn from now on: one or more, each at most once.
    pub faces: &'a [SelectedFace],
    /// For each of these faces, which corners of the source have what its corners are to store: three times
    /// a face of the mesh plus 0, 1 or 2, each at the vertex that the corner has from now on. Empty if that
    /// follows from the sides of seams, as [`Edit::Select`](super::Edit::Select) says. Only formats that
    /// store something with corners look at it.
    pub corner_sources: &'a [[u32; 3]],
}

impl<'a> SelectedFaces<'a> {
    /// Faces of a mesh, whose corners take what the sides of seams say.
    #[must_use]
    pub fn new(mesh: usize, faces: &'a [SelectedFace]) -> Self {
        let corner_sources = &[];
        Self {
            mesh,
            faces,
            corner_sources,
        }
    }
}

/// The vertices of a vertex group that stay, for [`Edit::Select`](super::Edit::Select).
#[derive(Debug, Clone, Copy)]
pub struct SelectedVertices<'a> {
    /// [`MeshEntry::vertex_group`] of the meshes that share them.
    pub vertex_group: usize,
    /// The old number of each vertex that stays, in the new order (`out[i] = in[vertices[i]]`), each at
    /// most once.
    pub vertices: &'a [u32],
}

/// What stays of a document, in the order in which it stands, and the orders to follow.
#[derive(Debug)]
pub(super) struct SelectPlan {
    /// The meshes of which faces were selected, rising.
    pub(super) meshes: Vec<PlannedMesh>,
    /// The vertex groups of which vertices were selected, rising.
    pub(super) groups: Vec<PlannedVertices>,
}

/// What stays of the faces of a mesh.
#[derive(Debug)]
pub(super) struct PlannedMesh {
    pub(super) mesh: usize,
    /// Rising by the records that they are made of.
    pub(super) records: Vec<PlannedRecord>,
    /// An order of these records, to follow.
    pub(super) order: FaceOrder,
}

/// A face record that stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlannedRecord {
    /// As it is.
    Whole(u32),
    /// Only this triangle of it.
    Triangle(PlannedTriangle),
}

/// A triangle of a record, which becomes a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PlannedTriangle {
    pub(super) record: u32,
    /// Which triangle of the record's fan, from 0.
    pub(super) fan: u32,
    /// Its vertices, by their old numbers.
    pub(super) corners: [u32; 3],
    /// The corners that have what its corners are to store, if that was said.
    pub(super) sources: Option<[RecordCorner; 3]>,
}

/// A corner of a face record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RecordCorner {
    pub(super) record: usize,
    /// Its place among the corners of the record.
    pub(super) place: usize,
}

impl PlannedRecord {
    /// The record that it is made of.
    pub(super) fn record(&self) -> u32 {
        match self {
            Self::Whole(record) => *record,
            Self::Triangle(triangle) => triangle.record,
        }
    }
}

impl PlannedTriangle {
    /// The places of its corners in the record.
    pub(super) fn places(&self) -> [usize; 3] {
        let fan = self.fan as usize;
        [0, fan + 1, fan + 2]
    }
}

/// What stays of the vertices of a vertex group.
#[derive(Debug)]
pub(super) struct PlannedVertices {
    pub(super) group: usize,
    /// The old numbers of those that stay, rising (or in the order of [`in_order`](Self::in_order)).
    pub(super) kept: Vec<u32>,
    /// The new number of each old vertex, [`LEFT_OUT`] for those that leave.
    pub(super) old_to_new: Vec<u32>,
    /// An order of those that stay, to follow.
    pub(super) order: VertexOrder,
}

/// The new number of a vertex that is left out: larger than any number that a vertex can have.
pub(super) const LEFT_OUT: u32 = u32::MAX;

impl PlannedVertices {
    /// Those that stay, in the order that was asked for; with nothing to follow.
    pub(super) fn in_order(mut self) -> Self {
        self.kept = self.order.permutation().apply(&self.kept);
        for (new, &old) in (0..).zip(&self.kept) {
            self.old_to_new[old as usize] = new;
        }
        self.order = VertexOrder::identity(self.kept.len());
        self
    }

    /// Whether all vertices stay where they are.
    pub(super) fn is_identity(&self) -> bool {
        self.are_all() && self.kept.is_sorted()
    }

    /// Whether all vertices stay.
    pub(super) fn are_all(&self) -> bool {
        self.kept.len() == self.old_to_new.len()
    }
}

impl SelectPlan {
    /// # Errors
    /// A face or vertex is not there, is selected twice, or is used and left out; nothing is left.
    ///
    /// # Panics
    /// If there is no such mesh or vertex group.
    pub(super) fn new(
        entries: &[MeshEntry],
        faces: &[SelectedFaces<'_>],
        vertices: &[SelectedVertices<'_>],
    ) -> Result<Self, FileErrorKind> {
        // The vertices.
        let first_of = entries.iter().map(|entry| (entry.vertex_group, entry));
        let first_of: BTreeMap<usize, &MeshEntry> = first_of.rev().collect();
        let mut groups = BTreeMap::new();
        for selected in vertices {
            let group = selected.vertex_group;
            let entry = first_of.get(&group);
            let entry = entry.unwrap_or_else(|| panic!("there is no vertex group {group}"));
            let planned = planned_vertices(entry, selected)?;
            if groups.insert(group, planned).is_some() {
                return refused(format!("vertex group {group} is selected twice"));
            }
        }

        // The faces.
        let mut meshes = BTreeMap::new();
        for selected in faces {
            let mesh = selected.mesh;
            assert!(mesh < entries.len(), "there is no mesh {mesh}");
            let entry = &entries[mesh];
            let group: Option<&PlannedVertices> = groups.get(&entry.vertex_group);
            let vertices_leave = group.is_some_and(|group| !group.are_all());
            let planned = planned_mesh(entry, selected, !vertices_leave)?;
            if meshes.insert(mesh, planned).is_some() {
                return refused_of(entry, "it is selected twice");
            }
        }

        let plan = Self {
            meshes: meshes.into_values().collect(),
            groups: groups.into_values().collect(),
        };
        plan.check_used(entries, faces)?;
        Ok(plan)
    }

    /// What was selected of the vertices of a group.
    pub(super) fn group(&self, group: usize) -> Option<&PlannedVertices> {
        let found = self
            .groups
            .binary_search_by_key(&group, |planned| planned.group);
        found.ok().map(|found| &self.groups[found])
    }

    /// What was selected of the faces of a mesh.
    pub(super) fn mesh(&self, mesh: usize) -> Option<&PlannedMesh> {
        let found = self
            .meshes
            .binary_search_by_key(&mesh, |planned| planned.mesh);
        found.ok().map(|found| &self.meshes[found])
    }

    /// Whether it changes nothing.
    pub(super) fn is_identity(&self, entries: &[MeshEntry]) -> bool {
        let is_same = |planned: &PlannedMesh| {
            planned.is_whole(&entries[planned.mesh]) && planned.order.is_identity()
        };
        let mut groups = self.groups.iter();
        self.meshes.iter().all(is_same)
            && groups.all(|group| group.are_all() && group.order.is_identity())
    }

    /// Whether the vertices that faces use stay.
    fn check_used(
        &self,
        entries: &[MeshEntry],
        selected: &[SelectedFaces<'_>],
    ) -> Result<(), FileErrorKind> {
        let selected = selected
            .iter()
            .map(|selected| (selected.mesh, selected.faces));
        let selected: BTreeMap<usize, &[SelectedFace]> = selected.collect();
        for (mesh, entry) in entries.iter().enumerate() {
            let Some(group) = self.group(entry.vertex_group).filter(|g| !g.are_all()) else {
                continue;
            };
            let is_left_out = |&vertex: &u32| group.old_to_new[vertex as usize] == LEFT_OUT;
            let left_out = |corners: &[u32; 3]| corners.iter().copied().find(is_left_out);
            let found = match selected.get(&mesh) {
                Some(faces) => faces
                    .iter()
                    .find_map(|face| Some((face.face, left_out(&face.corners)?))),
                None => (0..)
                    .zip(entry.mesh.faces())
                    .find_map(|(face, corners)| Some((face, left_out(corners)?))),
            };
            if let Some((face, vertex)) = found {
                let text = format!("face {face} uses vertex {vertex}, which is left out");
                return refused_of(entry, &text);
            }
        }
        Ok(())
    }
}

impl PlannedMesh {
    /// Whether all records stay as they are.
    pub(super) fn is_whole(&self, entry: &MeshEntry) -> bool {
        let is_whole = |record: &PlannedRecord| matches!(record, PlannedRecord::Whole(_));
        self.records.len() == entry.record_count() && self.records.iter().all(is_whole)
    }

    /// Its faces in the order of its records, by old vertex numbers.
    pub(super) fn faces(&self, entry: &MeshEntry) -> impl Iterator<Item = [u32; 3]> {
        let faces = entry.mesh.faces();
        self.records.iter().flat_map(move |planned| {
            let (whole, triangle) = match planned {
                PlannedRecord::Whole(record) => (entry.faces_of(*record as usize), None),
                PlannedRecord::Triangle(triangle) => (0..0, Some(triangle.corners)),
            };
            faces[whole].iter().copied().chain(triangle)
        })
    }
}

/// The records that faces are selected of; those without faces stay only where `empty_stay`.
fn planned_mesh(
    entry: &MeshEntry,
    selected: &SelectedFaces<'_>,
    empty_stay: bool,
) -> Result<PlannedMesh, FileErrorKind> {
    let faces = entry.mesh.faces();
    if selected.faces.is_empty() {
        return refused_of(entry, "no face is selected, and it needs one at least");
    }
    check_sources(entry, selected)?;

    // Where each face was asked for.
    let mut place_of = vec![u32::MAX; faces.len()];
    for (place, selected) in selected.faces.iter().enumerate() {
        check_corners(entry, selected)?;
        let Some(slot) = place_of.get_mut(selected.face as usize) else {
            let (face, count) = (selected.face, faces.len());
            return refused_of(entry, &format!("there is no face {face}: it has {count}"));
        };
        if std::mem::replace(slot, index32(place)) != u32::MAX {
            let text = format!("face {} is selected twice", selected.face);
            return refused_of(entry, &text);
        }
    }

    // What becomes of each record, and the place where it was asked for. One without faces goes after
    // the one before it.
    let mut records = Vec::with_capacity(selected.faces.len());
    let mut places: Vec<u32> = Vec::with_capacity(selected.faces.len());
    for number in 0..entry.record_count() {
        let range = entry.faces_of(number);
        let record = index32(number);
        let chosen = |face: usize| selected.faces.get(place_of[face] as usize);
        let stays = |face: usize| chosen(face).is_some_and(|c| c.corners == faces[face]);
        if range.clone().all(stays) {
            if range.is_empty() && !empty_stay {
                continue;
            }
            let first = place_of[range].iter().copied().min();
            places.push(first.or(places.last().copied()).unwrap_or(0));
            records.push(PlannedRecord::Whole(record));
            continue;
        }
        for (fan, face) in (0..).zip(range) {
            let Some(SelectedFace { corners, .. }) = chosen(face) else {
                continue;
            };
            let sources = selected.corner_sources.get(place_of[face] as usize);
            places.push(place_of[face]);
            records.push(PlannedRecord::Triangle(PlannedTriangle {
                record,
                fan,
                corners: *corners,
                sources: sources.map(|sources| sources.map(|corner| record_corner(entry, corner))),
            }));
        }
    }

    let mut order: Vec<u32> = (0..index32(records.len())).collect();
    order.sort_by_key(|&record| places[record as usize]);
    Ok(PlannedMesh {
        mesh: selected.mesh,
        records,
        order: Permutation::from_algorithm(order).into(),
    })
}

/// Whether each corner source, if there are some, is at the vertex of the corner.
fn check_sources(entry: &MeshEntry, selected: &SelectedFaces<'_>) -> Result<(), FileErrorKind> {
    let sources = selected.corner_sources;
    if !sources.is_empty() && sources.len() != selected.faces.len() {
        return Err(FileErrorKind::Order(MeshError::LengthMismatch {
            what: "corner sources",
            expected: selected.faces.len(),
            found: sources.len(),
        }));
    }
    let corners = entry.mesh.faces().as_flattened();
    for (face, sources) in selected.faces.iter().zip(sources) {
        for (&vertex, &source) in face.corners.iter().zip(sources) {
            if corners.get(source as usize) != Some(&vertex) {
                let face = face.face;
                let text = format!(
                    "face {face}: corner {source} of the source is not at vertex {vertex}, whose place it is to take"
                );
                return refused_of(entry, &text);
            }
        }
    }
    Ok(())
}

/// A corner of the mesh, three times its face plus 0, 1 or 2, as one of a record.
fn record_corner(entry: &MeshEntry, corner: u32) -> RecordCorner {
    let (face, slot) = (corner / 3, corner as usize % 3);
    let (record, fan) = match &entry.polygons {
        None => (face as usize, 0),
        Some(starts) => {
            let record = starts.partition_point(|&start| start <= face) - 1;
            (record, (face - starts[record]) as usize)
        }
    };
    let place = if slot == 0 { 0 } else { fan + slot };
    RecordCorner { record, place }
}

/// Whether the vertices of a selected face are there.
fn check_corners(entry: &MeshEntry, selected: &SelectedFace) -> Result<(), FileErrorKind> {
    let vertex_count = entry.mesh.vertex_count();
    let is_past = |&index: &u32| index as usize >= vertex_count;
    match selected.corners.iter().position(is_past) {
        Some(corner) => Err(FileErrorKind::Order(MeshError::IndexOutOfRange {
            face: selected.face as usize,
            corner,
            index: selected.corners[corner],
            vertex_count,
        })),
        None => Ok(()),
    }
}

/// The vertices that are selected of those of a mesh.
fn planned_vertices(
    entry: &MeshEntry,
    selected: &SelectedVertices<'_>,
) -> Result<PlannedVertices, FileErrorKind> {
    // Mark those that stay.
    let count = entry.mesh.vertex_count();
    let mut old_to_new = vec![LEFT_OUT; count];
    for &vertex in selected.vertices {
        let Some(slot) = old_to_new.get_mut(vertex as usize) else {
            return refused_of(
                entry,
                &format!("there is no vertex {vertex}: it has {count}"),
            );
        };
        if std::mem::replace(slot, 0) != LEFT_OUT {
            return refused_of(entry, &format!("vertex {vertex} is selected twice"));
        }
    }

    if selected.vertices.is_empty() && count > 0 {
        return refused_of(entry, "no vertex is selected, and it needs one at least");
    }

    // Number them as they rise.
    let mut kept = Vec::with_capacity(selected.vertices.len());
    for (old, new) in old_to_new.iter_mut().enumerate() {
        if *new != LEFT_OUT {
            *new = index32(kept.len());
            kept.push(index32(old));
        }
    }
    let order = selected
        .vertices
        .iter()
        .map(|&old| old_to_new[old as usize]);
    let order = Permutation::from_algorithm(order.collect());
    Ok(PlannedVertices {
        group: selected.vertex_group,
        kept,
        old_to_new,
        order: order.into(),
    })
}

fn refused<T>(text: String) -> Result<T, FileErrorKind> {
    Err(FileErrorKind::unsupported(text))
}

fn refused_of<T>(entry: &MeshEntry, text: &str) -> Result<T, FileErrorKind> {
    refused(format!("mesh {:?}: {text}", entry.name))
}

/// The problem of a face that a selection cannot change, at no place in particular.
pub(super) fn face_problem(face: u32, text: &str) -> Problem {
    FileErrorKind::unsupported(format!("face record {face}: {text}")).at(Place::File)
}
