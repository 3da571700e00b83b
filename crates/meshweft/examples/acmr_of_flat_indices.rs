//! The misses per face of flat indices, three a face, without a copy.
//!
//! ```text
//! cargo run --example acmr_of_flat_indices
//! ```

use meshweft::{CacheModel, Faces, MeshError, cache};

fn main() -> Result<(), MeshError> {
    let indices: Vec<u32> = strip_of_quads(50);
    let faces = Faces::from_indices(&indices, 102)?;

    // Each of the 102 vertices is missed once, in 100 faces.
    let acmr = cache::acmr(faces, CacheModel::fifo(16));
    println!("{acmr} misses per face");
    assert_eq!(acmr, 1.02);
    Ok(())
}

/// Quads side by side, of two faces each.
fn strip_of_quads(count: u32) -> Vec<u32> {
    let quad = |i: u32| [2 * i, 2 * i + 1, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 2];
    (0..count).flat_map(quad).collect()
}
