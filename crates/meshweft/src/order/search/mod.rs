//! Search by rollouts.
//!
//! K-Cache-Reorder ([`KCacheReorder`](super::KCacheReorder)) is greedy: it takes the vertex that is
//! cheapest to finish, and the price of a bad choice shows only about a cache's length of pushes
//! later. *Rollouts* look that far ahead. In each round, several continuations of a few dozen
//! vertices are run from the current state, each with different noise on the costs. The best one
//! evicts the least unfinished work for the faces that it draws. Its beginning is committed (all of
//! it at effort `fast`, a third to a fifth at the others); its tail competes again in the next
//! round. Evictions of unfinished vertices are the right count: each is exactly one miss to come,
//! so all misses are the used vertices plus these evictions. (Rolling-horizon search; D. P.
//! Bertsekas, J. N. Tsitsiklis, C. Wu: *Rollout Algorithms for Combinatorial Optimization*, Journal
//! of Heuristics 3, 1997, doi:10.1023/A:1009635226865.)
//!
//! The same traversal serves all targets; only the modelled caches and the weights of their
//! evictions differ (`preset`). Batches are modelled as the GPU starts them, so an order stays
//! aligned with them from the first face to the last. The *universal* target models a small FIFO
//! cache and a batch at once, and also counts vertices that leave longer windows unfinished.
//!
//! Read `settings` for the words, `rollout` for the loop, `state` for undo, `parts` for threads,
//! `border` for meshes of more than 65,536 vertices.

mod border;
mod mask;
mod parts;
mod preset;
mod rollout;
mod settings;
mod slabs;
mod state;
#[cfg(feature = "tuning")]
pub mod tuning;

pub(super) use parts::Search;
pub(super) use preset::lru_as_fifo;
