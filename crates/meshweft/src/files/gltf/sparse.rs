//! Sparse accessors: a few elements stored by number, which follow when vertices move.
//!
//! The numbers must rise, so a vertex order renumbers them, sorts them again, and moves their values
//! alike. Both lists keep their place and length.

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
    /// The sparse elements of accessor `number`.
    ///
    /// `Err` says why they cannot be moved.
    pub(super) fn sparse(&self, number: usize, accessor: &Accessor) -> Result<Sparse, String> {
        self.find_sparse(number, accessor, true)
    }

    /// As [`sparse`](Self::sparse), to read them where they are; `Err` says why they cannot be read.
    pub(super) fn sparse_to_read(
        &self,
        number: usize,
        accessor: &Accessor,
    ) -> Result<Sparse, String> {
        self.find_sparse(number, accessor, false)
    }

    fn find_sparse(
        &self,
        number: usize,
        accessor: &Accessor,
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
        if is_to_move && accessor.count > reach as usize {
            return Err("the numbers of its sparse elements do not reach all vertices".into());
        }

        for part in [sparse, indices, values] {
            let names = part.get("extensions").map(Value::members);
            let mut names = names.into_iter().flatten();
            if let Some((name, _)) = names.find(|(name, _)| !self.is_order_free(name)) {
                return Err(format!("the extension {name} on sparse data is not known"));
            }
        }

        let indices = self.part(indices, stored, [width, width]);
        let values = self.part(values, stored, [accessor.size, accessor.tight_stride]);
        let (indices, values) = indices.zip(values).ok_or_else(incomplete)?;
        let is_fixed = [indices, values].map(|part| self.fixed(part.storage).is_some());
        if is_to_move && is_fixed.contains(&true) {
            return Err(incomplete());
        }
        let numbers = patch::numbers(self.bytes(&indices), &indices);
        let is_sound = numbers.is_sorted_by(|a, b| a < b)
            && numbers
                .last()
                .is_none_or(|&last| (last as usize) < accessor.count);
        match is_sound {
            true => Ok(Sparse { indices, values }),
            false => Err("the numbers of its sparse elements do not rise, or reach too far".into()),
        }
    }

    /// `count` elements in the view that a part names, if they are all there: each of `size` bytes,
    /// `stride` bytes after the one before. There may be room at the end of a matrix.
    fn part(
        &self,
        part: Value<'_>,
        count: usize,
        [size, stride]: [usize; 2],
    ) -> Option<StridedRecords> {
        let member = |value: Value<'_>, name: &str| value.get(name).and_then(Value::whole);
        let view = *self.views().get(member(part, "bufferView")?)?;
        let stated = member(view, "byteStride").filter(|&stride| stride != 0);
        if view.get("extensions").is_some() || stated.is_some_and(|stated| stated != stride) {
            return None;
        }
        let offset = member(part, "byteOffset").unwrap_or(0);
        let length = match count.checked_sub(1) {
            Some(last) => last.checked_mul(stride)?.checked_add(size)?,
            None => 0,
        };
        let bytes = self.bytes_of_view(view, offset, Some(length))?;
        (bytes.size == length).then_some(StridedRecords {
            storage: bytes.storage,
            start: bytes.start,
            count,
            stride: if count > 1 { stride } else { size },
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
