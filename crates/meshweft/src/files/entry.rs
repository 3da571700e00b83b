//! A mesh as a file holds it: records that can be moved, each within its run.

use std::ops::Range;

use crate::Mesh;
use crate::first_use::{FirstUse, keeps_blocks};
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// One re-orderable mesh of a file.
///
/// A *face record* is what the file stores for one face: three indices, a line of text, a polygon
/// with its attributes. Orders that are applied to a file are orders of records.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeshEntry {
    /// What the file calls it, or a description of where it stands.
    pub name: String,
    /// Its faces, polygons cut into fans, in record order; without positions, which
    /// [`Document::positions`](super::Document::positions) gives.
    pub mesh: Mesh,
    /// Where each polygon's faces start in `mesh` (one more entry than records), or `None` where
    /// each record is one triangle.
    pub polygons: Option<Vec<u32>>,
    /// The first record of each run of one material, group, cluster of a culling table, …: rising, the first 0, and empty if
    /// there are no records. A record stays within its run.
    pub runs: Vec<u32>,
    /// Meshes with the same number share their vertices: a vertex order for one renumbers all.
    pub vertex_group: usize,
    /// Meshes with the same number are parts of one object, as the primitives of a glTF mesh are: their
    /// surfaces may meet.
    pub object: usize,
    /// Whether the object has faces that are not in any of these meshes (strips, compressed faces, …) and may
    /// meet those that are.
    pub has_other_faces: bool,
    /// Whether face records may be moved and turned; not where the order of the faces is part of the
    /// picture, as that of transparent ones.
    pub faces_movable: bool,
    /// Whether the vertices may be moved.
    pub vertices_movable: bool,
    /// Whether a record's corners may be turned.
    pub corners_turnable: bool,
    /// Of which mesh it is a level of detail; `None` of a mesh at full resolution.
    pub level: Option<MeshLevel>,
}

/// That a mesh is a level of detail of another one, drawn in its place where less is enough.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MeshLevel {
    /// 1 is the finest below full resolution. Several meshes may be the same level of one.
    pub number: usize,
    /// The number of the mesh at full resolution, which has no level itself.
    pub of: usize,
    /// How far the level is off, as the file states it: finite, not negative, in units of the positions.
    pub error: Option<f32>,
}

impl MeshEntry {
    /// How many face records the mesh has.
    #[must_use]
    pub fn record_count(&self) -> usize {
        match &self.polygons {
            Some(starts) => starts.len().saturating_sub(1),
            None => self.mesh.face_count(),
        }
    }

    /// The faces of `record` in [`mesh`](Self::mesh), as a range.
    pub(crate) fn faces_of(&self, record: usize) -> Range<usize> {
        match &self.polygons {
            Some(starts) => starts[record] as usize..starts[record + 1] as usize,
            None => record..record + 1,
        }
    }

    /// Whether there are records of one or two corners, or none.
    pub(super) fn has_short_records(&self) -> bool {
        let mut records = 0..self.record_count();
        records.any(|record| self.faces_of(record).is_empty())
    }

    /// What belongs to each corner of the faces, three a face: `of_record` has it for the corners of a record.
    pub(super) fn of_face_corners(&self, mut of_record: impl FnMut(usize) -> Vec<u32>) -> Vec<u32> {
        let mut all = Vec::with_capacity(3 * self.mesh.face_count());
        for record in 0..self.record_count() {
            let own = of_record(record);
            for fan in 0..self.faces_of(record).len() {
                all.extend([own[0], own[fan + 1], own[fan + 2]]);
            }
        }
        all
    }

    /// The vertices of a record that is cut into a fan of faces: one or more.
    pub(super) fn corners_of(&self, record: usize) -> impl Iterator<Item = u32> {
        let faces = &self.mesh.faces()[self.faces_of(record)];
        let first = faces.first().map(|face| [face[0], face[1]]);
        let first = first.into_iter().flatten();
        first.chain(faces.iter().map(|face| face[2]))
    }

