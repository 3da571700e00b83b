//! Bytes that leave a storage, and where the others stand then.

use std::collections::BTreeMap;
use std::ops::Range;

use super::accessors::COMPRESSED_VIEW;
use super::additions::Splice;
use super::buffers::Buffers;
use super::byte_users::ByteUsers;
use super::json::Value;
use super::object::Object;
use super::strided_records::StridedRecords;
use crate::files::error::Problem;

/// Everything that stays keeps its place modulo this, so that it stays aligned.
const ALIGNMENT: usize = 8;

/// The bytes that leave, for each storage that has some, rising.
#[derive(Debug, Default)]
pub(super) struct ByteMap {
    removed: BTreeMap<usize, Vec<Removed>>,
}

/// Bytes that leave in one piece.
#[derive(Debug)]
struct Removed {
    bytes: Range<usize>,
    /// How many leave before them.
    before: usize,
}

impl ByteMap {
    /// What leaves with records of which only the first few are left: `left` has how many, of those that
    /// `byte_users` lists. Bytes between other records, or of a storage that `is_opaque`, stay.
    ///
    /// # Complexity
    /// Time O(n log n) in the records.
    pub(super) fn new(
        byte_users: &ByteUsers,
        left: &BTreeMap<usize, usize>,
        is_opaque: impl Fn(usize) -> bool,
    ) -> Self {
        let mut kept: Vec<(usize, Range<usize>)> = Vec::new();
        let mut tails: Vec<(usize, Range<usize>)> = Vec::new();
        for (number, used) in byte_users.used.iter().enumerate() {
            let StridedRecords {
                storage,
                start,
                count,
                stride,
                ..
            } = used.records;
            let records = StridedRecords {
                count: left.get(&number).map_or(count, |&left| left.min(count)),
                ..used.records
            };
            kept.push((storage, start..records.end()));
            if records.count < count {
                let tail = start + records.count * stride..used.records.end();
                tails.push((storage, tail));
            }
        }
        let (kept, tails) = (united(kept), united(tails));

        let mut map = Self::default();
        for (storage, mut tail) in tails {
            let after = kept.partition_point(|(s, k)| (*s, k.end) <= (storage, tail.start));
            let is_between = kept
                .get(after)
                .is_some_and(|(s, k)| *s == storage && k.start < tail.end);
            // What is over stays, before what leaves.
            tail.start += tail.len() % ALIGNMENT;
            if !is_between && !is_opaque(storage) && !tail.is_empty() {
                map.remove(storage, tail);
            }
        }
        map
    }

    /// Adds bytes that leave, behind all others of their storage.
    fn remove(&mut self, storage: usize, bytes: Range<usize>) {
        let removed = self.removed.entry(storage).or_default();
        let before = removed
            .last()
            .map_or(0, |last| last.before + last.bytes.len());
        removed.push(Removed { bytes, before });
    }

    /// The bytes of a storage without those that leave.
    pub(super) fn left_of(&self, storage: usize, bytes: &[u8]) -> Vec<u8> {
        let mut left = Vec::with_capacity(bytes.len());
        let mut copied = 0;
        for Removed { bytes: removed, .. } in self.of(storage) {
            left.extend_from_slice(&bytes[copied..removed.start]);
            copied = removed.end;
        }
        left.extend_from_slice(&bytes[copied..]);
        left
    }

    fn of(&self, storage: usize) -> &[Removed] {
        self.removed.get(&storage).map_or(&[], Vec::as_slice)
    }

    /// Where what stands at `at` of a storage stands afterwards.
    fn new_place(&self, storage: usize, at: usize) -> usize {
        let removed = self.of(storage);
        let before = removed.partition_point(|removed| removed.bytes.start < at);
        match removed[..before].last() {
            Some(last) => at - last.before - (last.bytes.end.min(at) - last.bytes.start),
            None => at,
        }
    }

