//! Instructions that the orders take, counted by callgrind. `compare/instructions` runs it on two
//! revisions and says what has changed.
//!
//! Meshes are loaded by the setup, which is not counted.
#![expect(missing_docs, reason = "the macros make items without")]

use counts::mesh;
use gungraun::Callgrind;
use gungraun::prelude::*;
use meshweft::{FaceOrder, Mesh, VertexOrder};

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
#[bench::horse("horse")]
#[bench::nefertiti("nefertiti")]
#[bench::dragon("dragon")]
fn fifo12_fast(mesh: &Mesh) -> FaceOrder {
    counts::fifo12_fast(mesh)
}

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
#[bench::horse("horse")]
#[bench::nefertiti("nefertiti")]
#[bench::dragon("dragon")]
fn universal_fast(mesh: &Mesh) -> FaceOrder {
    counts::universal_fast(mesh)
}

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
fn universal_best(mesh: &Mesh) -> FaceOrder {
    counts::universal_best(mesh)
}

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
#[bench::horse("horse")]
#[bench::nefertiti("nefertiti")]
#[bench::dragon("dragon")]
fn k_cache_reorder_controllable12(mesh: &Mesh) -> FaceOrder {
    counts::k_cache_reorder_controllable12(mesh)
}

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
#[bench::horse("horse")]
#[bench::nefertiti("nefertiti")]
#[bench::dragon("dragon")]
fn misses_fifo16(mesh: &Mesh) -> u64 {
    counts::misses_fifo16(mesh)
}

#[library_benchmark(setup = mesh)]
#[bench::fandisk("fandisk")]
#[bench::bunny("bunny")]
#[bench::horse("horse")]
#[bench::nefertiti("nefertiti")]
#[bench::dragon("dragon")]
fn vertex_fetch(mesh: &Mesh) -> VertexOrder {
    counts::vertex_fetch(mesh)
}

library_benchmark_group!(
    name = orders,
    benchmarks = [
        fifo12_fast,
        universal_fast,
        universal_best,
        k_cache_reorder_controllable12,
        misses_fifo16,
        vertex_fetch,
    ]
);

main!(
    config = LibraryBenchmarkConfig::default()
        .pass_through_env(counts::FOLDER)
        // Instructions alone: a model of the processor's caches takes several times longer.
        .tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = orders
);
