//! A `.gltf` with its `.bin`, both in memory: what a browser has, and what it gets back.
//!
//! ```text
//! cargo run --example order_gltf_from_a_map --features files
//! ```

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use meshweft::files::{Document, Format, ReadOptions, Surroundings};
use meshweft::operations::{Options, optimize};

fn main() -> Result<(), Box<dyn Error>> {
    let (json, files) = strip();
    let beside = Surroundings::Memory(&files);
    let (name, options) = (Path::new("strip.gltf"), ReadOptions::default());
    let mut document = Document::from_bytes_in(json, Format::Gltf, name, beside, options)?;
    let report = optimize(&mut document, &Options::default(), &())?;
    let written: BTreeMap<PathBuf, Vec<u8>> = document.to_bytes(name)?.into_iter().collect();
    println!("{:?}", written.keys());

    let buffer = Path::new("strip.bin");
    assert!(report.is_changed() && written[buffer] != files[buffer]);
    assert!(written.contains_key(name));
    Ok(())
}

/// A strip of 200 faces whose order jumps between its ends, its data in a buffer of its own.
fn strip() -> (Vec<u8>, BTreeMap<PathBuf, Vec<u8>>) {
    let face = |i: u16| match i % 2 {
        0 => [i, i + 1, i + 2],
        _ => [i + 1, i, i + 2],
    };
    let faces = (0..100).flat_map(|i| [face(i), face(199 - i)]);
    let positions = (0..202_u16).flat_map(|i| [f32::from(i / 2), f32::from(i % 2), 0.0]);
    let mut buffer: Vec<u8> = positions.flat_map(f32::to_le_bytes).collect();
    buffer.extend(faces.flatten().flat_map(u16::to_le_bytes));
    let json = r#"{
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"uri": "strip.bin", "byteLength": 3624}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 2424},
            {"buffer": 0, "byteOffset": 2424, "byteLength": 1200}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 202, "type": "VEC3",
             "min": [0, 0, 0], "max": [100, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 600, "type": "SCALAR"}
        ]
    }"#;
    let files = BTreeMap::from([(PathBuf::from("strip.bin"), buffer)]);
    (json.into(), files)
}
