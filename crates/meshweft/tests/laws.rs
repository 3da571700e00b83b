//! What holds for every mesh and every order, on meshes that nobody would model.

mod meshes;
mod replay;

use meshweft::cache::{self, BatchModel};
use meshweft::order::{KCacheReorder, Mode, baselines, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Mesh, Permutation};
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

/// The order permutes the faces, keeps each one's winding, and its inverse undoes it.
fn assert_reorders(mesh: &Mesh, order: &FaceOrder) -> Vec<[u32; 3]> {
    let faces = mesh.faces();
    assert_eq!(order.len(), faces.len());
    let permutation = Permutation::new(order.new_to_old().to_vec()).expect("a permutation");
    let ordered = order.apply(faces);
    for (new, &old) in order.new_to_old().iter().enumerate() {
        let [a, b, c] = faces[old as usize];
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        assert_eq!(ordered[new], turned[usize::from(order.rotation(new))]);
    }
    let back = permutation.inverse();
    assert_eq!(back.apply(&permutation.apply(faces)), faces);
    assert_eq!(permutation.apply(&back.apply(faces)), faces);
    assert!(
        back.apply(permutation.new_to_old())
            .iter()
            .copied()
            .eq(0..u32::try_from(faces.len()).unwrap())
    );
    ordered
}

/// Between one miss per used vertex and one per corner, for every cache.
fn assert_misses_in_range(faces: &[[u32; 3]], size: u32) {
    for model in [
        CacheModel::fifo(size),
        CacheModel::lru(size),
        CacheModel::controllable(size),
        CacheModel::Nvidia,
        CacheModel::AMD,
        CacheModel::INTEL,
        CacheModel::Batch(BatchModel::new(size, size, 5)),
    ] {
        let report = cache::report(faces, model);
        assert!(report.used_vertices as u64 <= report.misses, "{model}");
        assert!(report.misses <= 3 * faces.len() as u64, "{model}");
        let per_face = cache::misses_per_face(faces, model);
        assert_eq!(
            per_face.into_iter().map(u64::from).sum::<u64>(),
            report.misses
        );
    }
}

/// A weight: sensible ones, and those that only a fuzzer writes.
fn weight() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -3.0..3.0,
        1 => -1e6..1e6,
        1 => prop::sample::select(vec![0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300]),
    ]
}

fn cache_size() -> impl Strategy<Value = u32> {
    prop_oneof![6 => 3_u32..=40, 1 => 41_u32..=1024, 1 => Just(1024)]
}

prop_compose! {
    /// An algorithm of any setting; the first focus still to be taken below the vertex count.
    fn algorithm()(
        size in cache_size(),
        controllable in any::<bool>(),
        weights in prop::option::of((weight(), weight(), weight())),
        keep_corners in any::<bool>(),
        first_focus in prop::option::of(any::<u32>()),
    ) -> KCacheReorder {
        let cache = match controllable {
            true => CacheModel::controllable(size),
            false => CacheModel::fifo(size),
        };
        let default = KCacheReorder::default();
        let (k1, k2, k3) = weights.unwrap_or((default.k1, default.k2, default.k3));
        KCacheReorder { cache, mode: Mode::Fast, k1, k2, k3, keep_corners, first_focus }
    }
}

