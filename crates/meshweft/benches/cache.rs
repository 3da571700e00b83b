//! Counting misses, in each cache model.

mod meshes;

use criterion::{Criterion, Throughput};
use meshweft::{CacheModel, cache};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(256);

    let mut group = criterion.benchmark_group("misses");
    group.throughput(Throughput::Elements(mesh.face_count() as u64));
    for model in [
        "fifo:16",
        "lru:16",
        "controllable:16",
        "nvidia",
        "amd",
        "intel",
    ] {
        let model: CacheModel = model.parse().expect("a cache model");
        let name = model.to_string();
        group.bench_function(name, |bencher| bencher.iter(|| cache::misses(&mesh, model)));
    }
    group.finish();
    criterion.final_summary();
}
