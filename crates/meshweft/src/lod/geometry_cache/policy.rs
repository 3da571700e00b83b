//! Which open slot the next vertex takes.

use std::fmt::Debug;

/// Knows the open slots, those of no active vertex, and says which of them is taken next.
///
/// In the beginning all slots are opened, in the order of their numbers, with no error. Frames are counted, and the
/// count may pass 2^32 and go on from 0.
pub trait SlotPolicy: Debug + Send + Sync {
    /// A slot is open from this frame on: its vertex, of this error, was removed from the front. `None`: it has no
    /// vertex.
    fn open(&mut self, slot: u32, error: Option<f32>, frame: u32);

    /// An open slot is closed: its vertex is active again.
    fn close(&mut self, slot: u32);

    /// An open slot, which is closed by that. [`GeometryCache`](super::GeometryCache) asks only while there is one; an
    /// answer that is none of them is overruled.
    fn take(&mut self, frame: u32) -> Option<u32>;
}
