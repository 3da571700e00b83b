//! A frame that does not fit into the slots.

use super::frame::WalkFrame;
use crate::index::BLOCK;
use crate::lod::geometry_cache::{GeometryCache, GeometryCacheError};

/// Draws the faces of a frame that does not fit into the slots, and adds what that sends and how long it takes. Vertices have this many bytes.
pub(in crate::operations) fn draw_passes(
    cache: &mut GeometryCache,
    faces: &[[u32; 3]],
    vertex_size: usize,
    clock: &dyn Fn() -> f64,
    frame: &mut WalkFrame,
) -> Result<(), GeometryCacheError> {
    let start = clock();
    let index_size = if cache.slots() <= BLOCK { 2 } else { 4 };
    let mut passes = cache.passes(faces)?;
    frame.passes = 0;
    let mut drawn: Vec<[u32; 3]> = Vec::new();
    while let Some(pass) = passes.next_pass() {
        // As a renderer does: it writes them.
        drawn.clear();
        drawn.extend(pass.indices());
        let statistics = pass.upload().statistics();
        frame.passes += 1;
        frame.inserts += statistics.inserts;
        frame.vertex_ranges += statistics.ranges;
        frame.vertex_bytes += statistics.bytes(vertex_size);
        frame.patched_faces += drawn.len();
        frame.index_ranges += 1;
        frame.index_bytes += 3 * (drawn.len() * index_size) as u64;
    }
    frame.cache_milliseconds += 1e3 * (clock() - start);
    Ok(())
}
