#![cfg_attr(not(test), warn(clippy::print_stdout))]
//! Put the triangles of a mesh in the order in which a GPU transforms each vertex about once.
//!
//! A GPU keeps the vertices that it transformed last. Drawing a face whose vertices are still kept
//! costs little; any other vertex is fetched and transformed again. On files as they come, each
//! vertex is transformed two to six times; in a good order, hardly more than once.
//!
//! ```
//! use meshweft::operations::{IndexOptions, optimize_indices};
//! use meshweft::{CacheModel, cache};
//!
//! // Flat indices, three a face, 32 or 16 bits: put in place in a better order.
//! let mut indices: [u16; 6] = [0, 1, 2, 2, 1, 3];
//! let orders = optimize_indices(&mut indices, 4, &IndexOptions::default())?;
//! assert!(orders.faces.is_identity()); // Two faces cannot be ordered any better.
//!
//! let faces = [[0, 1, 2], [2, 1, 3]];
//! assert_eq!(cache::acmr(&faces, CacheModel::fifo(16)), 2.0); // 4 misses, 2 faces
//! # Ok::<(), meshweft::MeshError>(())
//! ```
//!
//! A file, every other byte kept (feature `files`):
//!
//! ```no_run
//! # #[cfg(feature = "files")]
//! # fn order() -> Result<(), Box<dyn std::error::Error>> {
//! use meshweft::files::{Document, ReadOptions};
//! use meshweft::operations::{Options, optimize};
//!
//! let mut document = Document::open("scene.glb".as_ref(), ReadOptions::default())?;
//! let report = optimize(&mut document, &Options::default(), &())?;
//! document.write("ordered.glb".as_ref())?;
//! # Ok(())
//! # }
//! ```
//!
//! Values go in, values come out: plain arrays, one struct an algorithm whose public fields are
//! named as in its paper, and orders as values ([`FaceOrder`], [`VertexOrder`]) that say which way
//! they are read. Whatever takes faces takes a [`Mesh`], a slice of triples, or [`Faces`], checked
//! once. Start with [`operations`]; algorithms one by one are in [`order`], counts in [`cache`]; files
//! are changed in place by `files` (feature `files`).
//!
//! The library is pure Rust, forbids unsafe code, has no dependency by default and gives the same
//! result on every platform.

pub mod attribute;
pub mod bits;
pub mod cache;
pub mod compression;
pub mod connectivity;
pub mod culling;
mod error;
mod faces;
#[cfg(feature = "files")]
pub mod files;
mod first_use;
pub mod geometry;
mod height_grid;
mod index;
mod limits;
pub mod lod;
mod mesh;
pub mod operations;
pub mod order;
mod parallel;
pub mod partition;
mod permutation;
mod progress;
pub mod progressive;
mod random;
pub mod topology;

pub use cache::CacheModel;
pub use error::MeshError;
pub use faces::Faces;
pub use height_grid::{HeightGrid, HeightGridError};
pub use limits::Limits;
pub use mesh::Mesh;
pub use permutation::{FaceOrder, Permutation, VertexOrder};
pub use progress::{Budget, Progress};
