//! Sparse accessors: a few elements stored by number, which follow when vertices move.
//!
//! glTF wants the numbers to rise, so a vertex order renumbers them, sorts them again, and moves the
//! values in the same way. Both lists keep their place and length.

use super::accessors::{Accessor, Accessors, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT};
use super::buffers::Buffers;
use super::json::Value;
use super::patch;
use super::strided_records::StridedRecords;
use crate::index::index32;

/// Elements stored by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Sparse {
    /// The numbers of the elements, rising.
    pub(super) indices: StridedRecords,
    /// Their values.
    pub(super) values: StridedRecords,
}

impl Accessors<'_> {
    /// The sparse elements of accessor `number`, to be moved; `Err` says why they cannot be.
    pub(super) fn sparse(&self, number: usize, accessor: &Accessor) -> Result<Sparse, String> {
        let sparse = self.sparse_to_read(number, accessor)?;
        if accessor.count > patch::largest_number(&sparse.indices) as usize {
            return Err("the numbers of its sparse elements do not reach all vertices".into());
        }
        let mut parts = [sparse.indices, sparse.values].into_iter();
        match parts.find_map(|part| self.fixed(part.storage)) {
            Some(why) => Err(why.to_owned()),
            None => Ok(sparse),
        }
    }

    /// The sparse elements of accessor `number`, to be read where they are; `Err` says why they
    /// cannot be.
    pub(super) fn sparse_to_read(
        &self,
        number: usize,
        accessor: &Accessor,
    ) -> Result<Sparse, String> {
        let incomplete = || "its sparse data is not complete".to_owned();
        let sparse = self.value(number).and_then(|a| a.get("sparse"));
        let sparse = sparse.ok_or_else(incomplete)?;
        let stored = member(sparse, "count").ok_or_else(incomplete)?;
        let [indices, values] = ["indices", "values"].map(|name| sparse.get(name));
        let (indices, values) = indices.zip(values).ok_or_else(incomplete)?;

        for part in [sparse, indices, values] {
            let names = part.get("extensions").map(Value::members);
            let mut names = names.into_iter().flatten();
            if let Some((name, _)) = names.find(|(name, _)| !self.is_order_free(name)) {
                return Err(format!("the extension {name} on sparse data is not known"));
            }
        }

        // Where both lists stand.
        let width = match member(indices, "componentType") {
            Some(UNSIGNED_BYTE) => 1,
            Some(UNSIGNED_SHORT) => 2,
            Some(UNSIGNED_INT) => 4,
            _ => return Err(incomplete()),
        };
        let indices = self.part(indices, stored, [width, width]);
        let values = self.part(values, stored, [accessor.size, accessor.tight_stride]);
        let (indices, values) = indices.zip(values).ok_or_else(incomplete)?;

        let numbers = patch::numbers(self.bytes(&indices), &indices);
        let last = numbers.last().map(|&last| last as usize);
        let is_sound =
            numbers.is_sorted_by(|a, b| a < b) && last.is_none_or(|last| last < accessor.count);
        match is_sound {
            true => Ok(Sparse { indices, values }),
            false => Err("the numbers of its sparse elements do not rise, or reach too far".into()),
        }
    }

    /// The `count` elements of `indices` or `values`, if all are there and nothing says that they stand
    /// otherwise than tight: each of `size` bytes, `stride` bytes after the one before (more than
    /// `size` where the last column of a matrix is padded).
    fn part(
        &self,
        part: Value<'_>,
        count: usize,
        [size, stride]: [usize; 2],
    ) -> Option<StridedRecords> {
        let view = *self.views().get(member(part, "bufferView")?)?;
        let stated = member(view, "byteStride").filter(|&stride| stride != 0);
        if view.get("extensions").is_some() || stated.is_some_and(|stated| stated != stride) {
            return None;
        }

        let offset = member(part, "byteOffset").unwrap_or(0);
        let length = StridedRecords::length(count, stride, size)?;
        let bytes = self.bytes_of_view(view, offset, Some(length))?;
        let records = StridedRecords::new(bytes.storage, bytes.start, count, stride, size);
        (bytes.size == length).then_some(records)
    }
}

/// The whole number that a member of an object has.
fn member(object: Value<'_>, name: &str) -> Option<usize> {
    object.get(name).and_then(Value::whole)
}

/// Renumbers and sorts the sparse elements of a group after its vertices moved.
///
/// `all` is sorted, so that those that share their list of numbers stand together: the list is
/// rewritten once, and all their values follow.
pub(super) fn renumber(buffers: &mut Buffers, all: &[Sparse], old_to_new: &[u32]) {
    debug_assert!(all.is_sorted());
    for shared in all.chunk_by(|a, b| a.indices == b.indices) {
        let indices = shared[0].indices;
        let bytes = buffers.bytes_to_change(indices.storage);
        let numbers = patch::numbers(bytes, &indices);

        // Renumber the list, and sort it again.
        let renumbered = |place: &u32| old_to_new[numbers[*place as usize] as usize];
        let mut order: Vec<u32> = (0..index32(numbers.len())).collect();
        order.sort_unstable_by_key(renumbered);
        patch::write_numbers(bytes, &indices, order.iter().map(renumbered));

        for sparse in shared {
            let bytes = buffers.bytes_to_change(sparse.values.storage);
            patch::permute(bytes, &sparse.values, &order);
        }
    }
}