    /// An order of the records, made by ordering each run on its own with `face_order`.
    ///
    /// `face_order` sees one run as a mesh of triangles over the vertices it uses (over all where it uses a
    /// quarter of more than 65,536, whose numbers then mean something) and, if there are polygons, where the triangles of each start (and the end of the last). A polygon goes where
    /// the first of its triangles goes and is never turned; triangles are turned only if the file
    /// allows it. Where the faces must stay, `face_order` is not called.
    ///
    /// # Complexity
    /// That of `face_order` on each run, plus O(faces).
    pub fn record_order(
        &self,
        mut face_order: impl FnMut(&Mesh, Option<&[u32]>) -> FaceOrder,
    ) -> FaceOrder {
        let record_count = self.record_count();
        if !self.faces_movable {
            return FaceOrder::identity(record_count);
        }
        let turn = self.corners_turnable && self.polygons.is_none();

        // One run of triangles is the mesh itself.
        if self.runs.len() <= 1 && self.polygons.is_none() {
            let order = face_order(&self.mesh, None);
            return match turn {
                true => order,
                false => order.permutation().clone().into(),
            };
        }

        // Order one run after the other.
        let mut new_to_old = Vec::with_capacity(record_count);
        let mut rotations = Vec::new();
        let mut numbers = FirstUse::new(self.mesh.vertex_count(), 3 * self.mesh.face_count());
        let starts = self.runs.iter().map(|&start| start as usize);
        let ends = starts.clone().skip(1).chain([record_count]);
        for (start, end) in starts.zip(ends) {
            let emit = |record, rotation| {
                new_to_old.push(record);
                rotations.push(rotation);
            };
            self.order_run(start..end, &mut numbers, &mut face_order, emit);
        }

        // A record that is not a triangle is never turned.
        if !turn || rotations.iter().all(|&r| r == 0) {
            rotations.clear();
        }
        let permutation = Permutation::from_algorithm(new_to_old);
        FaceOrder::new(permutation, rotations).expect("one rotation below 3 a record")
    }

    /// Passes the records of one run to `emit` in their new order, each with its rotation.
    fn order_run(
        &self,
        run: Range<usize>,
        numbers: &mut FirstUse,
        face_order: &mut impl FnMut(&Mesh, Option<&[u32]>) -> FaceOrder,
        mut emit: impl FnMut(u32, u8),
    ) {
        if run.len() == 1 {
            return emit(index32(run.start), 0);
        }

        let RunMesh {
            mesh,
            record_of,
            starts,
        } = self.run_mesh(run.clone(), numbers);
        let order = face_order(&mesh, starts.as_deref());

        // A polygon goes where the first of its triangles went.
        let mut placed = vec![false; run.len()];
        for (new, &old) in order.new_to_old().iter().enumerate() {
            let record = record_of[old as usize];
            let placed = &mut placed[record as usize - run.start];
            if !std::mem::replace(placed, true) {
                emit(record, order.rotation(new));
            }
        }

        // One without triangles (a point, a line) comes after the others.
        for (record, placed) in run.zip(placed) {
            if !placed {
                emit(index32(record), 0);
            }
        }
    }

    /// A run as a mesh of its own, its vertices numbered by first use, or as they are.
    fn run_mesh(&self, run: Range<usize>, numbers: &mut FirstUse) -> RunMesh {
        let mut faces = Vec::new();
        let mut record_of = Vec::new();
        let mut starts = self.polygons.as_ref().map(|_| Vec::new());
        for record in run {
            let faces_of_record = self.faces_of(record);
            if let Some(starts) = starts.as_mut().filter(|_| !faces_of_record.is_empty()) {
                starts.push(index32(faces.len()));
            }
            for face in faces_of_record {
                record_of.push(index32(record));
                faces.push(self.mesh.faces()[face].map(|vertex| numbers.number(vertex)));
            }
        }
        if let Some(starts) = &mut starts {
            starts.push(index32(faces.len()));
        }

        // A run of much of a large buffer keeps its numbers, which stand in blocks.
        let used = numbers.finish();
        let mut vertex_count = used.len();
        if keeps_blocks(self.mesh.vertex_count(), vertex_count) {
            vertex_count = self.mesh.vertex_count();
            for face in &mut faces {
                *face = face.map(|vertex| used[vertex as usize]);
            }
        }
        RunMesh {
            mesh: Mesh::connectivity_only(vertex_count, faces).expect("indices are local"),
            record_of,
            starts,
        }
    }

    /// Whether `order` keeps each record within its run.
    pub(crate) fn keeps_runs(&self, order: &FaceOrder) -> bool {
        if self.runs.len() <= 1 {
            return true;
        }
        let run_of = |record: u32| self.runs.partition_point(|&start| start <= record);
        (0_u32..)
            .zip(order.new_to_old())
            .all(|(new, &old)| run_of(new) == run_of(old))
    }

    /// The faces in the order of their records.
    ///
    /// # Panics
    /// If the order is of another number of records.
    pub(crate) fn ordered_faces(&self, order: &FaceOrder) -> Vec<[u32; 3]> {
        let Some(starts) = &self.polygons else {
            return order.apply(self.mesh.faces());
        };
        let records = order.new_to_old().iter().map(|&old| old as usize);
        let ranges = records.map(|old| starts[old] as usize..starts[old + 1] as usize);
        let faces = self.mesh.faces();
        ranges.flat_map(|range| &faces[range]).copied().collect()
    }

