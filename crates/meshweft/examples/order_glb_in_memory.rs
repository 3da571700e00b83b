//! A GLB that is held in memory, in an order that misses less: bytes in, bytes out.
//!
//! ```text
//! cargo run --example order_glb_in_memory --features files
//! ```

use std::error::Error;
use std::path::Path;

use meshweft::files::{Document, Format, ReadOptions};
use meshweft::operations::{Options, optimize};

fn main() -> Result<(), Box<dyn Error>> {
    // The name is for messages only: nothing is read from disk.
    let (bytes, name) = (shuffled_grid(), Path::new("grid.glb"));
    let mut document =
        Document::from_bytes(bytes.clone(), Format::Glb, name, ReadOptions::default())?;
    let report = optimize(&mut document, &Options::default(), &())?;
    let ordered = document.to_main_bytes()?;

    println!("{} bytes in, {} bytes out", bytes.len(), ordered.len());
    assert!(report.is_changed() && ordered.len() == bytes.len() && ordered != bytes);
    Ok(())
}

/// A GLB with 20 × 20 quads, the faces far from their neighbours.
fn shuffled_grid() -> Vec<u8> {
    let position = |i: u16| [f32::from(i % 21), f32::from(i / 21), 0.0];
    let square = |i: u16| {
        let corner = i * 37 % 400 / 20 * 21 + i * 37 % 400 % 20;
        [
            corner,
            corner + 1,
            corner + 21,
            corner + 1,
            corner + 22,
            corner + 21,
        ]
    };
    let positions = (0..441).flat_map(position).flat_map(f32::to_le_bytes);
    let indices = (0..400).flat_map(square).flat_map(u16::to_le_bytes);
    let buffer: Vec<u8> = positions.chain(indices).collect();

    let mut json = String::from(
        r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":10092}],"bufferViews":[
        {"buffer":0,"byteLength":5292},{"buffer":0,"byteOffset":5292,"byteLength":4800}],"accessors":[
        {"bufferView":0,"componentType":5126,"count":441,"type":"VEC3","min":[0,0,0],"max":[20,20,0]},
        {"bufferView":1,"componentType":5123,"count":2400,"type":"SCALAR"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]}"#,
    );
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }

    let word = |n: usize| u32::try_from(n).expect("a small file").to_le_bytes();
    let mut bytes = [*b"glTF", word(2), word(28 + json.len() + buffer.len())].concat();
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &buffer)] {
        bytes.extend(word(chunk.len()));
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}
