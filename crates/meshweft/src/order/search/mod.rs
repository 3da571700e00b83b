//! Search by rollouts.
//!
//! K-Cache-Reorder ([`KCacheReorder`](super::KCacheReorder)) is a greedy: it takes the vertex that is
//! cheapest to finish and sees the price of a bad choice only when it is paid, about a cache's length
//! of pushes later. *Rollouts* look that far ahead. From where the sequence stands, several
//! continuations of a few dozen vertices are run, each with other noise on the costs; of the one that
//! evicts least unfinished work for the faces that it draws the beginning is committed (all of it at
//! effort `fast`, a third to a fifth beyond), its tail competes again in the next round. Evictions of
//! unfinished vertices are the right count: each is exactly one more miss to come, so all misses are
//! used vertices plus such evictions. (Rolling-horizon search; D. P. Bertsekas, J. N. Tsitsiklis, C.
//! Wu: *Rollout Algorithms for Combinatorial Optimization*, Journal of Heuristics 3, 1997,
//! doi:10.1023/A:1009635226865.)
//!
//! The same traversal serves all targets; what differs is which caches are modelled and how their
//! evictions are weighed (`preset`). Batches are modelled as the GPU starts them, so an order stays
//! aligned with them from the first face to the last. The *universal* target models a small FIFO
//! cache and a batch next to each other and also counts vertices that drop out of longer windows.
//!
//! Read `settings` for the words, `rollout` for the loop, `state` for how a run is taken back, `parts`
//! for threads.

mod mask;
mod parts;
mod preset;
mod rollout;
mod settings;
mod slabs;
mod state;

pub(super) use parts::Search;
pub(super) use preset::lru_as_fifo;