    /// The new offsets and lengths of everything that stands in a storage from which bytes leave.
    pub(super) fn splices(&self, root: &Object, buffers: &Buffers) -> Result<Vec<Splice>, Problem> {
        let mut splices = Vec::new();
        for (number, buffer) in root.array("buffers")?.into_iter().enumerate() {
            if let (Some(storage), Some(length)) =
                (buffers.find(number), whole(buffer, "byteLength"))
            {
                let new = self.new_place(storage, length);
                set(buffer, "byteLength", new, &mut splices);
            }
        }

        // Views, and those that they were compressed from.
        let views = root.array("bufferViews")?;
        for &view in &views {
            let sources = COMPRESSED_VIEW.map(|name| view.get("extensions")?.get(name));
            for view in [view].into_iter().chain(sources.into_iter().flatten()) {
                let Some(place) = ViewPlace::of(view, buffers) else {
                    continue;
                };
                let [start, end] =
                    [place.start, place.end].map(|at| self.new_place(place.storage, at));
                set(view, "byteOffset", start, &mut splices);
                set(view, "byteLength", end - start, &mut splices);
            }
        }

        // What stands in a view.
        for accessor in root.array("accessors")? {
            let sparse = accessor.get("sparse");
            let parts = ["indices", "values"].map(|name| sparse?.get(name));
            for part in [accessor].into_iter().chain(parts.into_iter().flatten()) {
                let view = whole(part, "bufferView").and_then(|view| views.get(view));
                let place = view.and_then(|&view| ViewPlace::of(view, buffers));
                let offset = whole(part, "byteOffset").unwrap_or(0);
                let Some(place) = place.filter(|place| offset <= place.end - place.start) else {
                    continue;
                };
                let new = |at| self.new_place(place.storage, at);
                let offset = new(place.start + offset) - new(place.start);
                set(part, "byteOffset", offset, &mut splices);
            }
        }
        Ok(splices)
    }
}

/// Where a buffer view stands.
struct ViewPlace {
    storage: usize,
    start: usize,
    end: usize,
}

impl ViewPlace {
    /// `None` if it has no bytes here.
    fn of(view: Value<'_>, buffers: &Buffers) -> Option<Self> {
        let storage = buffers.find(whole(view, "buffer")?)?;
        let start = whole(view, "byteOffset").unwrap_or(0);
        let end = start.checked_add(whole(view, "byteLength")?)?;
        Some(Self {
            storage,
            start,
            end,
        })
    }
}

fn whole(object: Value<'_>, name: &str) -> Option<usize> {
    object.get(name).and_then(Value::whole)
}

/// Gives a member another number; one that is not there stays what it is without it.
pub(super) fn set(object: Value<'_>, name: &str, new: usize, splices: &mut Vec<Splice>) {
    if let Some(value) = object.get(name).filter(|value| value.whole() != Some(new)) {
        splices.push((value.span(), new.to_string()));
    }
}

/// Ranges joined where they overlap or touch, rising.
fn united(mut ranges: Vec<(usize, Range<usize>)>) -> Vec<(usize, Range<usize>)> {
    ranges.retain(|(_, range)| !range.is_empty());
    ranges.sort_unstable_by_key(|(storage, range)| (*storage, range.start));
    let mut united: Vec<(usize, Range<usize>)> = Vec::new();
    for (storage, range) in ranges {
        match united.last_mut() {
            Some((other, last)) if *other == storage && range.start <= last.end => {
                last.end = last.end.max(range.end);
            }
            _ => united.push((storage, range)),
        }
    }
    united
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_touch_are_one() {
        let ranges = vec![
            (1, 4..8),
            (0, 5..9),
            (0, 2..5),
            (0, 3..4),
            (0, 9..9),
            (0, 10..12),
        ];
        assert_eq!(united(ranges), [(0, 2..9), (0, 10..12), (1, 4..8)]);
    }

    #[test]
    fn what_stays_moves_up() {
        let mut map = ByteMap::default();
        map.remove(3, 8..16);
        map.remove(3, 24..40);
        let bytes: Vec<u8> = (0..48).collect();
        let left = map.left_of(3, &bytes);
        assert_eq!(left.len(), 24);
        for at in [0, 7, 16, 23, 40, 47] {
            assert_eq!(usize::from(left[map.new_place(3, at)]), at);
        }
        assert_eq!(map.new_place(3, 48), 24);
        assert_eq!(map.left_of(2, &bytes), bytes);
    }
}
