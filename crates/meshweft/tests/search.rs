//! What holds for every target and effort, on meshes that nobody would model.

mod meshes;

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use meshweft::cache::{self, BatchModel, Schedule};
use meshweft::order::{Effort, Optimizer, Target, baselines};
use meshweft::{Budget, CacheModel, FaceOrder, Mesh, Permutation, Progress};
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

fn target() -> impl Strategy<Value = Target> {
    let size = prop_oneof![6 => 3_u32..=40, 1 => 41_u32..=1024];
    let batch = (3_u32..=200, 0_u32..=70, 0_u32..=140);
    prop_oneof![
        2 => Just(Target::Universal),
        3 => size.clone().prop_map(|size| CacheModel::fifo(size).into()),
        1 => size.clone().prop_map(|size| CacheModel::lru(size).into()),
        2 => size.prop_map(|size| CacheModel::controllable(size).into()),
        2 => prop::sample::select(vec![CacheModel::Nvidia, CacheModel::AMD, CacheModel::INTEL])
            .prop_map(Target::from),
        1 => batch.prop_map(|(cache_size, batch_vertices, batch_faces)| {
            let batch_vertices = if batch_vertices < 3 { 0 } else { batch_vertices };
            CacheModel::Batch(BatchModel::new(cache_size, batch_vertices, batch_faces)).into()
        }),
    ]
}

prop_compose! {
    fn optimizer()(
        target in target(),
        effort in prop::sample::select(vec![Effort::Fast, Effort::Best, Effort::Best, Effort::Max]),
        seed in any::<u64>(),
        keep_corners in any::<bool>(),
    ) -> Optimizer {
        Optimizer { target, effort, seed, keep_corners, budget: Budget::Unlimited }
    }
}

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 300,
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("regressions"))),
        ..ProptestConfig::default()
    }
}

fn assert_reorders(mesh: &Mesh, order: &FaceOrder) {
    let permutation = Permutation::new(order.new_to_old().to_vec()).expect("a permutation");
    assert_eq!(permutation.len(), mesh.face_count());
    assert!(order.rotations().iter().all(|&rotation| rotation < 3));
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn orders_are_permutations(mesh in meshes::any_mesh(), optimizer in optimizer()) {
        let order = optimizer.face_order(&mesh);
        assert_reorders(&mesh, &order);
        if optimizer.keep_corners {
            prop_assert!(order.rotations().iter().all(|&rotation| rotation == 0));
        }
        prop_assert_eq!(optimizer.face_order(&mesh), order);
    }

    #[test]
    fn polygons_stay_whole(
        mesh in meshes::any_mesh(),
        optimizer in optimizer(),
        sizes in prop::collection::vec(0_u32..5, 0..400),
    ) {
        let face_count = u32::try_from(mesh.face_count()).unwrap();
        let mut starts = vec![0];
        for size in sizes {
            starts.push((starts[starts.len() - 1] + size).min(face_count));
        }
        starts.push(face_count);
        let order = optimizer.polygon_order(&mesh, &starts);
        assert_reorders(&mesh, &order);
        prop_assert!(order.rotations().iter().all(|&rotation| rotation == 0));
        let mut place = 0;
        while place < order.len() {
            let first = order.new_to_old()[place];
            let polygon = starts.partition_point(|&start| start <= first) - 1;
            for face in starts[polygon]..starts[polygon + 1] {
                prop_assert_eq!(order.new_to_old()[place], face);
                place += 1;
            }
        }
    }

    #[test]
    fn the_best_schedule_plays(mesh in meshes::any_mesh(), size in 3_u32..40) {
        let schedule = Schedule::fewest_pushes(mesh.faces(), size);
        let misses = cache::misses(mesh.faces(), CacheModel::controllable(size));
        prop_assert_eq!(schedule.play(mesh.faces(), size), Ok(misses));
    }
}

