//! How much a reader accepts before it refuses.

use crate::index::{MAX_FACES, MAX_VERTICES};

/// What a reader accepts from untrusted bytes.
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
