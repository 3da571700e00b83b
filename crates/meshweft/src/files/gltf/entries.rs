//! The meshes that a file offers, the records of each, and which vertices may move.

use std::collections::{BTreeMap, BTreeSet};

use super::buffers::Buffers;
use super::byte_users::{ByteUsers, UsedAs};
use super::groups::{group_numbers, vertex_obstacle};
use super::movable::{Draws, IndexList, Movable, PrimitiveNumber};
use super::object::malformed;
use super::objects::objects;
use super::obstacles::VertexObstacle;
use super::patch;
use super::primitives::Primitives;
use super::sparse::Sparse;
use super::strided_records::StridedRecords;
use super::tables::Tables;
use crate::Mesh;
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

/// What one vertex order moves or renumbers.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// Attributes and morph targets.
    pub(super) vertices: Vec<StridedRecords>,
    /// Lists of vertex numbers that are not corners of faces.
    pub(super) other_lists: Vec<StridedRecords>,
    /// Sparse elements, sorted.
    pub(super) sparse: Vec<Sparse>,
    /// The numbers of its meshes.
    pub(super) meshes: Vec<usize>,
}

/// The meshes of a file.
#[derive(Debug, Default)]
pub(super) struct Entries {
    pub(super) meshes: Vec<MeshEntry>,
    /// One for each mesh.
    pub(super) corners: Vec<Corners>,
    pub(super) groups: Vec<Group>,
    /// The first primitive with the faces of each mesh. They rise.
    pub(super) first_primitives: Vec<PrimitiveNumber>,
    /// The other primitives with the faces of a mesh, each with the first.
    pub(super) repeated: BTreeMap<PrimitiveNumber, PrimitiveNumber>,
    /// The clusters in which faces stay.
    pub(super) tables: Tables,
    /// The largest vertex number in each mesh, if it has faces.
    largest_vertex: Vec<Option<u32>>,
    /// For each group whose vertices stay: why, and the first primitive that this was found at.
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
        let mut obstacles = GroupObstacles::new(group_count, byte_users, buffers);
        let mut mesh_of = BTreeMap::new();
        let mut drawn_by: Vec<Vec<u32>> = Vec::new();

        for (primitive, &group) in movable.iter().zip(&group_of) {
            if let Some(corners) = corner_records(primitive) {
                // Its mesh, which is there if an earlier primitive has the same corners.
                let mesh = match mesh_of.get(&corners) {
                    Some(&mesh) => {
                        let first = entries.first_primitives[mesh];
                        entries.repeated.insert(primitive.number, first);
                        mesh
                    }
                    None => {
                        let mesh = entries.meshes.len();
                        let name = primitives.name(primitive.number);
                        entries.add(primitive, name, group, buffers)?;
                        mesh_of.insert(corners, mesh);
                        drawn_by.push(Vec::new());
                        mesh
                    }
                };
                drawn_by[mesh].push(primitive.number.mesh);

                entries.tables.add(mesh, primitive, buffers);

                if primitive.draws == Draws::FacesInOrder {
                    entries.meshes[mesh].faces_movable = false;
                }

                // It may have fewer vertices than the primitive that the mesh was made of.
                let largest = entries.largest_vertex[mesh];
                if largest.is_some_and(|largest| largest as usize >= primitive.vertex_count) {
                    check_range(entries.meshes[mesh].mesh.faces().as_flattened(), primitive)?;
                }
            }

            // What goes with its vertices.
            obstacles.look_at(primitive, group);
            let group = &mut entries.groups[group];
            group.sparse.extend(primitive.sparse());
            let lists = primitive.other_lists().map(|list| list.records);
            group.other_lists.extend(lists);
        }

        for (mesh, runs) in entries.tables.take_runs() {
            let all = &mut entries.meshes[mesh].runs;
            all.extend(runs);
            all.sort_unstable();
            all.dedup();
        }
        entries.add_vertices(byte_users, &group_of);
        let objects = objects(primitives, &drawn_by);
        for (entry, (object, has_other_faces)) in entries.meshes.iter_mut().zip(objects) {
            (entry.object, entry.has_other_faces) = (object, has_other_faces);
        }
        for entry in &mut entries.meshes {
            entry.vertices_movable &= obstacles.found[entry.vertex_group].is_none();
        }
        // Without faces in its group, there is nothing that vertices would move for.
        let found = obstacles.found.into_iter().zip(&entries.groups);
        let found = found.filter(|(_, group)| !group.meshes.is_empty());
        entries.vertex_obstacles = found.filter_map(|(found, _)| found).collect();
        Ok(entries)
    }

    /// The mesh with the faces of a primitive, if that has faces that are in one.
    pub(super) fn mesh_of(&self, number: PrimitiveNumber) -> Option<usize> {
        let first = self.repeated.get(&number).unwrap_or(&number);
        self.first_primitives.binary_search(first).ok()
    }

    /// Gives each group its vertex records, and sorts and joins all that it has.
    fn add_vertices(&mut self, byte_users: &ByteUsers, group_of: &[usize]) {
        // All primitives that read some records are of one group.
        for used in &byte_users.used {
            if let Some(&user) = used.users_as(UsedAs::Vertices).first() {
                self.groups[group_of[user]].vertices.push(used.records);
            }
        }

        for group in &mut self.groups {
            for records in [&mut group.vertices, &mut group.other_lists] {
                records.sort_unstable();
                records.dedup();
            }
            patch::join(&mut group.vertices);
            group.sparse.sort_unstable();
            group.sparse.dedup();
        }
    }

    /// Adds a mesh with the faces of a primitive.
    fn add(
        &mut self,
        primitive: &Movable,
        name: String,
        group: usize,
        buffers: &Buffers,
    ) -> Result<(), Problem> {
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
        let mesh = Mesh::connectivity_only(primitive.vertex_count, faces).map_err(|error| {
            FileErrorKind::Order(error).at(Place::Json(primitive.number.pointer()))
        })?;

        self.first_primitives.push(primitive.number);
        let largest = mesh.faces().as_flattened().iter().max();
        self.largest_vertex.push(largest.copied());
        self.corners.push(match &primitive.indices {
            Some(list) => Corners::Indices(list.records),
            None => Corners::Triples(primitive.vertices.to_vec()),
        });
        self.groups[group].meshes.push(self.meshes.len());
        self.meshes.push(MeshEntry {
            name,
            // All faces are one run.
            runs: match mesh.face_count() {
                0 => vec![],
                _ => vec![0],
            },
            mesh,
            polygons: None,
            vertex_group: group,
            object: 0,
            has_other_faces: false,
            faces_movable: true,
            vertices_movable: primitive.indices.is_some(),
            corners_turnable: true,
            level: None,
        });
        Ok(())
    }
}

