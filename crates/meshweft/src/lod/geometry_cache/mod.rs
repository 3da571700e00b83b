//! The vertices of a front that changes, kept in the slots of a vertex buffer.
//!
//! Roberto Lario, Renato Pajarola, Francisco Tirado: *Cached Geometry Manager for View-dependent LOD Rendering*,
//! WSCG 2005, ISBN 80-903100-7-9.
//!
//! From frame to frame a view-dependent level of detail activates few vertices and deactivates few. So a vertex
//! stays in its slot while it is active, and longer: the slot is *open* then, and its vertex is back for nothing
//! unless another one has taken the slot meanwhile. A vertex is *resident* if `vertex.slot` and `slot.vertex`
//! agree. What is uploaded are the vertices that become active and are not resident; which open slot each of them
//! takes is the policy's choice ([`EvictionPolicy`], or a [`SlotPolicy`] of your own).
//!
//! **Two kinds of front.** An *implicit* front is known by its active vertices only, in each frame
//! ([`GeometryCache::set_active`]); an *explicit* one by what it added and removed ([`GeometryCache::change`]), at a
//! cost of these only. The first is turned into the second, so every policy serves both.
//!
//! **Where the paper leaves room.**
//! - *The frontier.* Lists have the open slots only. The order of active ones never decides anything: a slot goes just
//!   below the frontier when its vertex is removed, whatever it did before.
//! - *Mark, then insert.* All vertices that stay or come back are marked before any slot is taken. One pass, as in the
//!   paper, may overwrite a vertex that is active and stands later in the list.
//! - *First available* may find no slot that was open in the last frame too: then it takes the first open one.
//! - *The priority queue* is filled when a slot is needed. It has the oldest open slots at that time, as many as fit.
//! - *All slots.* [`EvictionPolicy::FinestFirst`] takes the paper's queue to its end: the finest detail of all open slots.
//! - *More active vertices than slots*: drawn in passes ([`GeometryCache::passes`]), or sent whole as a stream.

mod cache_error;
mod eviction;
mod finest_first;
mod first_available;
mod index_slots;
mod index_slots_error;
#[cfg(test)]
mod index_slots_tests;
mod linked_slots;
mod manager;
#[cfg(test)]
mod model;
#[cfg(test)]
mod model_tests;
mod number_set;
mod oldest_first;
mod optimum;
#[cfg(test)]
mod optimum_tests;
mod passes;
mod policy;
mod queued_by_error;
mod recorded_path;
mod slot_bits;
mod slot_indices;
mod slot_ranges;
mod slot_table;
mod upload;

pub use cache_error::GeometryCacheError;
pub use eviction::EvictionPolicy;
pub use index_slots::{IndexPatch, IndexSlots, IndexStatistics};
pub use index_slots_error::IndexSlotsError;
pub use manager::GeometryCache;
pub use passes::{CachePass, Passes};
pub use policy::SlotPolicy;
pub use recorded_path::RecordedPath;
pub use slot_indices::SlotIndices;
pub use upload::{FrameMode, FrameStatistics, Insert, Upload};
