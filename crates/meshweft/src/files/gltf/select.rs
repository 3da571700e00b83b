//! Faces and vertices left out: records move up, what is over leaves the buffers, and the numbers in the
//! text that count or measure it follow. Then the whole is looked at again.

use std::collections::{BTreeMap, BTreeSet};

use super::accessors::{Accessors, COMPRESSED_VIEW};
use super::additions::{Splice, spliced};
use super::buffers::Source;
use super::byte_map::{ByteMap, set};
use super::byte_users::ByteUsers;
use super::container::{BinaryLength, Container};
use super::culling;
use super::entries::{Corners, corner_records, unsound_list};
use super::groups::{self, group_numbers, vertex_obstacle};
use super::leaving::Leaving;
use super::movable::Movable;
use super::object::Object;
use super::obstacles::VertexObstacle;
use super::primitives::Primitives;
use super::strided_records::StridedRecords;
use super::{GltfFile, View, stated_bounds};
use crate::files::edit::check_order;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::note::Note;
use crate::files::select::{PlannedVertices, SelectPlan};
use crate::index::index32;

/// What a plan leaves.
struct Left {
    /// The JSON text; what accessors state of their smallest and largest values is still the old.
    text: Vec<u8>,
    /// The bytes of the storages that change.
    storages: BTreeMap<usize, Vec<u8>>,
    /// The accessors of which elements left or changed.
    accessors: BTreeSet<usize>,
    /// The faces of each mesh, by new vertex numbers, and how many vertices it has.
    meshes: Vec<(Vec<[u32; 3]>, usize)>,
}

/// The bytes that storages had, and whether these had changed.
pub(super) type OldBytes = Vec<(usize, Vec<u8>, bool)>;

impl GltfFile {
    /// See [`Edit::Select`](crate::files::Edit::Select); on an error nothing is changed.
    pub(super) fn select(&mut self, mut plan: SelectPlan) -> Result<Vec<Note>, Problem> {
        // Here everything can be put in its order at once.
        let groups = plan.groups.into_iter();
        plan.groups = groups.map(PlannedVertices::in_order).collect();

        let left = self.left(&plan)?;
        let old = self.exchange(left.storages);
        let done = self.finished(&left.text, &left.accessors, &old);
        let checked = done.and_then(|(container, view, notes)| {
            check_view(&view, &plan, &left.meshes)?;
            Ok((container, view, notes))
        });
        let (container, view, notes) = match checked {
            Ok(checked) => checked,
            Err(problem) => {
                self.take_back(old);
                return Err(problem);
            }
        };
        if let Some(container) = container {
            self.container = container;
        }
        self.view = view;
        Ok(notes)
    }

