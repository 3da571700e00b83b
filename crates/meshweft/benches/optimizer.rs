//! The optimizer: what each effort costs for each kind of target.

mod meshes;

use criterion::{BenchmarkId, Criterion, Throughput};
use meshweft::order::{Effort, Optimizer, Target};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(64);

    let mut group = criterion.benchmark_group("optimizer");
    group.throughput(Throughput::Elements(mesh.face_count() as u64));
    group.sample_size(10);
    for target in [
        "universal",
        "fifo:12",
        "lru:32",
        "controllable:12",
        "nvidia",
        "intel",
    ] {
        let target: Target = target.parse().expect("a target");
        // `Max` is `Best` with more continuations.
        for effort in [Effort::Fast, Effort::Best] {
            let optimizer = Optimizer {
                target,
                effort,
                ..Optimizer::default()
            };
            let id = BenchmarkId::new(target.to_string(), effort);
            group.bench_function(id, |bencher| bencher.iter(|| optimizer.face_order(&mesh)));
        }
    }
    group.finish();
    criterion.final_summary();
}
