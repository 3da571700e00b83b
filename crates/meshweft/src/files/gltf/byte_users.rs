//! Who reads which bytes: records are moved only if all who read them move alike.
//!
//! Movable primitives are the *users* of records. Records are *taken* where something else reads any
//! of their bytes, and so expects them as they are: animations, images, primitives that stay,
//! accessors that an unknown extension may read, other records that overlap.

use std::collections::BTreeMap;

use super::accessors::{Accessors, COMPRESSED_VIEW, UNSIGNED_BYTE, UNSIGNED_SHORT};
use super::culling;
use super::json::Value;
use super::movable::{Draws, Movable};
use super::object::Object;
use super::primitives::Primitives;
use super::strided_records::StridedRecords;

/// How many pairs of records with overlapping ranges are compared before all records are taken.
///
/// Honest files have a few pairs for each accessor; only a file made to waste time has millions.
const MOST_PAIRS: usize = 1 << 24;

/// What a primitive reads records as.
#[derive(Debug, Clone, Copy)]
pub(super) enum UsedAs {
    Indices,
    Vertices,
    /// Numbers of vertices that are not corners of faces.
    OtherList,
    SparseIndices,
    SparseValues,
}

/// Records of the file and the movable primitives that read them, by their numbers.
#[derive(Debug)]
pub(super) struct UsedRecords {
    pub(super) records: StridedRecords,
    /// The users by [`UsedAs`], rising.
    users: [Vec<usize>; 5],
    /// As values of sparse elements: the list of their numbers.
    value_indices: Option<StridedRecords>,
    /// The pointer to the first thing found that takes it (or why it is taken), if any does.
    pub(super) taken_by: Option<String>,
    /// The pointer to the first that reads it, for the `taken_by` of records that overlap it.
    pointer: String,
}

impl UsedRecords {
    /// The primitives that read it as this.
    pub(super) fn users_as(&self, used_as: UsedAs) -> &[usize] {
        &self.users[used_as as usize]
    }

    /// All users; one that reads it as two things comes twice.
    pub(super) fn users(&self) -> impl Iterator<Item = usize> {
        self.users.iter().flatten().copied()
    }

    /// Whether all users read it as the same thing.
    pub(super) fn has_one_use(&self) -> bool {
        self.users.iter().filter(|users| !users.is_empty()).count() <= 1
    }

    /// Gives each user its new number, and drops those that have none.
    pub(super) fn renumber_users(&mut self, new_number: &[Option<usize>]) {
        for users in &mut self.users {
            *users = users.iter().filter_map(|&user| new_number[user]).collect();
        }
    }

    /// Notes that `by` expects the bytes as they are.
    fn take(&mut self, by: &str) {
        self.taken_by.get_or_insert_with(|| by.to_owned());
    }
}

/// All records that are read, and who reads them.
#[derive(Debug)]
pub(super) struct ByteUsers {
    /// Rising by their records.
    pub(super) used: Vec<UsedRecords>,
}

impl ByteUsers {
    pub(super) fn new(root: &Object, accessors: &Accessors, primitives: &Primitives) -> Self {
        let mut building = Building::default();

        // What movable primitives read, and of that what cannot be moved.
        for (user, primitive) in primitives.movable.iter().enumerate() {
            building.add_primitive(user, primitive);
            let uncommon = primitive.uncommon.iter();
            for &number in uncommon.flat_map(|uncommon| &uncommon.unmoved_sparse) {
                building.take_sparse(accessors, number);
            }
        }

        // What is read by primitives that stay, animations, skins, instances and culling tables.
        for staying in &primitives.staying {
            for &number in &staying.accessors {
                building.take_accessor(accessors, number as usize, &staying.number.pointer());
            }
        }
        let of_tables = culling::accessors_of(root);
        for (number, pointer) in other_users(root).into_iter().chain(of_tables) {
            building.take_accessor(accessors, number, &pointer);
        }

        // An accessor that no primitive names may be one that an unknown extension reads.
        let mut is_named = vec![false; accessors.len()];
        let movable = primitives.movable.iter();
        for &number in movable.flat_map(|primitive| &primitive.accessors) {
            if let Some(is_named) = is_named.get_mut(number as usize) {
                *is_named = true;
            }
        }
        for (number, is_named) in is_named.into_iter().enumerate() {
            if !is_named && !primitives.order_free_accessors.contains(&number) {
                building.take_accessor(accessors, number, &format!("/accessors/{number}"));
            }
        }
        building.take_views(root, accessors);

        // Records that overlap take each other.
        let mut byte_users = Self {
            used: building.used.into_values().collect(),
        };
        byte_users.mark_overlaps();
        byte_users
    }

