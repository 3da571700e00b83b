//! How much a reader accepts before it refuses.

/// The largest number of faces: three indices each must be countable in 32 bits.
pub(crate) const MAX_FACES: usize = (u32::MAX / 3) as usize;

/// The largest number of vertices: every index and the count itself fit in 32 bits.
pub(crate) const MAX_VERTICES: usize = u32::MAX as usize;

/// What a reader accepts from bytes that nobody vouches for.
///
/// A count in a file is compared with the bytes that are there *before* anything is allocated, so
/// the limits are a second fence: they bound honest but huge input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limits {
    /// Largest file, in bytes after decompression.
    pub file_bytes: u64,
    /// Most vertices in one mesh.
    pub vertices: usize,
    /// Most faces in one mesh, polygons cut into triangles.
    pub faces: usize,
    /// Most levels of objects, arrays or nodes inside each other.
    pub nesting: usize,
}

impl Default for Limits {
    /// 8 GiB a file, as many vertices and faces as 32-bit indices can count, 256 levels.
    fn default() -> Self {
        Self {
            file_bytes: 8 << 30,
            vertices: MAX_VERTICES,
            faces: MAX_FACES,
            nesting: 256,
        }
    }
}

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
