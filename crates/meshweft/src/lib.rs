#![cfg_attr(not(test), warn(clippy::print_stdout))]
//! Put the triangles of a mesh in the order in which a GPU transforms each vertex about once.
//!
//! A GPU keeps the vertices that it transformed last. Drawing a face whose vertices are still kept
//! costs little; any other vertex is fetched and transformed again. On files as they come, each
//! vertex is transformed two to six times; in a good order, hardly more than once.
//!
//! ```
//! use meshweft::{CacheModel, Mesh, cache, order::KCacheReorder, order::vertex_fetch};
//!
//! // Four vertices, two faces; any arrays will do.
//! let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]];
//! let mesh = Mesh::new(&positions, &[[0, 1, 2], [2, 1, 3]])?;
//!
//! let order = KCacheReorder { cache: CacheModel::fifo(16), ..Default::default() }.face_order(&mesh);
//! let mesh = mesh.with_face_order(&order);
//! let mesh = mesh.with_vertex_order(&vertex_fetch(mesh.faces(), mesh.vertex_count()));
//! assert_eq!(cache::acmr(mesh.faces(), CacheModel::fifo(16)), 2.0); // 4 misses, 2 faces
//! # Ok::<(), meshweft::MeshError>(())
//! ```
//!
//! Values go in, values come out: plain arrays, one struct an algorithm whose public fields are
//! named as in its paper, and orders as values ([`FaceOrder`], [`VertexOrder`]) that say which way
//! they are read. Start with [`order::KCacheReorder`]; count with [`cache`]; files are changed in
//! place by `files` (feature `files`).
//!
//! The library is pure Rust, forbids unsafe code, has no dependency by default and gives the same
//! result on every platform.

pub mod cache;
mod error;
mod faces;
#[cfg(feature = "files")]
pub mod files;
mod index;
mod limits;
mod mesh;
pub mod order;
mod parallel;
pub mod partition;
mod permutation;
mod progress;
mod random;
pub mod topology;

pub use cache::CacheModel;
pub use error::MeshError;
pub use faces::Faces;
pub use limits::Limits;
pub use mesh::Mesh;
pub use permutation::{FaceOrder, Permutation, VertexOrder};
pub use progress::{Budget, Progress};