    /// The number of these records in `used`.
    pub(super) fn find(&self, records: &StridedRecords) -> Option<usize> {
        self.used
            .binary_search_by(|used| used.records.cmp(records))
            .ok()
    }

    /// Makes records that share bytes take each other.
    fn mark_overlaps(&mut self) {
        let mut pairs = 0;
        for first in 0..self.used.len() {
            let records = self.used[first].records;
            for second in first + 1..self.used.len() {
                // They rise by storage and start: once one starts too late, so do the rest.
                let other = self.used[second].records;
                if other.storage != records.storage || other.start >= records.end() {
                    break;
                }

                pairs += 1;
                if pairs > MOST_PAIRS {
                    return self.take_all();
                }
                if records.overlap(&other) {
                    self.take_by_records(first, second);
                    self.take_by_records(second, first);
                }
            }
        }
    }

    fn take_by_records(&mut self, used: usize, other: usize) {
        if self.used[used].taken_by.is_none() {
            self.used[used].taken_by = Some(self.used[other].pointer.clone());
        }
    }

    fn take_all(&mut self) {
        for used in &mut self.used {
            used.take("too many accessors that overlap");
        }
    }
}

/// [`ByteUsers`] while they are collected.
#[derive(Default)]
struct Building {
    used: BTreeMap<StridedRecords, UsedRecords>,
}

impl Building {
    /// The entry of these records; `pointer` is to what reads them, if they are new.
    fn used(&mut self, records: StridedRecords, pointer: &str) -> &mut UsedRecords {
        self.used.entry(records).or_insert_with(|| UsedRecords {
            records,
            users: Default::default(),
            value_indices: None,
            taken_by: None,
            pointer: pointer.to_owned(),
        })
    }

    /// Adds primitive number `user` to all that it reads.
    fn add_primitive(&mut self, user: usize, primitive: &Movable) {
        let pointer = &primitive.number.pointer();
        let mut add = |records, used_as| {
            let used = self.used(records, pointer);
            used.users[used_as as usize].push(user);
        };
        if let Some(list) = &primitive.indices {
            let used_as = match primitive.draws {
                Draws::Faces | Draws::FacesInOrder => UsedAs::Indices,
                Draws::Other(_) => UsedAs::OtherList,
            };
            add(list.records, used_as);
        }
        if let Some(list) = primitive.outline() {
            add(list.records, UsedAs::OtherList);
        }
        for &records in &primitive.vertices {
            add(records, UsedAs::Vertices);
        }

        for sparse in primitive.sparse() {
            add(sparse.indices, UsedAs::SparseIndices);
            add(sparse.values, UsedAs::SparseValues);
        }

        // Values that go with two lists of numbers would have to move in two ways.
        for sparse in primitive.sparse() {
            let values = self.used(sparse.values, pointer);
            if *values.value_indices.get_or_insert(sparse.indices) != sparse.indices {
                values.take(pointer);
            }
        }
    }

    fn take(&mut self, records: StridedRecords, by: &str) {
        self.used(records, by).take(by);
    }

    /// Takes all bytes that an accessor reads.
    fn take_accessor(&mut self, accessors: &Accessors, number: usize, by: &str) {
        // Of one that is not sound, the whole view is taken.
        let resolved = accessors.resolve(number, by);
        match resolved.ok().and_then(|accessor| accessor.records) {
            Some(records) => self.take(records, by),
            None => {
                let view = accessors.value(number).and_then(|a| a.get("bufferView"));
                let view = view.and_then(Value::whole);
                self.take_view(accessors, view, by);
            }
        }
        self.take_sparse(accessors, number);
    }

    /// Takes a whole buffer view, if there is one of this number.
    fn take_view(&mut self, accessors: &Accessors, number: Option<usize>, by: &str) {
        let view = number.and_then(|n| accessors.views().get(n));
        if let Some(records) = view.and_then(|&view| accessors.bytes_of_view(view, 0, None)) {
            self.take(records, by);
        }
    }

