//! The records of a glTF that a selection leaves, moved up to the start of where all stood.

use std::collections::BTreeMap;

use super::buffers::Buffers;
use super::byte_users::{ByteUsers, UsedAs};
use super::entries::{Corners, Entries};
use super::patch;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::select::{LEFT_OUT, PlannedMesh, PlannedVertices};
use crate::index::index32;

/// The storages in the making, and how many of which records are left.
pub(super) struct Leaving<'a> {
    entries: &'a Entries,
    buffers: &'a Buffers,
    pub(super) byte_users: &'a ByteUsers,
    /// The vertex records of each group, by their numbers in `byte_users`.
    vertices_of: BTreeMap<usize, Vec<usize>>,
    /// How many are left, by the number of the records in `byte_users`.
    pub(super) left: BTreeMap<usize, usize>,
    /// The bytes of the storages that change.
    pub(super) changed: BTreeMap<usize, Vec<u8>>,
    /// The values of sparse elements of which none is left, with the one that stands in for them.
    emptied: BTreeMap<StridedRecords, Option<Vec<u8>>>,
}

impl<'a> Leaving<'a> {
    /// `group_of` has the group of each primitive that can be changed.
    pub(super) fn new(
        entries: &'a Entries,
        buffers: &'a Buffers,
        byte_users: &'a ByteUsers,
        group_of: &[usize],
    ) -> Self {
        let mut vertices_of: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (number, used) in byte_users.used.iter().enumerate() {
            // All who read them are of one group.
            if let Some(&user) = used.users_as(UsedAs::Vertices).first() {
                vertices_of.entry(group_of[user]).or_default().push(number);
            }
        }
        Self {
            entries,
            buffers,
            byte_users,
            vertices_of,
            left: BTreeMap::new(),
            changed: BTreeMap::new(),
            emptied: BTreeMap::new(),
        }
    }

    /// How many of these records are left, if some leave.
    pub(super) fn left_of(&self, records: &StridedRecords) -> Option<usize> {
        let number = self.byte_users.find(records)?;
        self.left.get(&number).copied()
    }

    /// Moves the vertices of a group, and renumbers what names them but for the faces that are planned.
    ///
    /// # Errors
    /// Something else than faces names a vertex that leaves.
    pub(super) fn vertices(
        &mut self,
        planned: &PlannedVertices,
        is_planned: impl Fn(usize) -> bool,
    ) -> Result<(), Problem> {
        let group = &self.entries.groups[planned.group];
        let old_to_new = planned.old_to_new.as_slice();

        // Attributes and morph targets.
        let vertices = self.vertices_of.get(&planned.group).cloned();
        for number in vertices.unwrap_or_default() {
            self.gather(self.byte_users.used[number].records, &planned.kept);
        }

        // Sparse elements.
        for shared in group.sparse.chunk_by(|a, b| a.indices == b.indices) {
            self.sparse(shared, old_to_new);
        }

        // Lines, strips and outlines.
        for list in &group.other_lists {
            let bytes = self.bytes(list.storage);
            let numbers = patch::numbers(bytes, list);
            let is_left_out = |&&number: &&u32| old_to_new.get(number as usize) == Some(&LEFT_OUT);
            if let Some(vertex) = numbers.iter().find(is_left_out) {
                return Err(named_elsewhere(*vertex));
            }
            let new = numbers.iter().map(|&old| old_to_new[old as usize]);
            patch::write_numbers(bytes, list, new);
        }

        // Meshes that keep all their faces.
        for &mesh in group.meshes.iter().filter(|&&mesh| !is_planned(mesh)) {
            let entries = self.entries;
            if let Corners::Indices(list) = &entries.corners[mesh] {
                let faces = entries.meshes[mesh].mesh.faces().as_flattened();
                let new = faces.iter().map(|&old| old_to_new[old as usize]);
                patch::write_numbers(self.bytes(list.storage), list, new);
            }
        }
        Ok(())
    }

    /// Writes the faces of a mesh that are left, by their new vertex numbers.
    ///
    /// # Errors
    /// The type of its indices cannot hold one of them.
    pub(super) fn faces(
        &mut self,
        planned: &PlannedMesh,
        faces: &[[u32; 3]],
    ) -> Result<(), Problem> {
        let corners = faces.as_flattened();
        match &self.entries.corners[planned.mesh] {
            Corners::Indices(list) => {
                let restart = patch::largest_number(list);
                if let Some(vertex) = corners.iter().find(|&&vertex| vertex >= restart) {
                    let text = format!(
                        "mesh {:?}: its indices are stored in {} bits, which cannot name vertex {vertex}: leave \
                         out more vertices",
                        self.entries.meshes[planned.mesh].name,
                        8 * list.size
                    );
                    return Err(FileErrorKind::unsupported(text).at(Place::File));
                }
                let left = StridedRecords::new(
                    list.storage,
                    list.start,
                    corners.len(),
                    list.stride,
                    list.size,
                );
                let list = *list;
                let numbers = corners.iter().copied();
                patch::write_numbers(self.bytes(list.storage), &left, numbers);
                self.leave(&list, corners.len());
            }
            // Three vertices in a row are a face.
            Corners::Triples(vertices) => {
                for records in vertices.clone() {
                    self.gather(records, corners);
                }
            }
        }
        Ok(())
    }

