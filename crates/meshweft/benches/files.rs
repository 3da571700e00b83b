//! Reading a file that is in memory, and writing it back.

mod meshes;

use std::fmt::Write;
use std::path::Path;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput};
use meshweft::Mesh;
use meshweft::files::{Document, Format, ReadOptions};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(128);

    let mut group = criterion.benchmark_group("files");
    for (name, format, bytes) in [
        ("mesh.glb", Format::Glb, glb(&mesh)),
        ("mesh.obj", Format::Obj, obj(&mesh)),
    ] {
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        let path = Path::new(name);
        let open = |bytes| {
            Document::from_bytes(bytes, format, path, ReadOptions::default()).expect("a sound file")
        };

        group.bench_function(BenchmarkId::new("open", format), |bencher| {
            bencher.iter_batched(|| bytes.clone(), open, BatchSize::LargeInput);
        });
        let document = open(bytes.clone());
        assert_eq!(document.meshes().len(), 1, "{name}");
        group.bench_function(BenchmarkId::new("to_bytes", format), |bencher| {
            bencher.iter(|| document.to_main_bytes().expect("it was read"));
        });
    }
    group.finish();
    criterion.final_summary();
}

fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in mesh.positions() {
        writeln!(text, "v {x} {y} {z}").expect("a string takes it");
    }
    for face in mesh.faces() {
        let [a, b, c] = face.map(|vertex| vertex + 1);
        writeln!(text, "f {a} {b} {c}").expect("a string takes it");
    }
    text.into_bytes()
}

/// Positions and 32-bit indices, nothing else.
fn glb(mesh: &Mesh) -> Vec<u8> {
    // The buffer.
    let positions = mesh.positions().as_flattened().iter();
    let indices = mesh.faces().as_flattened().iter();
    let mut binary: Vec<u8> = positions.flat_map(|value| value.to_le_bytes()).collect();
    let index_start = binary.len();
    binary.extend(indices.flat_map(|index| index.to_le_bytes()));

    // What says where they are.
    let (length, vertices, corners) = (binary.len(), mesh.vertex_count(), mesh.face_count() * 3);
    let mut json = serde_json::json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": length}],
        "bufferViews": [
            {"buffer": 0, "byteLength": index_start},
            {"buffer": 0, "byteOffset": index_start, "byteLength": length - index_start},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5125, "count": corners, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    })
    .to_string()
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');

    // The header and both chunks.
    let word = |n: usize| u32::try_from(n).expect("a small file").to_le_bytes();
    let total = 12 + 8 + json.len() + 8 + length;
    let mut bytes = [*b"glTF", 2_u32.to_le_bytes(), word(total)].concat();
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        bytes.extend(word(chunk.len()));
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}
