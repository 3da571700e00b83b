//! The meshes that a file offers, and the records of each.

use std::collections::{BTreeMap, BTreeSet};

use super::buffers::Buffers;
use super::byte_users::ByteUsers;
use super::groups::{group_numbers, vertex_obstacle};
use super::movable::{IndexList, Movable, PrimitiveNumber};
use super::object::malformed;
use super::obstacles::VertexObstacle;
use super::patch;
use super::primitives::Primitives;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;
use crate::Mesh;
use crate::error::MeshError;
use crate::files::entry::MeshEntry;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::index::index32;

/// Where the corners of a mesh's faces are stored.
#[derive(Debug)]
pub(super) enum Corners {
    /// A list of vertex numbers.
    Indices(StridedRecords),
    /// The vertices themselves, three a face, in each of these.
    Triples(Vec<StridedRecords>),
}

/// What one vertex order moves.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// Attributes and morph targets.
    pub(super) vertices: Vec<StridedRecords>,
    /// Lists of vertex numbers other than the faces.
    pub(super) outlines: Vec<StridedRecords>,
    /// Sparse elements, sorted.
    pub(super) sparse: Vec<Sparse>,
    pub(super) meshes: Vec<usize>,
}

/// The meshes of a file.
#[derive(Debug, Default)]
pub(super) struct Entries {
    pub(super) meshes: Vec<MeshEntry>,
    /// One for each mesh.
    pub(super) corners: Vec<Corners>,
    pub(super) groups: Vec<Group>,
    /// Of each mesh the primitive that made it: the first with its faces. They rise.
    pub(super) first_primitives: Vec<PrimitiveNumber>,
    /// The largest index of each mesh as it was read.
    largest_index: Vec<Option<u32>>,
    /// Why the vertices of a group stay, and the primitive that comes with it.
    pub(super) vertex_obstacles: Vec<(PrimitiveNumber, VertexObstacle)>,
}

impl Entries {
    /// Decodes the faces of every primitive and decides which vertices may move.
    pub(super) fn new(
        primitives: &Primitives,
        byte_users: &ByteUsers,
        buffers: &Buffers,
    ) -> Result<Self, Problem> {
        let movable = primitives.movable.as_slice();
        let group_of = group_numbers(movable, byte_users);
        let group_count = group_of.iter().max().map_or(0, |&last| last + 1);
        let mut entries = Self::default();
        entries.groups.resize_with(group_count, Group::default);
        let mut first_of_group = vec![None; group_count];
        let mut obstacles: Vec<Option<(PrimitiveNumber, VertexObstacle)>> = vec![None; group_count];
        let mut entry_of = BTreeMap::new();
        let mut looked_through = BTreeSet::new();

        for (primitive, &group) in movable.iter().zip(&group_of) {
            // Why its vertices stay, as far as shared data tells.
            let count = *first_of_group[group].get_or_insert(primitive.vertex_count);
            if obstacles[group].is_none() && primitive.indices.is_some() {
                obstacles[group] = vertex_obstacle(primitive, count, byte_users)
                    .map(|obstacle| (primitive.number, obstacle));
            }

            // Its mesh, which others with the same faces may have made.
            let key = match &primitive.indices {
                Some(list) => list.records,
                // Every primitive has a POSITION with records, and those without indices that share
                // one share all their data.
                None => match primitive.vertices.first() {
                    Some(&records) => records,
                    None => continue,
                },
            };
            let entry = match entry_of.get(&key) {
                Some(&entry) => entry,
                None => {
                    let entry = entries.meshes.len();
                    let name = primitives.name(primitive.number);
                    entries.add(primitive, name, group, buffers)?;
                    entry_of.insert(key, entry);
                    entry
                }
            };
            if entries.largest_index[entry] >= Some(index32(primitive.vertex_count)) {
                check_range(entries.meshes[entry].mesh.faces().as_flattened(), primitive)?;
            }

            // Why its vertices stay, as far as its lists tell.
            if obstacles[group].is_none() {
                // A list is looked through once for its group, however many primitives share it.
                obstacles[group] = primitive
                    .lists()
                    .filter(|list| looked_through.insert((list.records, list.is_bounded)))
                    .find_map(|list| list_obstacle(list, primitive, buffers))
                    .map(|obstacle| (primitive.number, obstacle));
            }

            let target = &mut entries.groups[group];
            target.sparse.extend(primitive.sparse());
            let outline = primitive.outline().map(|list| list.records);
            target.outlines.extend(outline);
        }

        entries.add_vertices(byte_users, &group_of);
        for entry in &mut entries.meshes {
            entry.vertices_movable &= obstacles[entry.vertex_group].is_none();
        }
        entries.vertex_obstacles = obstacles.into_iter().flatten().collect();
        Ok(entries)
    }

