//! A `.gltf` and its buffer read from memory and written to memory, without a disk.
//!
//! A test of its own program, because it moves the working folder.
#![cfg(feature = "files")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Format, Surroundings};
use meshweft::operations::{Options, optimize};

const JSON: &str = r#"{ "asset": { "version": "2.0" },
    "buffers": [{ "uri": "buffers/a%20b.bin", "byteLength": 708 }],
    "bufferViews": [{ "buffer": 0, "byteLength": 480 },
        { "buffer": 0, "byteOffset": 480, "byteLength": 228 }],
    "accessors": [
        { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 40 },
        { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 114 }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }] }"#;

#[test]
fn no_file_is_needed_and_none_is_made() {
    let name = format!("meshweft-without-a-disk-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir(&folder).unwrap();
    std::env::set_current_dir(&folder).unwrap();

    // A strip of 38 faces in a bad order.
    let starts = (0..38_u16).map(|i| i * 7 % 38);
    let corners = starts.flat_map(|start| [start, start + 1, start + 2]);
    let mut buffer = vec![0; 480];
    buffer.extend(corners.flat_map(u16::to_le_bytes));

    let path = PathBuf::from("buffers/a b.bin");
    let files = BTreeMap::from([(path.clone(), buffer)]);
    let (name, beside) = (Path::new("scene.gltf"), Surroundings::Memory(&files));
    let read = Document::from_bytes_in(JSON.into(), Format::Gltf, name, beside, Limits::default());
    let mut document = read.unwrap();
    let report = optimize(&mut document, &Options::default(), &()).unwrap();
    assert!(report.is_changed());

    let new = document.to_bytes(name).unwrap();
    assert_eq!(new[0].0, path);
    assert_ne!(new[0].1, files[&path]);
    assert_eq!(new[1], (name.into(), JSON.into()));
    let new = document.to_bytes(Path::new("new.gltf")).unwrap();
    assert_eq!(new[0].0, Path::new("new.bin"));
    let json = JSON.replace("buffers/a%20b.bin", "new.bin");
    assert_eq!(new[1], ("new.gltf".into(), json.into()));

    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    std::env::set_current_dir(std::env::temp_dir()).unwrap();
    std::fs::remove_dir(&folder).unwrap();
}