/// The records that say which corners the faces of a primitive have: those of its index list or, where
/// each face is three vertices in a row, its first vertex records; `None` if it draws something else.
///
/// These are there, for every primitive has a POSITION; and primitives without indices that share some
/// vertex records share all of them.
pub(super) fn corner_records(primitive: &Movable) -> Option<StridedRecords> {
    match (&primitive.draws, &primitive.indices) {
        (Draws::Other(_), _) => None,
        (_, Some(list)) => Some(list.records),
        (_, None) => primitive.vertices.first().copied(),
    }
}

/// Why the vertices of each group stay, while this is found out.
struct GroupObstacles<'a> {
    byte_users: &'a ByteUsers,
    buffers: &'a Buffers,
    /// How many vertices the first primitive of each group has.
    vertex_counts: Vec<Option<usize>>,
    /// The first obstacle of each group, and the primitive that it was found at.
    found: Vec<Option<(PrimitiveNumber, VertexObstacle)>>,
    /// Index lists that have been looked through, and whether each was bounded.
    seen_lists: BTreeSet<(StridedRecords, bool)>,
}

impl<'a> GroupObstacles<'a> {
    fn new(group_count: usize, byte_users: &'a ByteUsers, buffers: &'a Buffers) -> Self {
        Self {
            byte_users,
            buffers,
            vertex_counts: vec![None; group_count],
            found: vec![None; group_count],
            seen_lists: BTreeSet::new(),
        }
    }

    /// Looks for an obstacle at a primitive, unless its group has one already.
    fn look_at(&mut self, primitive: &Movable, group: usize) {
        let group_count = *self.vertex_counts[group].get_or_insert(primitive.vertex_count);
        if self.found[group].is_some() {
            return;
        }

        // In the data that it shares. Without indices its vertices never move.
        let mut obstacle = None;
        if primitive.indices.is_some() {
            obstacle = vertex_obstacle(primitive, group_count, self.byte_users);
        }

        // In its lists, each looked through once, however many primitives of the group share it.
        if obstacle.is_none() {
            let seen = &mut self.seen_lists;
            obstacle = primitive
                .lists()
                .filter(|list| seen.insert((list.records, list.is_bounded)))
                .find_map(|list| list_obstacle(list, primitive, self.buffers));
        }
        self.found[group] = obstacle.map(|obstacle| (primitive.number, obstacle));
    }
}

/// Refuses the largest value of an index type: it restarts a strip and is not a vertex.
fn check_restart(numbers: &[u32], list: &IndexList, primitive: &Movable) -> Result<(), Problem> {
    let restart = patch::largest_number(&list.records);
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

/// Refuses numbers that are past the last vertex of a primitive.
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
    // If every vertex is named, the smallest and the largest number stay what they are.
    let bytes = &buffers.storages[list.records.storage].bytes;
    let would_change =
        || list.is_bounded && !names_all(bytes, &list.records, primitive.vertex_count);
    unsound_list(list, primitive, buffers).or_else(|| {
        would_change().then(|| VertexObstacle {
            pointer: list.pointer.clone(),
            why: "the JSON states the smallest and largest index, and they would change".into(),
        })
    })
}

/// Why the numbers of this list cannot be changed, if so.
pub(super) fn unsound_list(
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

    // The corners of faces have been checked, and are refused if they are not sound.
    let mut others = primitive.other_lists();
    if others.any(|other| other.records == list.records) {
        let is_outline = |outline: &IndexList| outline.records == list.records;
        let [of, what] = match primitive.outline().is_some_and(is_outline) {
            true => ["of the outline", "the outline"],
            false => [
                "of the lines or strips over them",
                "what draws lines or strips over them",
            ],
        };
        let count = primitive.vertex_count;
        if count > patch::largest_number(&list.records) as usize {
            return obstacle(&format!("the numbers {of} do not reach all of them"));
        }
        let numbers = patch::numbers(bytes, &list.records);
        if numbers.iter().any(|&number| number as usize >= count) {
            return obstacle(&format!("{what} names vertices that are not there"));
        }
    }

    None
}

/// Whether a list names each of the vertices from 0 on.
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