    /// Puts record `kept[i]` at the `i`-th place; there are not more than before.
    fn gather(&mut self, records: StridedRecords, kept: &[u32]) {
        let StridedRecords {
            storage,
            start,
            stride,
            size,
            ..
        } = records;
        let bytes = self.bytes(storage);
        let place = |number: usize| start + number * stride;
        if kept.is_sorted_by(|a, b| a < b) {
            // Each goes up, to where nothing is needed any more.
            for (new, &old) in kept.iter().enumerate() {
                let old = place(old as usize);
                bytes.copy_within(old..old + size, place(new));
            }
        } else {
            let moved = kept.iter().map(|&old| place(old as usize));
            let moved: Vec<u8> = moved
                .flat_map(|old| bytes[old..old + size].to_vec())
                .collect();
            for (new, record) in moved.chunks_exact(size.max(1)).enumerate() {
                bytes[place(new)..][..size].copy_from_slice(record);
            }
        }
        self.leave(&records, kept.len());
    }

    /// Leaves those sparse elements whose vertices stay. One stays in any case, as glTF wants: see
    /// [`stand_in`](Self::stand_in).
    fn sparse(&mut self, shared: &[Sparse], old_to_new: &[u32]) {
        let indices = shared[0].indices;
        let numbers = patch::numbers(self.bytes(indices.storage), &indices);
        let new_of = |place: u32| old_to_new[numbers[place as usize] as usize];
        let all = 0..index32(numbers.len());
        let mut kept: Vec<u32> = all.filter(|&place| new_of(place) != LEFT_OUT).collect();
        kept.sort_unstable_by_key(|&place| new_of(place));
        if numbers.is_empty() {
            return;
        }

        let count = kept.len().max(1);
        let left = StridedRecords::new(
            indices.storage,
            indices.start,
            count,
            indices.stride,
            indices.size,
        );
        let new: Vec<u32> = match kept.is_empty() {
            true => vec![0],
            false => kept.iter().map(|&place| new_of(place)).collect(),
        };
        patch::write_numbers(self.bytes(indices.storage), &left, new);
        self.leave(&indices, count);
        for sparse in shared {
            match kept.is_empty() {
                true => {
                    self.emptied.entry(sparse.values).or_default();
                    self.leave(&sparse.values, 1);
                }
                false => self.gather(sparse.values, &kept),
            }
        }
    }

    /// Where no sparse element is left, gives the one that stands in for them what the first vertex holds
    /// without it: zeros, or the first of the records that are left.
    ///
    /// # Errors
    /// It would have to hold two things, as two accessors share it.
    pub(super) fn stand_in(
        &mut self,
        sparse: &Sparse,
        records: Option<&StridedRecords>,
        pointer: &str,
    ) -> Result<(), Problem> {
        let Some(earlier) = self.emptied.get(&sparse.values).cloned() else {
            return Ok(());
        };
        let values = sparse.values;
        let first = match records {
            Some(records) => self.bytes(records.storage)[records.start..][..values.size].to_vec(),
            None => vec![0; values.size],
        };
        if earlier.is_some_and(|earlier| earlier != first) {
            let text = "none of its sparse elements is left, and it shares them with another accessor: give it \
                        its own";
            return Err(FileErrorKind::unsupported(text).at(Place::Json(pointer.to_owned())));
        }
        self.bytes(values.storage)[values.start..][..values.size].copy_from_slice(&first);
        self.emptied.insert(values, Some(first));
        Ok(())
    }

    fn leave(&mut self, records: &StridedRecords, count: usize) {
        if let Some(number) = self.byte_users.find(records) {
            self.left.insert(number, count);
        }
    }

    /// The bytes of a storage, for a change.
    pub(super) fn bytes(&mut self, storage: usize) -> &mut Vec<u8> {
        let buffers = self.buffers;
        let changed = self.changed.entry(storage);
        changed.or_insert_with(|| buffers.storages[storage].bytes.clone())
    }
}

/// The problem of a vertex that is left out, and that more than faces need.
fn named_elsewhere(vertex: u32) -> Problem {
    let text = format!(
        "vertex {vertex} is left out, but lines, strips, points or an outline name it: keep it, or remove those"
    );
    FileErrorKind::unsupported(text).at(Place::File)
}
