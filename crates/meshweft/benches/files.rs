//! Reading a file that is in memory, and writing it back.

mod meshes;

use std::path::Path;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput};
use meshweft::Mesh;
use meshweft::files::{Document, Format, NewMesh, ReadOptions};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(128);

    let mut group = criterion.benchmark_group("files");
    for (name, format) in [("mesh.glb", Format::Glb), ("mesh.obj", Format::Obj)] {
        let bytes = made(&mesh, format);
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

/// Positions and faces, nothing else.
fn made(mesh: &Mesh, format: Format) -> Vec<u8> {
    let new = NewMesh::plain("", mesh.positions(), mesh.faces());
    let document = Document::create(format, Path::new("mesh"), &[new]).expect("a sound mesh");
    document.to_main_bytes().expect("it was made here")
}
