//! K-Cache-Reorder: both modes, both kinds of cache.

mod meshes;

use criterion::{BenchmarkId, Criterion, Throughput};
use meshweft::CacheModel;
use meshweft::order::{KCacheReorder, Mode};

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mesh = meshes::scanned(128);

    let mut group = criterion.benchmark_group("k_cache_reorder");
    group.throughput(Throughput::Elements(mesh.face_count() as u64));
    for mode in [Mode::Fast, Mode::Faithful] {
        for cache in [
            CacheModel::fifo(12),
            CacheModel::fifo(32),
            CacheModel::controllable(12),
        ] {
            let algorithm = KCacheReorder {
                cache,
                mode,
                ..KCacheReorder::default()
            };
            let id = BenchmarkId::new(format!("{mode:?}").to_lowercase(), cache);
            group.bench_function(id, |bencher| bencher.iter(|| algorithm.face_order(&mesh)));
        }
    }
    group.finish();
    criterion.final_summary();
}
