//! The extension `MESHWEFT_culling` of a primitive: clusters of its faces, and the planes that say from where they are
//! seen.
//!
//! Faces stay in their clusters, as in the runs of other formats, so the table stays true; what is out of order in it
//! keeps the primitive as it is. The planes are not looked at before they are asked for.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use super::accessors::{Accessor, Accessors, FLOAT, Shape, UNSIGNED_INT};
use super::buffers::Buffers;
use super::json::Value;
use super::object::Object;
use super::patch;
use super::strided_records::StridedRecords;
use crate::files::error::Problem;
use crate::files::stored_culling::StoredCulling;

pub(super) const NAME: &str = "MESHWEFT_culling";

/// What is said of a primitive whose table cannot be that of its faces, before what is wrong.
const NOT_SOUND: &str = "its MESHWEFT_culling is not sound: ";

/// Why a primitive with such a table stays.
pub(super) fn damage(why: &str) -> String {
    format!("{NOT_SOUND}{why}")
}

/// Whether a primitive stays for such a table.
pub(super) fn is_damage(why: &str) -> bool {
    why.starts_with(NOT_SOUND)
}

/// Planes of a cluster.
const PLANES: usize = 4;

/// A table of a primitive, its numbers still in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Culling {
    center: [f32; 3],
    reach: f32,
    pub(super) starts: StridedRecords,
    planes: StridedRecords,
}

/// Lists of starts that were looked through, each once, and to what they rise: nothing for one that does not.
#[derive(Debug, Default)]
pub(super) struct KnownStarts {
    ends: RefCell<BTreeMap<StridedRecords, Option<u32>>>,
    /// How many numbers were looked at.
    looked_at: Cell<usize>,
}

impl Culling {
    /// The table of a primitive, if it has one, by its number of faces.
    ///
    /// # Errors
    /// Why it cannot be one of these faces.
    pub(super) fn of(
        primitive: &Object,
        accessors: &Accessors,
        face_count: usize,
        known: &KnownStarts,
    ) -> Result<Option<Self>, String> {
        let value = primitive.value("extensions").and_then(|all| all.get(NAME));
        let Some(value) = value.filter(|_| !accessors.is_order_free(NAME)) else {
            return Ok(None);
        };
        let told = |problem: Problem| format!("{}: {}", problem.place, problem.kind);
        let pointer = format!("{}/extensions/{NAME}", primitive.pointer());
        let table = Object::new(value, pointer).map_err(told)?;

        // Two lists of numbers.
        let list = |name: &str, shape: Shape, component: usize| -> Result<_, String> {
            let number = table.required_number(name).map_err(told)?;
            let accessor = accessors
                .resolve(number, &table.pointer_to(name))
                .map_err(told)?;
            records(&accessor, shape, component)
                .ok_or_else(|| format!("{name} is not an accessor of its type, tightly packed, neither sparse nor compressed"))
        };
        let starts = list("starts", Shape::SCALAR, UNSIGNED_INT)?;
        let planes = list("planes", Shape::VEC4, FLOAT)?;
        let is_counted = planes.count % PLANES == 0 && planes.count / PLANES + 1 == starts.count;
        if !is_counted {
            let (planes, clusters) = (planes.count, starts.count.saturating_sub(1));
            return Err(format!(
                "{planes} planes for {clusters} clusters: each needs {PLANES}"
            ));
        }
        if !known.rise_to(starts, face_count, accessors) {
            return Err(format!(
                "starts does not rise from 0 to {face_count}, the number of faces"
            ));
        }

        // The ball.
        let center = table.value("center").filter(|center| center.is_array());
        let center: Option<Vec<f32>> = center.and_then(|all| all.elements().map(number).collect());
        let center = center.and_then(|numbers| numbers.try_into().ok());
        let reach = table.value("reach").and_then(number);
        match center.zip(reach.filter(|&reach| reach >= 0.0)) {
            None => Err("the center or the reach is not a number".to_owned()),
            Some((center, reach)) => Ok(Some(Self {
                center,
                reach,
                starts,
                planes,
            })),
        }
    }

