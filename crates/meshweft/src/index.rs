//! Numbers of faces and vertices in 32 bits.

/// The largest number of faces: three indices each must be countable in 32 bits.
pub(crate) const MAX_FACES: usize = (u32::MAX / 3) as usize;

/// The largest number of vertices: every index and the count itself fit in 32 bits.
pub(crate) const MAX_VERTICES: usize = u32::MAX as usize;

/// `n` as a 32-bit index; callers have checked the count against [`MAX_FACES`] or [`MAX_VERTICES`].
#[expect(
    clippy::cast_possible_truncation,
    reason = "counts are checked when a mesh or permutation is made"
)]
#[inline]
pub(crate) fn index32(n: usize) -> u32 {
    debug_assert!(n <= MAX_VERTICES);
    n as u32
}

/// Vertices in a block: as many as 16 bits count.
pub(crate) const BLOCK: usize = 1 << 16;

/// The block of 65,536 vertices that a vertex stands in, by its number.
#[inline]
pub(crate) const fn block_of(vertex: u32) -> u32 {
    vertex >> 16
}
