//! View-dependent detail of a mesh: half-edge collapses in a hierarchy, and a front that follows the camera.
//!
//! Renato Pajarola, Christopher DeCoro: *Efficient Implementation of Real-Time View-Dependent Multiresolution Meshing*, IEEE
//! Transactions on Visualization and Computer Graphics 10(3), 2004, doi:10.1109/TVCG.2004.1272735, and the first half of Roberto
//! Lario, Renato Pajarola, Francisco Tirado: *Cached Geometry Manager for View-dependent LOD Rendering*, WSCG 2005.
//!
//! A mesh is simplified by half-edge collapses until nothing can leave: what is left are the *roots*. Each collapse is a node of a
//! forest. It knows how far the coarse surface is from the input's vertices there, a ball around everything that there is below
//! it, and a cone around all normals. A [`Front`] holds the vertices that are *active*: it starts with the roots, splits where the error
//! could be seen, and collapses again where it no longer can. Both change a few links, and what they change is said.
//!
//! # Where the papers leave room
//! - **When a vertex can be split.** Its parent is active, and so are the faces around the two that return. That is known from the
//!   coarsest mesh alone, as faces that left keep their links: no topology is tested at run time. A vertex can be collapsed as
//!   long as no active vertex needs it.
//! - **Numbers.** The *n*-th point that can leave has the faces 2*n* and 2*n* + 1 of those that can leave: a list of the active points is a
//!   list of the active faces. Points are numbered from coarse to fine by octaves of their errors, near ones together.
//! - **Errors.** How far the surface is from the input's vertices where a point left, measured on the mesh that a tolerance of that
//!   error leaves: in the order of the build first, then twice in the order of the errors found before.
//! - **Bounds.** Errors, balls and cones contain those below, along the collapses into one vertex too: what fails is always at the top
//!   of the forest, so only the vertices of the front and those just below it are tested.
//! - **Seams.** A point's vertices go together, each to its partner. Points where the surface is not a manifold stay.
//!
//! A `.mwl` file has it in blocks (`stored`), and a [`StreamedFront`] reads those that a view needs.
//!
//! Read `links` first, one collapse and its split; then `replay`, how each comes about, `measured`, and `front`.

mod attached;
mod budget;
mod build;
mod changes;
mod deviation;
#[cfg(test)]
mod errors_above_tests;
mod front;
mod full_detail;
mod hierarchy;
mod links;
mod loader;
mod measured;
mod missing;
mod numbering;
mod queues;
mod replay;
mod rows;
#[cfg(test)]
mod rows_tests;
mod sorted;
mod stored;
mod stored_rows;
#[cfg(test)]
mod stored_tests;
mod streamed;
#[cfg(test)]
mod streamed_tests;
mod tested;
#[cfg(test)]
pub(crate) mod tests;

#[cfg(all(test, feature = "files"))]
pub(crate) use stored::reseal;

pub use budget::FrameBudget;
pub use build::FastMesh;
pub use changes::FrontChanges;
pub use front::Front;
pub use hierarchy::VertexHierarchy;
pub use streamed::StreamedFront;