    /// Equal for equal tables.
    pub(super) fn key(&self) -> impl Ord + use<> {
        let [x, y, z] = self.center.map(f32::to_bits);
        (self.starts, self.planes, [x, y, z, self.reach.to_bits()])
    }

    /// The first face of each cluster.
    pub(super) fn runs(&self, buffers: &Buffers) -> Vec<u32> {
        let mut starts = patch::numbers(&buffers.storages[self.starts.storage].bytes, &self.starts);
        starts.pop();
        starts
    }

    /// All of it.
    pub(super) fn stored(&self, buffers: &Buffers) -> StoredCulling {
        let starts = &buffers.storages[self.starts.storage].bytes;
        let plane = |record: &[u8]| {
            let numbers = record.as_chunks::<4>().0;
            let mut plane = [0.0; 4];
            for (to, &bytes) in plane.iter_mut().zip(numbers) {
                *to = f32::from_le_bytes(bytes);
            }
            plane
        };
        let planes: Vec<[f32; 4]> = self.planes.of(buffers).map(plane).collect();
        StoredCulling {
            center: self.center,
            reach: self.reach,
            starts: patch::numbers(starts, &self.starts),
            planes: planes.as_chunks::<PLANES>().0.to_vec(),
        }
    }
}

impl KnownStarts {
    /// Whether starts rise from 0 to a number of faces. No cluster is empty, so that a list is not longer than the faces.
    ///
    /// Lists that overlap could be looked at for the square of what is stored: no more numbers are than there are bytes.
    fn rise_to(&self, starts: StridedRecords, face_count: usize, accessors: &Accessors) -> bool {
        if starts.count > face_count.saturating_add(1) {
            return false;
        }
        let mut ends = self.ends.borrow_mut();
        let end = ends.entry(starts).or_insert_with(|| {
            let looked_at = self.looked_at.get().saturating_add(starts.count);
            self.looked_at.set(looked_at);
            if looked_at > accessors.byte_count() {
                return None;
            }
            let numbers = patch::numbers(accessors.bytes(&starts), &starts);
            let rise =
                numbers.first() == Some(&0) && numbers.windows(2).all(|pair| pair[0] < pair[1]);
            numbers.last().copied().filter(|_| rise)
        });
        end.is_some_and(|end| end as usize == face_count)
    }
}

/// The records of an accessor, if they are stored as such elements and nothing else.
fn records(accessor: &Accessor, shape: Shape, component: usize) -> Option<StridedRecords> {
    let is_other = accessor.is_sparse
        || accessor.is_compressed
        || accessor.is_strided
        || accessor.shape != shape
        || accessor.component != component
        || accessor.unknown_extension.is_some();
    accessor.records.filter(|_| !is_other)
}

/// A finite number.
fn number(value: Value<'_>) -> Option<f32> {
    let number: f32 = value.raw().parse().ok()?;
    number.is_finite().then_some(number)
}

/// The accessors that the tables of all primitives name, each with the pointer to what names it.
pub(super) fn accessors_of(root: &Object) -> impl Iterator<Item = (usize, String)> {
    let meshes = root.value("meshes").into_iter().flat_map(Value::elements);
    (0_usize..).zip(meshes).flat_map(|(mesh, value)| {
        let primitives = value.get("primitives").into_iter();
        let primitives = (0_usize..).zip(primitives.flat_map(Value::elements));
        primitives.flat_map(move |(primitive, value)| {
            let table = value.get("extensions").and_then(|all| all.get(NAME));
            let lists = ["starts", "planes"].map(|name| table?.get(name)?.whole());
            let numbers = lists.into_iter().flatten();
            let pointer = move || format!("/meshes/{mesh}/primitives/{primitive}");
            numbers.map(move |accessor| (accessor, pointer()))
        })
    })
}
