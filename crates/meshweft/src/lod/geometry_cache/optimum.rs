//! The fewest inserts that a path needs, found by who knows all of it.

use std::collections::BinaryHeap;

use super::recorded_path::RecordedPath;

/// Never again.
const NEVER: u32 = u32::MAX;

impl RecordedPath {
    /// The fewest inserts with which any policy draws the path from these slots; `None` if a frame has more active
    /// vertices.
    ///
    /// L. A. Belady: *A Study of Replacement Algorithms for a Virtual-Storage Computer*, IBM Systems Journal 5 (2),
    /// 1966, doi:10.1147/sj.52.0078. Whoever is not active now and is used again last of all leaves its slot.
    ///
    /// # Complexity
    /// Time O(n log n) for the n changes of the path, space O(n + vertices).
    #[must_use]
    pub fn fewest_inserts(&self, slots: usize) -> Option<u64> {
        if self.most_active() > slots {
            return None;
        }
        let next_uses = self.next_uses();
        let mut next_uses = next_uses.iter().rev();
        let mut is_resident = vec![false; self.vertices()];
        let mut open = BinaryHeap::new();
        let (mut empty, mut inserts) = (slots, 0);
        for (added, removed) in self.frames() {
            let opened = removed.iter().zip(next_uses.by_ref());
            open.extend(opened.map(|(&vertex, &next_use)| (next_use, vertex)));

            // All that comes back is held before anything is evicted.
            let mut missing = 0;
            for &vertex in added {
                let was_resident = std::mem::replace(&mut is_resident[vertex as usize], true);
                missing += usize::from(!was_resident);
            }
            inserts += missing as u64;

            // Entries of vertices that came back have a use that is not to come: they are below those of open slots,
            // of which there are enough.
            let evicted = missing.saturating_sub(empty);
            empty = empty.saturating_sub(missing);
            for _ in 0..evicted {
                if let Some((_, vertex)) = open.pop() {
                    is_resident[vertex as usize] = false;
                }
            }
        }
        Some(inserts)
    }

    /// Of all that is removed, from the last to the first, the frame in which it is active again.
    fn next_uses(&self) -> Vec<u32> {
        let mut next_uses = Vec::new();
        let mut coming = vec![NEVER; self.vertices()];
        let frames = (0..self.frame_count()).rev();
        for (frame, (added, removed)) in frames.zip(self.frames().rev()) {
            let frame = u32::try_from(frame).unwrap_or(NEVER);
            for &vertex in added {
                coming[vertex as usize] = frame;
            }
            next_uses.extend(removed.iter().rev().map(|&vertex| coming[vertex as usize]));
        }
        next_uses
    }
}
