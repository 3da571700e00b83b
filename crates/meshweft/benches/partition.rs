//! Balanced cuts of the dual graph: making the graph, and cutting it.

mod meshes;

use criterion::{BenchmarkId, Criterion, Throughput};
use meshweft::partition::{Graph, Multilevel};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(128);
    let graph = Graph::dual(&mesh);

    let mut group = criterion.benchmark_group("partition");
    group.throughput(Throughput::Elements(mesh.face_count() as u64));
    group.sample_size(10);
    group.bench_function("dual", |bencher| bencher.iter(|| Graph::dual(&mesh)));
    for parts in [2, 8, 64] {
        let algorithm = Multilevel {
            parts,
            ..Multilevel::default()
        };
        let id = BenchmarkId::new("multilevel", parts);
        group.bench_function(id, |bencher| bencher.iter(|| algorithm.partition(&graph)));
    }
    group.finish();
    criterion.final_summary();
}
