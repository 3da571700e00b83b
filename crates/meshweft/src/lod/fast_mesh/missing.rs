//! Which points of a hierarchy have not been read yet.

/// How many points a block has.
pub(super) const BLOCK_POINTS: u32 = 64;

/// Blocks of points that may leave, from the first such point on.
#[derive(Debug, Clone, Default)]
pub(super) struct MissingBlocks {
    first_point: u32,
    /// Of each block the largest error in it, or `None` once it was read; empty if everything is there.
    largest_errors: Vec<Option<f32>>,
}

impl MissingBlocks {
    /// All blocks are missing.
    pub(super) fn new(first_point: u32, largest_errors: impl Iterator<Item = f32>) -> Self {
        Self {
            first_point,
            largest_errors: largest_errors.map(Some).collect(),
        }
    }

    /// The block of a point.
    pub(super) fn block_of(&self, point: u32) -> usize {
        ((point - self.first_point) / BLOCK_POINTS) as usize
    }

    /// The largest error in the block of a point that may leave, if it was not read yet.
    #[inline]
    pub(super) fn largest_error(&self, point: u32) -> Option<f32> {
        if self.largest_errors.is_empty() {
            return None;
        }
        self.largest_errors[self.block_of(point)]
    }

    /// A block was read.
    pub(super) fn read(&mut self, block: usize) {
        self.largest_errors[block] = None;
    }
}
