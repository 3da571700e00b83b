//! The vertices in the cache by age. Entries that are out of date are dropped when scanned.

/// A vertex and its stamp, the clock at its push: a vertex may leave and enter again.
pub(in crate::order) type Entry = (u32, u32);

/// The vertices in the cache, oldest first, mixed with entries of vertices that are finished or
/// have left.
pub(in crate::order) struct Queue {
    /// The queue is `entries[head..tail]`; it moves towards the end and is then moved back.
    entries: Vec<Entry>,
    head: usize,
    tail: usize,
}

impl Queue {
    /// An empty queue for at most `size` entries that count.
    pub(in crate::order) fn new(size: u32) -> Self {
        Self {
            // Larger than needed, so that the clean-up when the end is reached is rare.
            entries: vec![(0, 0); 16 * (size as usize + 1)],
            head: 0,
            tail: 0,
        }
    }

    /// All entries, oldest first.
    #[inline]
    pub(in crate::order) fn entries(&self) -> &[Entry] {
        &self.entries[self.head..self.tail]
    }

    /// Appends an entry; at the end of the array, drops those for which `counts` is false, and at
    /// most `size` may be left.
    #[inline]
    pub(in crate::order) fn push(&mut self, entry: Entry, counts: impl Fn(Entry) -> bool) {
        if self.tail == self.entries.len() {
            self.close_gaps(counts);
        }
        self.entries[self.tail] = entry;
        self.tail += 1;
    }

    /// Replaces the first `scanned` entries by `kept`, those of them that count, so that the others
    /// are scanned only once.
    #[inline]
    pub(in crate::order) fn replace_front(&mut self, scanned: usize, kept: &[Entry]) {
        debug_assert!(kept.len() <= scanned && scanned <= self.entries().len());
        self.head += scanned - kept.len();
        if scanned != kept.len() {
            for (entry, &kept) in self.entries[self.head..].iter_mut().zip(kept) {
                *entry = kept;
            }
        }
    }

    /// Moves the entries that count to the front of the array.
    #[cold]
    fn close_gaps(&mut self, counts: impl Fn(Entry) -> bool) {
        let mut end = 0;
        for position in self.head..self.tail {
            let entry = self.entries[position];
            if counts(entry) {
                self.entries[end] = entry;
                end += 1;
            }
        }
        debug_assert!(
            end < self.entries.len(),
            "more entries count than the cache holds"
        );
        self.head = 0;
        self.tail = end;
    }
}