    /// Moves the face records of this entry; the file it came from is not changed.
    ///
    /// # Panics
    /// If the order is of another number of records.
    pub fn apply_faces(&mut self, order: &FaceOrder) {
        let Some(starts) = &self.polygons else {
            self.mesh = std::mem::take(&mut self.mesh).into_face_order(order);
            return;
        };

        // Move each polygon's faces together.
        let mut faces = Vec::with_capacity(self.mesh.face_count());
        let mut new_starts = Vec::with_capacity(starts.len());
        new_starts.push(0);
        for &old in order.new_to_old() {
            let old = old as usize;
            faces.extend(starts[old]..starts[old + 1]);
            new_starts.push(index32(faces.len()));
        }

        self.polygons = Some(new_starts);
        let faces = Permutation::from_algorithm(faces).into();
        self.mesh = std::mem::take(&mut self.mesh).into_face_order(&faces);
    }

    /// Moves and renumbers the vertices of this entry; the file it came from is not changed.
    ///
    /// # Panics
    /// If the order is of another number of vertices.
    pub fn apply_vertices(&mut self, order: &VertexOrder) {
        assert_eq!(
            order.len(),
            self.mesh.vertex_count(),
            "vertex order of another length"
        );
        self.mesh = std::mem::take(&mut self.mesh).into_vertex_order(order);
    }

    /// As [`apply_vertices`](Self::apply_vertices), of an order whose inverse is known: of many entries that
    /// share their vertices, each takes as long as it has faces.
    pub(crate) fn renumber_vertices(&mut self, old_to_new: &[u32]) {
        self.mesh.renumber_faces(old_to_new);
    }
}

/// A run of records as a mesh of its own.
struct RunMesh {
    mesh: Mesh,
    /// The record that each face is of.
    record_of: Vec<u32>,
    /// Where the faces of each polygon start, and the end of the last; `None` without polygons.
    starts: Option<Vec<u32>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reversed(mesh: &Mesh, _polygons: Option<&[u32]>) -> FaceOrder {
        let last_first = (0..index32(mesh.face_count())).rev().collect();
        let rotations = vec![1; mesh.face_count()];
        FaceOrder::new(Permutation::from_algorithm(last_first), rotations).unwrap()
    }

    fn entry(faces: Vec<[u32; 3]>, polygons: Option<Vec<u32>>, runs: Vec<u32>) -> MeshEntry {
        MeshEntry {
            name: "test".into(),
            mesh: Mesh::connectivity_only(9, faces).unwrap(),
            polygons,
            runs,
            vertex_group: 0,
            object: 0,
            has_other_faces: false,
            faces_movable: true,
            vertices_movable: true,
            corners_turnable: true,
            level: None,
        }
    }

    #[test]
    fn records_stay_within_their_run() {
        let faces = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8], [6, 7, 0]];
        let entry = entry(faces, None, vec![0, 1]);
        let order = entry.record_order(reversed);
        assert_eq!(order.new_to_old(), [0, 3, 2, 1]);
        assert_eq!(order.rotations(), [0, 1, 1, 1], "one alone stays");
        assert!(entry.keeps_runs(&order));
        assert!(!entry.keeps_runs(&reversed(&entry.mesh, None)));
    }

    #[test]
    fn polygons_stay_whole_and_unturned() {
        // A quad, a line (no triangle), a triangle.
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6]];
        let mut entry = entry(faces, Some(vec![0, 2, 2, 3]), vec![0]);
        let order = entry.record_order(reversed);
        assert_eq!(order.new_to_old(), [2, 0, 1]);
        assert!(order.rotations().is_empty());
        entry.apply_faces(&order);
        assert_eq!(entry.mesh.faces(), [[4, 5, 6], [0, 1, 2], [0, 2, 3]]);
        assert_eq!(entry.polygons, Some(vec![0, 1, 3, 3]));
    }

    #[test]
    fn corners_are_turned_only_where_the_file_allows() {
        let mut entry = entry(vec![[0, 1, 2], [3, 4, 5]], None, vec![0]);
        assert_eq!(entry.record_order(reversed).rotations(), [1, 1]);
        entry.corners_turnable = false;
        assert!(entry.record_order(reversed).rotations().is_empty());
    }

    #[test]
    fn faces_that_must_stay_are_not_ordered() {
        let mut entry = entry(vec![[0, 1, 2], [3, 4, 5]], None, vec![0]);
        entry.faces_movable = false;
        let order = entry.record_order(|_, _| unreachable!("nothing to order"));
        assert!(order.is_identity() && order.len() == 2);
    }

    #[test]
    fn no_records_are_ordered() {
        let entry = entry(vec![], None, vec![]);
        assert_eq!(entry.record_order(reversed).len(), 0);
    }
}
