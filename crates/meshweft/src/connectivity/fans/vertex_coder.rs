//! What is coded with each vertex, between the faces.

use super::model::Port;

/// Codes something with each vertex, when it is met.
pub(crate) trait VertexCoder {
    /// Whether nothing is coded.
    const IS_NOTHING: bool;

    /// Codes what belongs to the next vertex: to one of the source for who writes. It lies opposite to the third
    /// of three vertices across the edge of the first and second, as far as that is known. For the first vertex of
    /// all, they are itself.
    fn code(&mut self, port: &mut impl Port, source: u32, near: [u32; 3]);
}

/// Faces only.
impl VertexCoder for () {
    const IS_NOTHING: bool = true;

    #[inline]
    fn code(&mut self, _: &mut impl Port, _: u32, _: [u32; 3]) {}
}
