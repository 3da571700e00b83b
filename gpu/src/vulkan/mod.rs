//! As much of Vulkan as a draw into a small picture needs: no window, no extension.
//!
//! [`Gpu`] is a card that is ready; everything that is made on it borrows it, so nothing outlives it.
//! Each type frees what it holds when it is dropped. All unsafe code of this crate is in this folder.

mod buffer;
mod commands;
mod draws;
mod geometry;
mod gpu;
mod image;
mod instance;
mod layout;
mod pipeline;
mod queries;
mod submit;
mod target;

pub use buffer::Buffer;
pub use commands::{Commands, Pass, Stamps};
pub use draws::Draws;
pub use geometry::Geometry;
pub use gpu::Gpu;
pub use instance::{Card, Instance, Kind};
pub use layout::Layout;
pub use pipeline::{Pipeline, Settings};
pub use queries::{Statistics, Timestamps};
pub use target::Target;