/// A square grid of `side` × `side` squares, shuffled.
fn shuffled_grid(side: u32) -> Mesh {
    let square = |i: u32| {
        let corner = i / side * (side + 1) + i % side;
        let above = corner + side + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let faces: Vec<[u32; 3]> = (0..side * side).flat_map(square).collect();
    let faces = baselines::random(faces.len(), 1).apply(&faces);
    Mesh::connectivity_only(((side + 1) * (side + 1)) as usize, faces).unwrap()
}

#[test]
fn more_effort_misses_less() {
    let mesh = shuffled_grid(60);
    for target in [
        Target::Universal,
        CacheModel::fifo(12).into(),
        CacheModel::fifo(32).into(),
        CacheModel::controllable(12).into(),
        CacheModel::Nvidia.into(),
        CacheModel::AMD.into(),
    ] {
        let misses = [Effort::Fast, Effort::Best].map(|effort| {
            let optimizer = Optimizer {
                target,
                effort,
                ..Optimizer::default()
            };
            target.misses(&optimizer.face_order(&mesh).apply(mesh.faces()))
        });
        assert!(misses[1] < misses[0], "{target}: {misses:?}");
    }
}

#[test]
fn threads_do_not_matter() {
    let mesh = shuffled_grid(260);
    let optimizer = Optimizer {
        effort: Effort::Fast,
        ..Optimizer::default()
    };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| optimizer.face_order(&mesh))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn seeds_matter_to_a_search() {
    let mesh = shuffled_grid(40);
    let on = |seed| {
        let optimizer = Optimizer {
            effort: Effort::Best,
            seed,
            ..Optimizer::for_cache(CacheModel::fifo(16))
        };
        optimizer.face_order(&mesh)
    };
    assert_ne!(on(1), on(2));
}

/// A caller with a clock that is over by a hundredth at each look.
#[derive(Default)]
struct Hurried {
    looks: AtomicUsize,
}

impl Progress for Hurried {
    fn time_spent(&self) -> Option<f64> {
        Some(self.looks.fetch_add(1, Ordering::Relaxed) as f64 / 100.0)
    }
}

/// A caller who stops at the first report.
#[derive(Default)]
struct Stopping {
    reports: AtomicUsize,
}

impl Progress for Stopping {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        assert!((0.0..=1.0).contains(&fraction));
        self.reports.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Break(())
    }
}

/// One cache, the most effort: a search and nothing else.
fn thorough(budget: Budget) -> Optimizer {
    Optimizer {
        effort: Effort::Max,
        budget,
        ..Optimizer::for_cache(CacheModel::fifo(16))
    }
}

#[test]
fn a_caller_with_a_clock_gets_an_order_in_its_time() {
    let mesh = shuffled_grid(40);
    let caller = Hurried::default();
    let order = Optimizer::default().face_order_with(&mesh, None, &caller);
    assert_reorders(&mesh, &order);
    assert!(caller.looks.into_inner() > 10, "it looked at the clock");
    let greedy = Optimizer::for_cache(CacheModel::fifo(12));
    assert_ne!(
        greedy.face_order_with(&mesh, None, &Hurried::default()),
        greedy.face_order(&mesh),
        "with time it searches"
    );
}

#[test]
fn what_is_stopped_is_whole_all_the_same() {
    let mesh = shuffled_grid(60);
    let caller = Stopping::default();
    let order = thorough(Budget::Unlimited).face_order_with(&mesh, None, &caller);
    assert_reorders(&mesh, &order);
    assert!(caller.reports.into_inner() > 0, "it was heard of");
    assert_ne!(order, thorough(Budget::Unlimited).face_order(&mesh));
}

#[test]
fn a_budget_of_steps_is_kept_and_repeatable() {
    let mesh = shuffled_grid(40);
    let order = |steps| thorough(Budget::Steps(steps)).face_order(&mesh);
    let misses = |steps| cache::misses(&order(steps).apply(mesh.faces()), CacheModel::fifo(16));
    for steps in [0, 1, 10, 100] {
        assert_reorders(&mesh, &order(steps));
        assert_eq!(order(steps), order(steps));
    }
    assert_ne!(order(0), order(10));
    assert!(misses(100) < misses(0), "steps are worth something");
    let unlimited = thorough(Budget::Unlimited).face_order(&mesh);
    assert_eq!(order(u64::MAX), unlimited);
    // A step draws a vertex at least.
    assert_eq!(order(41 * 41), unlimited);
}

#[test]
fn targets_are_read_as_they_are_written() {
    for name in [
        "universal",
        "fifo:12",
        "lru:32",
        "controllable:9",
        "nvidia",
        "amd",
        "intel",
        "batch:20/0/9",
    ] {
        assert_eq!(name.parse::<Target>().unwrap().to_string(), name);
    }
    let error = "universe".parse::<Target>().unwrap_err().to_string();
    assert!(error.contains("or universal"), "{error}");
}
