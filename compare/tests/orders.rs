//! Every order is a permutation of the faces: of every real mesh, and of ten thousand soups.

use meshweft::order::baselines::{linear_speed, random, tipsify};
use meshweft::order::bogomjakov_gotsman::{Cutter, LinearArrangement, RecursiveCut};
use meshweft::order::{Effort, KCacheReorder, Mode, Optimizer, Target};
use meshweft::{CacheModel, FaceOrder, Mesh, Permutation};

const TARGETS: [Target; 7] = [
    Target::Universal,
    Target::Cache(CacheModel::fifo(12)),
    Target::Cache(CacheModel::fifo(32)),
    Target::Cache(CacheModel::controllable(12)),
    Target::Cache(CacheModel::Nvidia),
    Target::Cache(CacheModel::AMD),
    Target::Cache(CacheModel::INTEL),
];

fn check(name: &str, method: &str, mesh: &Mesh, order: &FaceOrder) {
    assert_eq!(order.len(), mesh.face_count(), "{name}, {method}");
    let new_to_old = order.new_to_old().to_vec();
    assert!(Permutation::new(new_to_old).is_ok(), "{name}, {method}");
    for (face, &old) in order.apply(mesh.faces()).iter().zip(order.new_to_old()) {
        let [a, b, c] = mesh.faces()[old as usize];
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        assert!(turned.contains(face), "{name}, {method}");
    }
}

fn check_all(name: &str, mesh: &Mesh, efforts: &[Effort]) {
    check(name, "Tipsify", mesh, &tipsify(mesh, 12));
    check(name, "linear-speed", mesh, &linear_speed(mesh));
    for cutter in [Cutter::Multilevel, Cutter::Metis] {
        let algorithm = RecursiveCut {
            cutter,
            ..RecursiveCut::default()
        };
        check(name, "recursive cut", mesh, &algorithm.face_order(mesh));
    }
    let arrangement = LinearArrangement::default().face_order(mesh);
    check(name, "linear arrangement", mesh, &arrangement);
    for &effort in efforts {
        for target in TARGETS {
            let optimizer = Optimizer {
                target,
                effort,
                ..Optimizer::default()
            };
            let order = optimizer.face_order(mesh);
            check(name, &format!("{target}, {effort:?}"), mesh, &order);
        }
    }
}

#[test]
fn of_every_mesh() {
    compare::for_each_mesh("every order", |name, mesh| {
        check_all(name, mesh, &[Effort::Fast]);
    });
}

#[test]
fn of_ten_thousand_soups() {
    for seed in 0..10_000_u64 {
        let draws = random(512, seed);
        let draws = draws.new_to_old();
        let (vertices, faces) = (3 + draws[0] % 60, draws[1] as usize % 160);
        let corners: Vec<_> = draws[2..]
            .chunks_exact(3)
            .take(faces)
            .map(|c| [c[0], c[1], c[2]].map(|v| v % vertices))
            .collect();
        let mesh = Mesh::connectivity_only(vertices as usize, corners).unwrap();
        let name = format!("soup {seed}");
        check_all(&name, &mesh, &[Effort::Fast, Effort::Best]);
        for mode in [Mode::Fast, Mode::Faithful] {
            let algorithm = KCacheReorder {
                mode,
                ..KCacheReorder::default()
            };
            check(
                &name,
                "K-Cache-Reorder",
                &mesh,
                &algorithm.face_order(&mesh),
            );
        }
    }
    compare::say("every order: 10000 soups");
}
