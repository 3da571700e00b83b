//! Connectivity as few bits, in the order in which each vertex is sent once.
//!
//! Gang Lin, Wenji Zhang: *Joint Connectivity Compression and Mesh Rendering*.
//!
//! Vertices are numbered as they are met: each in turn is the *root*, and brings in those of its neighbours
//! that were not met before, as they come around it ([`TrimmedLists`]). Most faces then follow from the numbers: two
//! neighbours in a list and their root are nearly always a face. [`TrimmedListCode`] has the paper's bits for
//! that, and the faces that are left.
//!
//! Faces come out in the order of their least vertices, and a vertex is not needed any more once it was the
//! root. So a first-in first-out buffer of moderate size takes each vertex once ([`MinimumTimeRendering`]).
//! How large it must be depends on the vertex with which the traversal begins ([`FirstVertex`]).
//!
//! That order goes around in rings, which small caches do not hold. [`WindowOrder`] draws some rings together, in
//! columns across them, while the faces come in; each vertex is still sent once.
//!
//! Read [`TrimmedLists`] first: the rest follows from its numbers.

mod fans;
mod first_vertex;
mod minimum_time;
#[cfg(test)]
pub(crate) mod soups;
mod sweep;
#[cfg(test)]
mod tests;
mod trimmed_list_code;
mod trimmed_lists;
mod window_order;
#[cfg(test)]
mod window_tests;

pub use fans::FanCode;
#[cfg(feature = "default-tier")]
pub(crate) use fans::MixedModel;
pub(crate) use fans::{BlockReader, BlockSize, Blocks, FanModel, Outlook, TableModel, VertexCoder};
pub use first_vertex::FirstVertex;
pub use minimum_time::{MinimumTimeRendering, RenderStep, released_buffer_size};
pub use sweep::buffer_bound;
pub use trimmed_list_code::{CodeBits, Membership, TrimmedListCode};
pub use trimmed_lists::TrimmedLists;
pub use window_order::{Window, WindowOrder, WindowSize};
