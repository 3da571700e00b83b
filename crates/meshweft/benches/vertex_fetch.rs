//! Vertices in the order of their first use: finding it, renumbering the faces, moving the records.

mod meshes;

use criterion::{Criterion, Throughput};
use meshweft::order::{baselines, vertex_fetch};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(256);
    // As many misses of the memory as there can be: the vertices in any order.
    let shuffled = baselines::random(mesh.vertex_count(), 1);
    let mesh = mesh.with_vertex_order(&shuffled.into());

    let mut group = criterion.benchmark_group("vertex_fetch");
    group.throughput(Throughput::Elements(mesh.vertex_count() as u64));
    let order = vertex_fetch(&mesh);
    group.bench_function("order", |bencher| bencher.iter(|| vertex_fetch(&mesh)));
    group.bench_function("renumber", |bencher| {
        bencher.iter(|| order.renumber(mesh.faces()));
    });
    group.bench_function("apply", |bencher| {
        bencher.iter(|| order.permutation().apply(mesh.positions()));
    });
    group.finish();
    criterion.final_summary();
}
