//! One order for every cache: no worse than meshoptimizer's in any of them.

use compare::rivals::Meshopt;
use meshweft::cache;
use meshweft::order::{Effort, Optimizer, Target};

#[test]
fn no_cache_or_gpu_loses_to_meshoptimizer() {
    let Some(data) = compare::data_folder() else {
        assert!(std::env::var_os("MESHWEFT_REQUIRE_DATA").is_none());
        compare::say("universal order: skipped, no test data");
        return;
    };
    let files = compare::default_mesh_files(&data);
    for file in &files {
        let mesh = compare::oracle::read(file).unwrap();
        let theirs = Meshopt::VertexCache.ordered(&mesh);
        for effort in [Effort::Fast, Effort::Best, Effort::Max] {
            if effort == Effort::Max && mesh.face_count() > 200_000 {
                // It would take half a minute, and the smaller ones show the same.
                continue;
            }
            let optimizer = Optimizer {
                target: Target::Universal,
                effort,
                ..Optimizer::default()
            };
            let ours = optimizer.face_order(&mesh).apply(mesh.faces());
            for model in Target::UNIVERSAL {
                let [ours, theirs] = [&ours, &theirs].map(|faces| cache::misses(faces, model));
                let name = compare::mesh_name(file);
                assert!(
                    ours <= theirs,
                    "{name}, {model}, {effort:?}: {ours} misses, meshoptimizer {theirs}"
                );
            }
        }
    }
    compare::say(&format!(
        "universal order: {} meshes, 9 caches each",
        files.len()
    ));
}
