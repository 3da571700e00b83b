//! What is coded with each vertex, between the faces.

use crate::bits::Port;

/// Codes something with each vertex, when it is met.
pub(crate) trait VertexCoder {
    /// How many lanes are used beyond that of the faces.
    const LANES: usize;

    /// Codes what belongs to the next vertex: to one of the source for who writes. It lies opposite to the third
    /// of three vertices across the edge of the first and second, as far as that is known. For the first vertex of
    /// all, they are itself.
    fn code(&mut self, port: &mut impl Port, source: u32, near: [u32; 3]);
}

/// Faces only.
impl VertexCoder for () {
    const LANES: usize = 0;

    #[inline]
    fn code(&mut self, _: &mut impl Port, _: u32, _: [u32; 3]) {}
}