    /// Gives each group the records that go by vertex, and sorts what it has.
    fn add_vertices(&mut self, byte_users: &ByteUsers, group_of: &[usize]) {
        // All primitives that read some records are of one group.
        for used in &byte_users.used {
            if let Some(&user) = used.vertex_users.first() {
                self.groups[group_of[user]].vertices.push(used.records);
            }
        }

        for group in &mut self.groups {
            for records in [&mut group.vertices, &mut group.outlines] {
                records.sort_unstable();
                records.dedup();
            }
            patch::join(&mut group.vertices);
            group.sparse.sort_unstable();
            group.sparse.dedup();
        }
    }

    /// Adds the mesh of a primitive.
    fn add(
        &mut self,
        primitive: &Movable,
        name: String,
        group: usize,
        buffers: &Buffers,
    ) -> Result<(), Problem> {
        let at_primitive = |error: MeshError| {
            FileErrorKind::Order(error).at(Place::Json(primitive.number.pointer()))
        };
        let faces = match &primitive.indices {
            Some(list) => {
                let storage = &buffers.storages[list.records.storage];
                let faces = patch::faces(&storage.bytes, &list.records);
                check_restart(faces.as_flattened(), list, primitive)?;
                check_range(faces.as_flattened(), primitive)?;
                faces
            }
            None => {
                let count = index32(primitive.vertex_count / 3);
                (0..count).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect()
            }
        };

        let mesh = Mesh::connectivity_only(primitive.vertex_count, faces).map_err(at_primitive)?;

        self.first_primitives.push(primitive.number);
        let largest = mesh.faces().as_flattened().iter().max();
        self.largest_index.push(largest.copied());
        self.groups[group].meshes.push(self.meshes.len());
        self.meshes.push(MeshEntry {
            name,
            runs: if mesh.face_count() == 0 {
                vec![]
            } else {
                vec![0]
            },
            mesh,
            polygons: None,
            vertex_group: group,
            vertices_movable: primitive.indices.is_some(),
            corners_turnable: true,
        });
        self.corners.push(match &primitive.indices {
            Some(list) => Corners::Indices(list.records),
            None => Corners::Triples(primitive.vertices.to_vec()),
        });
        Ok(())
    }
}

/// The largest value of an index type restarts a strip; in a triangle list it is not a vertex.
fn check_restart(numbers: &[u32], list: &IndexList, primitive: &Movable) -> Result<(), Problem> {
    let restart = u32::MAX >> (32 - 8 * list.records.size);
    match numbers.contains(&restart) {
        true => Err(malformed(
            primitive.number.pointer(),
            format!(
                "index {restart} restarts a strip and is not a vertex: store the indices in a wider \
                 type"
            ),
        )),
        false => Ok(()),
    }
}

fn check_range(numbers: &[u32], primitive: &Movable) -> Result<(), Problem> {
    let count = primitive.vertex_count;
    match numbers.iter().find(|&&number| number as usize >= count) {
        Some(number) => Err(malformed(
            primitive.number.pointer(),
            match count.checked_sub(1) {
                Some(last) => format!("index {number} is past the last vertex ({last})"),
                None => format!("index {number}, but there are no vertices"),
            },
        )),
        None => Ok(()),
    }
}

/// Why a vertex order cannot renumber this list, if so.
fn list_obstacle(
    list: &IndexList,
    primitive: &Movable,
    buffers: &Buffers,
) -> Option<VertexObstacle> {
    let bytes = &buffers.storages[list.records.storage].bytes;
    let obstacle = |why: &str| {
        Some(VertexObstacle {
            pointer: list.pointer.clone(),
            why: why.to_owned(),
        })
    };

    let is_outline = primitive
        .outline()
        .is_some_and(|outline| outline.records == list.records);
    if is_outline {
        let numbers = patch::numbers(bytes, &list.records);
        let most = u32::MAX >> (32 - 8 * list.records.size);
        if primitive.vertex_count > most as usize {
            return obstacle("the numbers of the outline do not reach all of them");
        }
        if numbers
            .iter()
            .any(|&n| n as usize >= primitive.vertex_count)
        {
            return obstacle("the outline names vertices that are not there");
        }
    }

    // If every vertex is named, the smallest and the largest number stay what they are.
    if list.is_bounded && !names_all(bytes, &list.records, primitive.vertex_count) {
        return obstacle("the JSON states the smallest and largest index, and they would change");
    }
    None
}

fn names_all(bytes: &[u8], records: &StridedRecords, vertex_count: usize) -> bool {
    if records.count < vertex_count {
        return false;
    }
    let mut is_named = vec![false; vertex_count];
    for number in patch::numbers(bytes, records) {
        if let Some(is_named) = is_named.get_mut(number as usize) {
            *is_named = true;
        }
    }
    is_named.into_iter().all(|named| named)
}
