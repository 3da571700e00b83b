//! Compact rows (CSR): for each of many things a short list, all lists in one array.

use crate::index::index32;

/// Rows of entries one after the other: where each row starts, and the entries.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Rows<T> {
    /// Row `r` is `entries[starts[r]..starts[r + 1]]`.
    starts: Vec<u32>,
    entries: Vec<T>,
}

impl<T: Copy + Default> Rows<T> {
    /// `row_count` rows, each with its items in the order in which they come.
    ///
    /// The items are gone through twice, to be counted and to be placed.
    ///
    /// # Panics
    /// If an item's row is not below `row_count`.
    ///
    /// # Complexity
    /// Time O(rows + items); 4 bytes a row beside the entries.
    #[inline]
    pub(crate) fn by_counting(
        row_count: usize,
        items: impl Iterator<Item = (u32, T)> + Clone,
    ) -> Self {
        let mut starts = starts(row_count, items.clone().map(|(row, _)| row));
        let mut entries = vec![T::default(); starts[row_count] as usize];
        place(&mut starts, items, &mut entries);
        Self { starts, entries }
    }
}

impl<T> Rows<T> {
    /// No rows yet: [`push`](Self::push) and [`end_row`](Self::end_row) make one after the other.
    pub(crate) fn with_capacity(row_count: usize, entry_count: usize) -> Self {
        let mut starts = Vec::with_capacity(row_count + 1);
        starts.push(0);
        Self {
            starts,
            entries: Vec::with_capacity(entry_count),
        }
    }

    /// Adds an entry to the row that is not ended yet.
    #[inline]
    pub(crate) fn push(&mut self, entry: T) {
        self.entries.push(entry);
    }

    /// Adds entries to the row that is not ended yet.
    #[inline]
    pub(crate) fn extend(&mut self, entries: impl IntoIterator<Item = T>) {
        self.entries.extend(entries);
    }

    /// Ends the row that entries were added to.
    #[inline]
    pub(crate) fn end_row(&mut self) {
        self.starts.push(index32(self.entries.len()));
    }

    /// How many rows there are.
    pub(crate) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The entries of a row.
    #[inline]
    pub(crate) fn row(&self, row: u32) -> &[T] {
        let row = row as usize;
        &self.entries[self.starts[row] as usize..self.starts[row + 1] as usize]
    }

    /// How many entries the rows before this one have; of the number of rows, how many there are.
    #[inline]
    pub(crate) fn start(&self, row: usize) -> usize {
        self.starts[row] as usize
    }

    /// All rows, one after the other, to be changed in place.
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let mut rest = self.entries.as_mut_slice();
        self.starts.windows(2).map(move |ends| {
            let length = (ends[1] - ends[0]) as usize;
            rest.split_off_mut(..length).unwrap_or_default()
        })
    }

    /// Where each row starts, and where the last one ends.
    #[cfg(feature = "metis")]
    pub(crate) fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The entries of all rows.
    pub(crate) fn entries(&self) -> &[T] {
        &self.entries
    }

    /// The entries of all rows, including the open one.
    #[inline]
    pub(crate) fn entries_mut(&mut self) -> &mut [T] {
        &mut self.entries
    }
}

/// Where each row starts if it has one entry for each time that it is named, and where the last
/// one ends.
#[inline]
pub(crate) fn starts(row_count: usize, named: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut starts = vec![0_u32; row_count + 1];
    // Counted one place further, so that sums up to a place are where its row starts.
    let counts = &mut starts[1..];
    named.for_each(|row| counts[row as usize] += 1);
    for row in 0..row_count {
        starts[row + 1] += starts[row];
    }
    starts
}

/// Puts each item into its row, in the order in which they come.
#[inline]
pub(crate) fn place<T>(
    starts: &mut [u32],
    items: impl Iterator<Item = (u32, T)>,
    entries: &mut [T],
) {
    // `starts[r]` walks from the start of row `r` to its end, then all are set back by one row.
    items.for_each(|(row, entry)| {
        let end = &mut starts[row as usize];
        entries[*end as usize] = entry;
        *end += 1;
    });
    let row_count = starts.len() - 1;
    starts.copy_within(0..row_count, 1);
    starts[0] = 0;
}

/// Puts the three items of each face into their rows, whose starts are fields of `slots`: for
/// traversals that keep a vertex's row beside what else they need of it, on one cache line.
///
/// `start` finds the field. Before, it holds where the row *ends*; after, where it starts. Faces come
/// in reverse, so that rows are ascending.
#[inline]
pub(crate) fn place_backwards<S, T>(
    slots: &mut [S],
    start: impl Fn(&mut S) -> &mut u32,
    faces: impl Iterator<Item = [(u32, T); 3]>,
    entries: &mut [T],
) {
    for items in faces {
        for (row, entry) in items {
            let start = start(&mut slots[row as usize]);
            *start -= 1;
            entries[*start as usize] = entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_the_order_of_their_items() {
        let items = [(2, 'a'), (0, 'b'), (2, 'c'), (0, 'd'), (2, 'e')];
        let mut rows = Rows::by_counting(4, items.into_iter());
        assert_eq!(rows.len(), 4);
        assert_eq!(rows.row(0), ['b', 'd']);
        assert_eq!(rows.row(1), [' '; 0]);
        assert_eq!(rows.row(2), ['a', 'c', 'e']);
        assert_eq!(rows.row(3), [' '; 0]);
        assert_eq!(rows.entries(), ['b', 'd', 'a', 'c', 'e']);
        let lengths: Vec<usize> = rows.rows_mut().map(|row| row.len()).collect();
        assert_eq!(lengths, [2, 0, 3, 0]);
    }

    #[test]
    fn rows_made_one_after_the_other_are_the_same() {
        let mut rows = Rows::with_capacity(3, 2);
        rows.push(5);
        rows.end_row();
        rows.end_row();
        rows.extend([7, 8]);
        rows.end_row();
        let items = [(2, 7), (0, 5), (2, 8)];
        assert_eq!(rows, Rows::by_counting(3, items.into_iter()));
    }

    #[test]
    fn rows_filled_backwards_are_ascending() {
        let faces = [[0, 1, 2], [2, 1, 1]];
        // The ends of rows of one, three and two entries.
        let mut slots = [1, 4, 6];
        let mut entries = [9; 6];
        let numbered = (0..2).zip(faces).rev();
        let items = numbered.map(|(face, corners)| corners.map(|corner| (corner, face)));
        place_backwards(&mut slots, |slot| slot, items, &mut entries);
        assert_eq!(slots, [0, 1, 4]);
        assert_eq!(entries, [0, 0, 1, 1, 0, 1]);
    }
}