/// With its first focus at a vertex of `mesh`, and none where there is none.
fn on_mesh(algorithm: &KCacheReorder, mesh: &Mesh) -> KCacheReorder {
    let vertex_count = u32::try_from(mesh.vertex_count()).unwrap();
    let first_focus = algorithm.first_focus.filter(|_| vertex_count > 0);
    KCacheReorder {
        first_focus: first_focus.map(|focus| focus % vertex_count),
        ..algorithm.clone()
    }
}

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 400,
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("regressions"))),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn fast_orders_are_permutations(mesh in meshes::any_mesh(), algorithm in algorithm()) {
        let algorithm = on_mesh(&algorithm, &mesh);
        let order = algorithm.face_order(&mesh);
        let ordered = assert_reorders(&mesh, &order);
        assert_misses_in_range(&ordered, algorithm.cache.size());
        if algorithm.keep_corners {
            prop_assert!(order.rotations().iter().all(|&rotation| rotation == 0));
        }
        prop_assert_eq!(algorithm.face_order(&mesh), order);
    }

    #[test]
    fn the_first_focus_is_drawn_first(mesh in meshes::any_mesh(), algorithm in algorithm()) {
        let algorithm = on_mesh(&algorithm, &mesh);
        let Some(focus) = algorithm.first_focus else { return Ok(()) };
        let degree = mesh.faces().iter().filter(|face| face.contains(&focus)).count();
        for mode in [Mode::Fast, Mode::Faithful] {
            let order = KCacheReorder { mode, ..algorithm.clone() }.face_order(&mesh);
            let ordered = order.apply(mesh.faces());
            prop_assert!(ordered[..degree].iter().all(|face| face.contains(&focus)));
        }
    }

    #[test]
    fn turned_corners_make_pushes_equal_a_replay(
        mesh in meshes::any_mesh(),
        algorithm in algorithm(),
    ) {
        let size = algorithm.cache.size();
        let algorithm = KCacheReorder {
            cache: CacheModel::fifo(size),
            keep_corners: false,
            ..on_mesh(&algorithm, &mesh)
        };
        let ordered = algorithm.face_order(&mesh).apply(mesh.faces());
        let by_index = replay::fifo_by_index(&ordered, size);
        prop_assert_eq!(by_index, replay::fifo_by_face(&ordered, size));
        prop_assert_eq!(by_index, cache::misses(&ordered, CacheModel::fifo(size)));
    }

    #[test]
    fn schedules_play_and_belady_needs_no_more(
        mesh in meshes::any_mesh(),
        algorithm in algorithm(),
        faithful in any::<bool>(),
    ) {
        let algorithm = KCacheReorder {
            mode: if faithful { Mode::Faithful } else { Mode::Fast },
            ..on_mesh(&algorithm, &mesh)
        };
        let size = algorithm.cache.size();
        let (order, schedule) = algorithm.schedule(&mesh);
        prop_assert_eq!(&algorithm.face_order(&mesh), &order);
        let is_controllable = matches!(algorithm.cache, CacheModel::Controllable { .. });
        if is_controllable || faithful {
            let ordered = order.apply(mesh.faces());
            let pushes = schedule.play(&ordered, size).expect("the schedule can be played");
            prop_assert_eq!(pushes, schedule.pushes());
            prop_assert!(cache::misses(&ordered, CacheModel::controllable(size)) <= pushes);
            prop_assert!(pushes >= cache::report(&ordered, algorithm.cache).used_vertices as u64);
        } else {
            prop_assert!(schedule.events.is_empty());
        }
    }

    #[test]
    fn faithful_orders_are_permutations(mesh in meshes::any_mesh(), algorithm in algorithm()) {
        let algorithm = KCacheReorder { mode: Mode::Faithful, ..on_mesh(&algorithm, &mesh) };
        let order = algorithm.face_order(&mesh);
        prop_assert!(order.rotations().is_empty());
        assert_reorders(&mesh, &order);
        prop_assert_eq!(algorithm.face_order(&mesh), order);
    }

    #[test]
    fn baselines_are_permutations(
        mesh in meshes::any_mesh(),
        size in cache_size(),
        seed in any::<u64>(),
    ) {
        let tipsify = baselines::tipsify(&mesh, size);
        assert_misses_in_range(&assert_reorders(&mesh, &tipsify), size);
        prop_assert_eq!(baselines::tipsify(&mesh, size), tipsify);
        let linear_speed = baselines::linear_speed(&mesh);
        prop_assert!(linear_speed.rotations().is_empty());
        assert_misses_in_range(&assert_reorders(&mesh, &linear_speed), size);
        prop_assert_eq!(baselines::linear_speed(&mesh), linear_speed);
        let random = baselines::random(mesh.face_count(), seed);
        prop_assert_eq!(&baselines::random(mesh.face_count(), seed), &random);
        assert_misses_in_range(&assert_reorders(&mesh, &random.into()), size);
    }

    #[test]
    fn vertices_by_first_use_are_all_there(mesh in meshes::any_mesh(), size in cache_size()) {
        let order = vertex_fetch(&mesh);
        prop_assert_eq!(order.len(), mesh.vertex_count());
        let permutation = Permutation::new(order.new_to_old().to_vec()).expect("a permutation");
        let renumbered = order.renumber(mesh.faces());
        // Each new number is at most one past all before it: vertices are met in their order.
        let mut met = 0;
        for &vertex in renumbered.as_flattened() {
            prop_assert!(vertex <= met);
            met = met.max(vertex + 1);
        }
        let back = meshweft::VertexOrder::from(permutation.inverse());
        prop_assert_eq!(&back.renumber(&renumbered), mesh.faces());
        // What a cache sees does not depend on numbers.
        for model in [
            CacheModel::fifo(size),
            CacheModel::lru(size),
            CacheModel::controllable(size),
            CacheModel::AMD,
        ] {
            let before = cache::misses(mesh.faces(), model);
            prop_assert_eq!(cache::misses(&renumbered, model), before);
        }
    }

    #[test]
    fn replays_agree_with_plain_ones(mesh in meshes::any_mesh(), size in cache_size()) {
        let faces = mesh.faces();
        assert_misses_in_range(faces, size);
        let fifo = cache::misses(faces, CacheModel::fifo(size));
        prop_assert_eq!(fifo, replay::fifo_by_index(faces, size));
        let lru = cache::misses(faces, CacheModel::lru(size));
        prop_assert_eq!(lru, replay::lru_by_index(faces, size));
    }

    #[test]
    fn a_larger_lru_cache_never_misses_more(mesh in meshes::any_mesh(), size in cache_size()) {
        let misses = |size| cache::misses(mesh.faces(), CacheModel::lru(size));
        prop_assert!(misses(size + 1) <= misses(size));
        prop_assert!(misses(2 * size) <= misses(size + 1));
        let belady = |size| cache::misses(mesh.faces(), CacheModel::controllable(size));
        prop_assert!(belady(size + 1) <= belady(size));
    }

    /// A hardware FIFO may drop a corner of the face that it is drawing; a controllable cache holds
    /// the three together. Two more entries hold what was dropped, so only then is it never worse.
    #[test]
    fn belady_needs_no_more_than_other_caches(mesh in meshes::any_mesh(), size in cache_size()) {
        let faces = mesh.faces();
        let belady = |size| cache::misses(faces, CacheModel::controllable(size));
        prop_assert!(belady(size) <= cache::misses(faces, CacheModel::lru(size)));
        prop_assert!(belady(size) <= replay::fifo_with_whole_faces(faces, size));
        prop_assert!(belady(size + 2) <= cache::misses(faces, CacheModel::fifo(size)));
    }
}

/// The smallest case in which a FIFO cache misses less than a controllable one of its size: the
/// second face pushes its first corner out, and the third has no use for that one.
#[test]
fn a_fifo_that_drops_a_corner_of_its_face_can_miss_less() {
    let faces = [[0, 1, 2], [0, 3, 4], [2, 3, 4]];
    assert_eq!(cache::misses(&faces, CacheModel::fifo(3)), 5);
    assert_eq!(cache::misses(&faces, CacheModel::controllable(3)), 6);
}
