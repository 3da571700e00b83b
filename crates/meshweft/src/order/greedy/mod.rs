//! What greedy traversals share: live faces, the vertices in the cache by age, costs in integers.

mod costs;
mod estimate;
mod live_faces;
mod queue;
mod turn;

pub(in crate::order) use costs::Costs;
pub(in crate::order) use estimate::{gather_live, least_neighbours};
pub(in crate::order) use live_faces::{HUB, LiveFaces, LiveVertex};
pub(in crate::order) use queue::{Entry, Queue};
pub(in crate::order) use turn::{HITS_FIRST, Turn};