    /// What the plan leaves.
    fn left(&self, plan: &SelectPlan) -> Result<Left, Problem> {
        let entries = &self.view.entries;
        let json = super::read_json(&self.container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let accessors = Accessors::new(&root, &self.buffers, &self.options.assume_order_safe)?;
        let mut primitives = Primitives::read(&root, &accessors, &self.options)?;
        let mut byte_users = ByteUsers::new(&root, &accessors, &primitives);
        groups::keep_entangled(&mut primitives, &mut byte_users);
        let group_of = group_numbers(&primitives.movable, &byte_users);
        let grouped: Vec<(&Movable, usize)> = primitives.movable.iter().zip(group_of).collect();
        self.check(plan, &root, &grouped, &byte_users)?;

        // The bytes.
        let meshes = (0..entries.meshes.len()).map(|mesh| self.expected(plan, mesh));
        let meshes: Vec<(Vec<[u32; 3]>, usize)> = meshes.collect();
        let group_of: Vec<usize> = grouped.iter().map(|&(_, group)| group).collect();
        let mut leaving = Leaving::new(entries, &self.buffers, &byte_users, &group_of);
        for planned in &plan.groups {
            if self.changes(planned) {
                leaving.vertices(planned, |mesh| plan.mesh(mesh).is_some())?;
            }
        }
        let named = grouped.iter().flat_map(|(primitive, group)| {
            let numbers = primitive.accessors.iter();
            numbers.map(|&number| (number as usize, *group))
        });
        let named: BTreeMap<usize, usize> = named.collect();
        for &number in named.keys() {
            let accessor = accessors.resolve(number, "").ok();
            let accessor = accessor.filter(|accessor| accessor.is_sparse);
            let sparse = accessor.and_then(|a| Some((accessors.sparse(number, &a).ok()?, a)));
            if let Some((sparse, accessor)) = sparse {
                leaving.stand_in(&sparse, accessor.records.as_ref(), &accessor.pointer)?;
            }
        }
        for planned in &plan.meshes {
            let soup: Vec<[u32; 3]>;
            let faces = match entries.corners[planned.mesh] {
                Corners::Indices(_) => &meshes[planned.mesh].0,
                // Its corners are copies of these vertices.
                Corners::Triples(_) => {
                    let faces: Vec<[u32; 3]> =
                        planned.faces(&entries.meshes[planned.mesh]).collect();
                    soup = planned.order.apply(&faces);
                    &soup
                }
            };
            leaving.faces(planned, faces)?;
        }

        // The numbers in the text.
        let opaque = self.opaque_storages(&root, &accessors)?;
        let is_opaque = |storage| opaque.contains(&storage);
        let map = ByteMap::new(&byte_users, &leaving.left, is_opaque);
        let mut splices = map.splices(&root, &self.buffers)?;
        let mut changed = BTreeSet::new();
        for (&number, &group) in &named {
            let vertices = plan.group(group).filter(|planned| self.changes(planned));
            let is_changed = set_counts(number, &accessors, vertices, &leaving, &mut splices);
            if is_changed || vertices.is_some() {
                changed.insert(number);
            }
        }
        splices.sort_by_key(|(span, _)| span.start);
        splices.dedup();

        let storages = leaving.changed.iter();
        let storages = storages.map(|(&storage, bytes)| (storage, map.left_of(storage, bytes)));
        Ok(Left {
            text: spliced(self.json(), &splices),
            storages: storages.collect(),
            accessors: changed,
            meshes,
        })
    }

    /// Whether vertices of a group leave or move; those without indices do with their faces.
    fn changes(&self, planned: &PlannedVertices) -> bool {
        !planned.is_identity() && first_indexed(&self.view, planned.group).is_some()
    }

    /// Whether what leaves can.
    fn check(
        &self,
        plan: &SelectPlan,
        root: &Object,
        grouped: &[(&Movable, usize)],
        byte_users: &ByteUsers,
    ) -> Result<(), Problem> {
        let entries = &self.view.entries;
        for &(primitive, group) in grouped {
            let Some(planned) = plan.group(group).filter(|planned| self.changes(planned)) else {
                continue;
            };
            let count = planned.old_to_new.len();
            let mut lists = primitive.lists();
            let unsound = || lists.find_map(|list| unsound_list(list, primitive, &self.buffers));
            let obstacle = vertex_obstacle(primitive, count, byte_users).or_else(unsound);
            if let Some(VertexObstacle { pointer, why }) = obstacle {
                let text = format!("no vertex can be left out: {why}");
                return Err(FileErrorKind::unsupported(text).at(Place::Json(pointer)));
            }
        }

        // A culling table, or an accessor that reads the faces of all primitives in one piece.
        let planned =
            plan.meshes
                .iter()
                .filter_map(|planned| match &entries.corners[planned.mesh] {
                    Corners::Indices(records) => Some(*records),
                    Corners::Triples(vertices) => vertices.first().copied(),
                });
        let planned: BTreeSet<StridedRecords> = planned.collect();
        let meshes = root.array("meshes")?;
        for (primitive, _) in grouped {
            let is_planned = corner_records(primitive).is_some_and(|r| planned.contains(&r));
            if is_planned && primitive.culling().is_some() {
                let text = format!(
                    "no face can be left out: {} has ranges of them. Start from the file that it was made of, \
                     or remove that extension first",
                    culling::NAME
                );
                let place = Place::Json(primitive.number.pointer());
                return Err(FileErrorKind::unsupported(text).at(place));
            }
            let mesh = meshes
                .get(primitive.number.mesh as usize)
                .filter(|_| is_planned);
            let extensions = mesh.and_then(|mesh| mesh.get("extensions"));
            if extensions.is_some_and(|e| e.get("EXT_mesh_manifold").is_some()) {
                let text = "no face can be left out: EXT_mesh_manifold says that the faces of the mesh are \
                            closed. Remove that extension first";
                let place = Place::Json(primitive.number.pointer());
                return Err(FileErrorKind::unsupported(text).at(place));
            }
        }
        Ok(())
    }

    /// The faces that a mesh then has, by new vertex numbers, and how many vertices.
    fn expected(&self, plan: &SelectPlan, mesh: usize) -> (Vec<[u32; 3]>, usize) {
        let entry = &self.view.entries.meshes[mesh];
        let planned = plan.mesh(mesh);
        if let (Corners::Triples(_), Some(planned)) = (&self.view.entries.corners[mesh], planned) {
            let count = index32(planned.records.len());
            let faces = (0..count).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
            return (faces.collect(), 3 * planned.records.len());
        }
        let mut faces: Vec<[u32; 3]> = match planned {
            Some(planned) => {
                let faces: Vec<[u32; 3]> = planned.faces(entry).collect();
                planned.order.apply(&faces)
            }
            None => entry.mesh.faces().to_vec(),
        };
        let vertices = plan.group(entry.vertex_group);
        let Some(vertices) = vertices.filter(|planned| self.changes(planned)) else {
            return (faces, entry.mesh.vertex_count());
        };
        for vertex in faces.as_flattened_mut() {
            *vertex = vertices.old_to_new[*vertex as usize];
        }
        (faces, vertices.kept.len())
    }

    /// The storages that an extension which is not known may name bytes of.
    fn opaque_storages(
        &self,
        root: &Object,
        accessors: &Accessors<'_>,
    ) -> Result<BTreeSet<usize>, Problem> {
        let mut opaque = BTreeSet::new();
        let views = root.objects("bufferViews")?.map(|view| {
            let view = view?;
            let buffer = view.number("buffer")?;
            Ok((view, buffer))
        });
        let buffers = root.objects("buffers")?.enumerate();
        let buffers = buffers.map(|(number, buffer)| Ok((buffer?, Some(number))));
        for holder in views.chain(buffers) {
            let (holder, buffer) = holder?;
            let is_known =
                |name: &str| COMPRESSED_VIEW.contains(&name) || accessors.is_order_free(name);
            if !holder.extensions()?.iter().all(|name| is_known(name)) {
                opaque.extend(buffer.and_then(|buffer| self.buffers.find(buffer)));
            }
        }
        Ok(opaque)
    }

    /// Gives storages other bytes; those that they had.
    pub(super) fn exchange(&mut self, storages: BTreeMap<usize, Vec<u8>>) -> OldBytes {
        let exchanged = storages.into_iter().map(|(number, bytes)| {
            let storage = &mut self.buffers.storages[number];
            let is_same = storage.bytes == bytes;
            let old = (
                std::mem::replace(&mut storage.bytes, bytes),
                storage.is_changed,
            );
            storage.is_changed |= !is_same;
            (number, old.0, old.1)
        });
        exchanged.collect()
    }

    /// Undoes [`exchange`](Self::exchange).
    pub(super) fn take_back(&mut self, old: OldBytes) {
        for (storage, bytes, was_changed) in old {
            let storage = &mut self.buffers.storages[storage];
            (storage.bytes, storage.is_changed) = (bytes, was_changed);
        }
    }

    /// The file with this text, unless it is the same, with the smallest and largest values of these
    /// accessors; and what a reader sees of it.
    fn finished(
        &self,
        text: &[u8],
        changed: &BTreeSet<usize>,
        old: &OldBytes,
    ) -> Result<(Option<Container>, View, Vec<Note>), Problem> {
        let binary = old.iter().find_map(|(number, bytes, _)| {
            let storage = &self.buffers.storages[*number];
            (storage.source == Source::Binary).then_some(BinaryLength {
                old: Some(bytes.len()),
                new: storage.bytes.len(),
            })
        });

        // The smallest and largest values.
        let container = self.container.with_json(text, binary)?;
        let json = super::read_json(&container, &self.options.limits)?;
        let root = Object::new(json.root(), String::new())?;
        let accessors = Accessors::new(&root, &self.buffers, &self.options.assume_order_safe)?;
        let numbers = changed.iter().copied();
        let mut splices = stated_bounds::splices(&accessors, numbers, &self.buffers)?;
        splices.sort_by_key(|(span, _)| span.start);
        splices.dedup();
        let text = spliced(text, &splices);

        let is_same_length = binary.is_none_or(|binary| binary.old == Some(binary.new));
        if is_same_length && text == self.json() {
            let (view, notes) = self.look_at(&self.container)?;
            return Ok((None, view, notes));
        }
        let container = self.container.with_json(&text, binary)?;
        let (view, notes) = self.look_at(&container)?;
        Ok((Some(container), view, notes))
    }
}

/// A mesh of a group, if its vertices are named by indices.
fn first_indexed(view: &View, group: usize) -> Option<usize> {
    let entries = &view.entries;
    let &mesh = entries.groups[group].meshes.first()?;
    matches!(entries.corners[mesh], Corners::Indices(_)).then_some(mesh)
}

/// Gives an accessor, and its sparse elements, the number of elements that are left; whether some left.
/// `vertices` are those of its group, if some leave.
fn set_counts(
    number: usize,
    accessors: &Accessors<'_>,
    vertices: Option<&PlannedVertices>,
    leaving: &Leaving<'_>,
    splices: &mut Vec<Splice>,
) -> bool {
    let (Ok(accessor), Some(value)) = (accessors.resolve(number, ""), accessors.value(number))
    else {
        return false;
    };
    let count = match &accessor.records {
        Some(records) => leaving.left_of(records),
        // Zeros, one for each vertex.
        None => vertices.map(|planned| planned.kept.len()),
    };
    if let Some(count) = count {
        set(value, "count", count, splices);
    }

    let sparse = accessor
        .is_sparse
        .then(|| accessors.sparse(number, &accessor).ok());
    let stored = sparse
        .flatten()
        .and_then(|sparse| leaving.left_of(&sparse.indices));
    if let (Some(count), Some(sparse)) = (stored, value.get("sparse")) {
        set(sparse, "count", count, splices);
    }
    count.is_some() || stored.is_some()
}

/// Whether a reader sees what was planned, and the faces may be in this order.
fn check_view(
    view: &View,
    plan: &SelectPlan,
    expected: &[(Vec<[u32; 3]>, usize)],
) -> Result<(), Problem> {
    let found = &view.entries.meshes;
    let mut pairs = found.iter().zip(expected);
    let is_found = pairs.all(|(entry, (faces, count))| {
        entry.mesh.faces() == faces && entry.mesh.vertex_count() == *count
    });
    if !is_found || found.len() != expected.len() {
        let text =
            "what is left would be read in another way: meshes of this file share their data";
        return Err(FileErrorKind::unsupported(text).at(Place::File));
    }

    let at_file = |kind: FileErrorKind| kind.at(Place::File);
    for planned in &plan.meshes {
        check_order(&found[planned.mesh], Some(&planned.order), None).map_err(at_file)?;
    }
    Ok(())
}
