//! A GLB that is held in memory, in an order that misses less: bytes in, bytes out.
//!
//! ```text
//! cargo run --example order_glb_in_memory --features files
//! ```

use std::error::Error;
use std::path::Path;

use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{Document, FileError, Format, NewMesh, NewVertices, ReadOptions};
use meshweft::operations::{Options, optimize};

fn main() -> Result<(), Box<dyn Error>> {
    // The name is for messages only: nothing is read from disk.
    let (bytes, name) = (shuffled_grid()?, Path::new("grid.glb"));
    let mut document =
        Document::from_bytes(bytes.clone(), Format::Glb, name, ReadOptions::default())?;
    let report = optimize(&mut document, &Options::default(), &())?;
    let ordered = document.to_main_bytes()?;

    println!("{} bytes in, {} bytes out", bytes.len(), ordered.len());
    assert!(report.is_changed() && ordered.len() == bytes.len() && ordered != bytes);
    Ok(())
}

/// A GLB with 20 × 20 quads, the faces far from their neighbours.
fn shuffled_grid() -> Result<Vec<u8>, FileError> {
    let position = |i: u16| [f32::from(i % 21), f32::from(i / 21), 0.0];
    let positions: Vec<[f32; 3]> = (0..441).map(position).collect();
    let quad = |i: u32| {
        let a = i * 37 % 400 / 20 * 21 + i * 37 % 400 % 20;
        [[a, a + 1, a + 21], [a + 1, a + 22, a + 21]]
    };
    let faces: Vec<[u32; 3]> = (0..400).flat_map(quad).collect();

    let attributes = [Attribute::of_vertices(Semantic::Position, &positions)];
    let grid = NewMesh::new("grid", NewVertices::Stored(&attributes), &faces);
    Document::create(Format::Glb, Path::new("grid.glb"), &[grid])?.to_main_bytes()
}
