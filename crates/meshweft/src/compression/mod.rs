//! Meshes as few bytes, decoded in the order in which they are drawn.
//!
//! [`MeshCode`] is a mesh as bytes: its faces as [fans](crate::connectivity::FanCode), and between them the position of each
//! vertex where it is met, by how far it is from completing a parallelogram with the face before. [`MeshDecoder`]
//! takes the bytes as they arrive, and gives vertices and faces that are complete. They come in the order of
//! [minimum-time rendering](crate::connectivity::MinimumTimeRendering): each vertex is sent once, to a buffer of moderate
//! size.
//!
//! On request the order of the source is stored too ([`KeepOrder`]), so that faces and vertices are given back at their places.
//! Faces that were cut from polygons are stored with a bit for each edge that may be a diagonal
//! ([`MeshCode::of_polygons`]), so that polygons come back ([`PolygonOrder`]).
//!
//! [`MeshArchive`] has several with their names: what a `.mwz` file holds.
//!
//! Whatever a mesh is, it comes back: edges with many faces, faces turned over, faces that are there twice or have no
//! area, vertices without faces. Nothing is split or joined. Everything is in whole numbers, but for lossless
//! positions, which are expected by additions of `f32` that are the same everywhere.

mod archive;
#[cfg(test)]
mod damage_tests;
mod decoded_mesh;
mod mesh_code;
mod mesh_decoder;
mod options;
mod polygons;
mod positions;
mod ring;
mod source_order;
#[cfg(test)]
mod test_vectors;
#[cfg(test)]
mod tests;

pub use archive::MeshArchive;
pub use decoded_mesh::DecodedMesh;
pub use mesh_code::{CodeSizes, MeshCode, PolygonCounts};
pub use mesh_decoder::MeshDecoder;
pub use options::{CodeError, CodeOptions, KeepOrder, PositionCoding, Tier};
pub use polygons::PolygonOrder;
pub use source_order::SourceOrder;
