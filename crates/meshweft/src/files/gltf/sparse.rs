//! Sparse accessors: a few elements stored by number, which follow when vertices move.
//!
//! The numbers must rise, so a vertex order renumbers them, sorts them again, and moves their values
//! alike. Both lists keep their place and length.

use super::accessors::{Accessors, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT};
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
    /// The sparse elements of accessor `number`, which has `count` elements of `size` bytes.
    ///
    /// `Err` says why they cannot be moved.
    pub(super) fn sparse(
        &self,
        number: usize,
        count: usize,
        size: usize,
    ) -> Result<Sparse, String> {
        self.find_sparse(number, count, size, true)
    }

    /// As [`sparse`](Self::sparse), to read them where they are; `Err` says why they cannot be read.
    pub(super) fn sparse_to_read(
        &self,
        number: usize,
        count: usize,
        size: usize,
    ) -> Result<Sparse, String> {
        self.find_sparse(number, count, size, false)
    }

    fn find_sparse(
        &self,
        number: usize,
        count: usize,
        size: usize,
        is_to_move: bool,
    ) -> Result<Sparse, String> {
        let incomplete = || "its sparse data is not complete".to_owned();
        let sparse = self.value(number).and_then(|a| a.get("sparse"));
        let sparse = sparse.ok_or_else(incomplete)?;
        let member = |value: Value<'_>, name: &str| value.get(name).and_then(Value::whole);
        let stored = member(sparse, "count").ok_or_else(incomplete)?;
        let [indices, values] = ["indices", "values"].map(|name| sparse.get(name));
        let (indices, values) = indices.zip(values).ok_or_else(incomplete)?;

        let width = match member(indices, "componentType") {
            Some(UNSIGNED_BYTE) => 1,
            Some(UNSIGNED_SHORT) => 2,
            Some(UNSIGNED_INT) => 4,
            _ => return Err(incomplete()),
        };
        let reach = u32::MAX >> (32 - 8 * width);
        if is_to_move && count > reach as usize {
            return Err("the numbers of its sparse elements do not reach all vertices".into());
        }

        for part in [sparse, indices, values] {
            let names = part.get("extensions").map(Value::members);
            let mut names = names.into_iter().flatten();
            if let Some((name, _)) = names.find(|(name, _)| !self.is_order_free(name)) {
                return Err(format!("the extension {name} on sparse data is not known"));
            }
        }

        let indices = self.part(indices, stored, width).ok_or_else(incomplete)?;
        let values = self.part(values, stored, size).ok_or_else(incomplete)?;
        let is_fixed = [indices, values].map(|part| self.fixed(part.storage).is_some());
        if is_to_move && is_fixed.contains(&true) {
            return Err(incomplete());
        }
        let numbers = patch::numbers(self.bytes(&indices), &indices);
        let is_sound = numbers.is_sorted_by(|a, b| a < b)
            && numbers.last().is_none_or(|&last| (last as usize) < count);
        match is_sound {
            true => Ok(Sparse { indices, values }),
            false => Err("the numbers of its sparse elements do not rise, or reach too far".into()),
        }
    }

    /// `count` tight elements of `size` bytes in the view that a part names, if they are all there.
    fn part(&self, part: Value<'_>, count: usize, size: usize) -> Option<StridedRecords> {
        let member = |value: Value<'_>, name: &str| value.get(name).and_then(Value::whole);
        let view = *self.views().get(member(part, "bufferView")?)?;
        let stride = member(view, "byteStride").filter(|&stride| stride != 0);
        if view.get("extensions").is_some() || stride.is_some_and(|stride| stride != size) {
            return None;
        }
        let offset = member(part, "byteOffset").unwrap_or(0);
        let length = count.checked_mul(size)?;
        let bytes = self.bytes_of_view(view, offset, Some(length))?;
        (bytes.size == length).then_some(StridedRecords {
            storage: bytes.storage,
            start: bytes.start,
            count,
            stride: size,
            size,
        })
    }
}

/// Renumbers the sparse elements of a group as its vertices were moved. `all` is sorted, so that
/// those that share their numbers stand together.
pub(super) fn renumber(buffers: &mut Buffers, all: &[Sparse], old_to_new: &[u32]) {
    for shared in all.chunk_by(|a, b| a.indices == b.indices) {
        let indices = shared[0].indices;
        let bytes = buffers.bytes_to_change(indices.storage);
        let numbers = patch::numbers(bytes, &indices);
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