    /// Takes the buffer views that are not read through accessors, or not only.
    fn take_views(&mut self, root: &Object, accessors: &Accessors) {
        // Which ones accessors and their sparse parts read.
        let mut is_read = vec![false; accessors.views().len()];
        for number in 0..accessors.len() {
            let Some(accessor) = accessors.value(number) else {
                continue;
            };
            let sparse = accessor.get("sparse");
            let parts = ["indices", "values"].map(|name| sparse.and_then(|s| s.get(name)));
            for reader in [Some(accessor)].into_iter().chain(parts).flatten() {
                let view = reader.get("bufferView").and_then(Value::whole);
                if let Some(is_read) = view.and_then(|view| is_read.get_mut(view)) {
                    *is_read = true;
                }
            }
        }

        // Images.
        for (number, image) in numbered(root.value("images")) {
            let pointer = format!("/images/{number}");
            let view = image.get("bufferView").and_then(Value::whole);
            self.take_view(accessors, view, &pointer);
        }

        // Sources of compressed views; and views that no accessor reads, which an extension may.
        for (number, view) in accessors.views().iter().enumerate() {
            let pointer = format!("/bufferViews/{number}");
            for name in COMPRESSED_VIEW {
                let source = view.get("extensions").and_then(|e| e.get(name));
                let records = source.and_then(|view| accessors.bytes_of_view(view, 0, None));
                if let Some(records) = records {
                    self.take(records, &pointer);
                }
            }
            if !is_read[number] {
                self.take_view(accessors, Some(number), &pointer);
            }
        }
    }

    /// Takes the sparse elements of an accessor, if it has any: their numbers and their values.
    fn take_sparse(&mut self, accessors: &Accessors, number: usize) {
        let accessor = accessors.value(number);
        let Some(sparse) = accessor.and_then(|accessor| accessor.get("sparse")) else {
            return;
        };
        let count = sparse.get("count").and_then(Value::whole);
        let count = count.unwrap_or(usize::MAX);

        // Where a size is not known, the largest: a MAT4 of doubles, an index of four bytes.
        let resolved = accessors.resolve(number, "");
        let value_size = resolved.map_or(128, |accessor| accessor.tight_stride);
        for name in ["indices", "values"] {
            let Some(part) = sparse.get(name) else {
                continue;
            };
            let field = |name: &str| part.get(name).and_then(Value::whole);
            let view = field("bufferView").and_then(|view| accessors.views().get(view));
            let offset = field("byteOffset").unwrap_or(0);
            let size = match name {
                "indices" => index_size(part),
                _ => value_size,
            };
            let length = count.saturating_mul(size);
            let records =
                view.and_then(|&view| accessors.bytes_of_view(view, offset, Some(length)));
            if let Some(records) = records {
                self.take(records, &format!("/accessors/{number}/sparse"));
            }
        }
    }
}

/// How many bytes the number of a sparse element has.
pub(super) fn index_size(indices: Value<'_>) -> usize {
    match indices.get("componentType").and_then(Value::whole) {
        Some(UNSIGNED_BYTE) => 1,
        Some(UNSIGNED_SHORT) => 2,
        _ => 4,
    }
}

/// The accessors that something other than a primitive reads, each with the pointer to that.
fn other_users(root: &Object) -> Vec<(usize, String)> {
    let mut users = Vec::new();
    let mut add = |accessor: Option<Value<'_>>, kind: &str, number: usize| {
        let accessor = accessor.and_then(Value::whole);
        users.extend(accessor.map(|accessor| (accessor, format!("/{kind}/{number}"))));
    };

    for (number, animation) in numbered(root.value("animations")) {
        for (_, sampler) in numbered(animation.get("samplers")) {
            add(sampler.get("input"), "animations", number);
            add(sampler.get("output"), "animations", number);
        }
    }

    for (number, skin) in numbered(root.value("skins")) {
        add(skin.get("inverseBindMatrices"), "skins", number);
    }

    for (number, node) in numbered(root.value("nodes")) {
        let extensions = node.get("extensions");
        let instancing = extensions.and_then(|e| e.get("EXT_mesh_gpu_instancing"));
        let attributes = instancing.and_then(|instancing| instancing.get("attributes"));
        for (_, accessor) in attributes.into_iter().flat_map(Value::members) {
            add(Some(accessor), "nodes", number);
        }
    }
    users
}

/// The elements of an array with their numbers; none if there is no array.
fn numbered(array: Option<Value<'_>>) -> impl Iterator<Item = (usize, Value<'_>)> {
    let elements = array.map(Value::elements);
    elements.into_iter().flatten().enumerate()
}
