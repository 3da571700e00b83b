//! 16-bit indices in an order that misses less, in place. Positions are not needed.
//!
//! ```text
//! cargo run --example order_u16_indices
//! ```

use meshweft::operations::{IndexOptions, optimize_indices};
use meshweft::{CacheModel, Faces, MeshError, cache};

fn main() -> Result<(), MeshError> {
    let mut indices: Vec<u16> = quads_that_jump();
    let before = misses(&indices)?;
    optimize_indices(&mut indices, 202, &IndexOptions::default())?;
    let after = misses(&indices)?;

    println!("{before} misses before, {after} after");
    assert!(after < before);
    Ok(())
}

fn misses(indices: &[u16]) -> Result<u64, MeshError> {
    let mut buffer = Vec::new();
    let faces = Faces::widened(indices, 202, &mut buffer)?;
    Ok(cache::misses(faces, CacheModel::fifo(16)))
}

/// A strip of 100 quads, each drawn far from the last.
fn quads_that_jump() -> Vec<u16> {
    let quad = |i: u16| [2 * i, 2 * i + 1, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 2];
    let pairs = (0..50).flat_map(|i| [quad(37 * i % 100), quad((37 * i + 50) % 100)]);
    pairs.flatten().collect()
}
