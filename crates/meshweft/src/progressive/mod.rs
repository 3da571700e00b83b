//! Progressive meshes: one structure for every resolution, and a rendering sequence that follows.
//!
//! Alexander Bogomjakov, Craig Gotsman: *Universal Rendering Sequences for Transparent Vertex
//! Caching of Progressive Meshes*, Computer Graphics Forum 21(2), 2002,
//! doi:10.1111/1467-8659.00573, section 3. Gang Lin, Thomas P.-Y. Yu: *An Improved Vertex Caching
//! Scheme for 3D Mesh Rendering*, IEEE Transactions on Visualization and Computer Graphics 12(4),
//! 2006, doi:10.1109/TVCG.2006.59, section 3.
//!
//! A mesh gets coarser by update records. Each removes a vertex with all its faces, which leaves a
//! hole, and fills the hole with fewer faces. Played forwards the records make the mesh coarser,
//! played backwards finer. The *level* is the number of records that are played: 0 is full
//! resolution. Faces that a record does not name keep their places in the rendering sequence; the
//! new ones go where the old ones were, and a *sequence update* decides which goes where. So each
//! level comes in a good order without being ordered again.
//!
//! Any history of such records can be played: read [`history`] for the records, then [`sequence`] for the
//! updates of the two papers. Ours is made by half-edge collapses: [`Collapses`] decides which vertex leaves
//! next, and makes a [`ProgressiveMesh`]. There a record only changes corners and takes faces away, so every
//! face keeps its place in the sequence, and a [`Walk`] from one level to another edits it in place.
//! [`Checkpoints`] are orders for some levels, so that the sequence stays good down to the coarsest; a
//! [`CheckpointWalk`] writes the faces of a level in that sequence, and an [`IndexBuffer`] keeps them as a renderer
//! does and says which of them changed.

mod checkpoint_walk;
mod checkpoints;
mod collapses;
pub mod history;
mod index_buffer;
#[cfg(test)]
pub(crate) mod made;
mod progressive_mesh;
mod records;
mod ring;
pub mod sequence;
#[cfg(test)]
mod tests;
mod walk;
#[cfg(test)]
mod walk_tests;

pub use checkpoint_walk::CheckpointWalk;
pub use checkpoints::Checkpoints;
pub(crate) use collapses::told_from_point;
pub use collapses::{AttributeWeights, Collapses};
pub use history::{History, HistoryBuilder, NewRecord, Record};
pub use index_buffer::IndexBuffer;
pub use progressive_mesh::{ProgressiveMesh, StopReason};
pub use records::{Collapse, SidePair};
pub use sequence::{AdaptiveUpdate, SimpleUpdate, SmartUpdate};
pub use walk::Walk;
