//! Random orders of what may move in a file, and random damage; the same in each run.

use meshweft::files::MeshEntry;
use meshweft::{FaceOrder, Permutation, VertexOrder};

/// A stream of numbers that look random (xorshift).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % bound.max(1) as u64) as usize
    }

    fn shuffle(&mut self, entries: &mut [u32]) {
        for last in (1..entries.len()).rev() {
            entries.swap(last, self.below(last + 1));
        }
    }

    /// An order of all faces within their runs, corners turned where they may be, that moves nothing where
    /// they must stay; and one of the vertices where they can move.
    pub(crate) fn orders(&mut self, entry: &MeshEntry) -> (FaceOrder, Option<VertexOrder>) {
        let count = entry.record_count();
        let mut new_to_old: Vec<u32> = (0..count as u32).collect();
        if !entry.faces_movable {
            let vertices = self.vertex_order(entry);
            return (FaceOrder::identity(count), vertices);
        }
        let ends = entry.runs.iter().skip(1).map(|&end| end as usize);
        for (&start, end) in entry.runs.iter().zip(ends.chain([count])) {
            self.shuffle(&mut new_to_old[start as usize..end]);
        }
        let rotations = match entry.corners_turnable {
            true => (0..count).map(|_| self.below(3) as u8).collect(),
            false => Vec::new(),
        };
        let faces = FaceOrder::new(Permutation::new(new_to_old).unwrap(), rotations).unwrap();
        (faces, self.vertex_order(entry))
    }

    fn vertex_order(&mut self, entry: &MeshEntry) -> Option<VertexOrder> {
        let mut new_to_old: Vec<u32> = (0..entry.mesh.vertex_count() as u32).collect();
        self.shuffle(&mut new_to_old);
        let vertices = VertexOrder::from(Permutation::new(new_to_old).unwrap());
        entry.vertices_movable.then_some(vertices)
    }

    /// The file with one to three places, each of fewer bytes than `longest`, replaced by a piece.
    pub(crate) fn spoilt(
        &mut self,
        bytes: &[u8],
        pieces: &[impl AsRef<[u8]>],
        longest: usize,
    ) -> Vec<u8> {
        let mut spoilt = bytes.to_vec();
        for _ in 0..=self.below(3) {
            let at = self.below(spoilt.len());
            let end = spoilt.len().min(at + self.below(longest));
            let piece = pieces[self.below(pieces.len())].as_ref();
            spoilt.splice(at..end, piece.iter().copied());
        }
        spoilt
    }
}
