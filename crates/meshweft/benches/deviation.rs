//! How far two surfaces are from each other: arranging one for the search, and measuring.

mod meshes;

use criterion::{Criterion, Throughput};
use meshweft::geometry::{Surface, deviation};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    // 100,352 faces, against a fourth of them on the same waves.
    let [fine, coarse] = [224, 112].map(meshes::scanned);
    let surface = |mesh| {
        let mesh: &meshweft::Mesh = mesh;
        Surface::new(mesh.positions(), mesh.faces())
    };

    let mut group = criterion.benchmark_group("deviation");
    group.throughput(Throughput::Elements(fine.face_count() as u64));
    group.bench_function("surface", |bencher| bencher.iter(|| surface(&fine)));
    let (fine, coarse) = (surface(&fine), surface(&coarse));
    let samples = 100_000;
    group.throughput(Throughput::Elements(2 * samples as u64));
    group.sample_size(20);
    group.bench_function("measure", |bencher| {
        bencher.iter(|| deviation(&fine, &coarse, samples));
    });
    group.finish();
    criterion.final_summary();
}
