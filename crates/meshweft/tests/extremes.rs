//! Meshes at the edges of what there is: huge valences, thousands of parts, nothing at all.
//!
//! Nothing is timed here, but every order that is not linear would be noticed.

use meshweft::order::{KCacheReorder, Mode, baselines, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Mesh, Permutation, cache};

const CACHES: [CacheModel; 6] = [
    CacheModel::fifo(3),
    CacheModel::fifo(12),
    CacheModel::fifo(1024),
    CacheModel::controllable(3),
    CacheModel::controllable(12),
    CacheModel::controllable(64),
];

fn mesh(vertex_count: u32, faces: Vec<[u32; 3]>) -> Mesh {
    Mesh::connectivity_only(vertex_count as usize, faces).unwrap()
}

/// Each order that is linear in the number of faces, checked; with its cache.
fn linear_orders(mesh: &Mesh) -> Vec<(CacheModel, FaceOrder)> {
    let fast = |cache: CacheModel| {
        let algorithm = KCacheReorder {
            cache,
            ..Default::default()
        };
        let (order, schedule) = algorithm.schedule(mesh);
        if matches!(cache, CacheModel::Controllable { .. }) {
            let ordered = order.apply(mesh.faces());
            assert_eq!(schedule.play(&ordered, cache.size()), Ok(schedule.pushes()));
        }
        (cache, order)
    };
    let mut orders: Vec<_> = CACHES.map(fast).into();
    orders.push((CacheModel::fifo(16), baselines::tipsify(mesh, 16)));
    orders.push((CacheModel::fifo(16), baselines::linear_speed(mesh)));
    for (cache, order) in &orders {
        assert_eq!(order.len(), mesh.face_count(), "{cache}");
        assert!(
            Permutation::new(order.new_to_old().to_vec()).is_ok(),
            "{cache}"
        );
    }
    let fetch = vertex_fetch(mesh);
    assert_eq!(fetch.len(), mesh.vertex_count());
    orders
}

fn faithful_orders(mesh: &Mesh) {
    for cache in [CacheModel::fifo(3), CacheModel::controllable(12)] {
        let algorithm = KCacheReorder {
            cache,
            mode: Mode::Faithful,
            ..Default::default()
        };
        let order = algorithm.face_order(mesh);
        assert!(
            Permutation::new(order.new_to_old().to_vec()).is_ok(),
            "{cache}"
        );
    }
}

/// The faces of a closed fan around vertex 0 with the rim 1 to `rim`.
fn closed_fan(rim: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..rim).map(move |i| [0, 1 + i, 1 + (i + 1) % rim])
}

const MILLION: u32 = 1_000_000;

#[test]
fn a_fan_of_a_million_faces() {
    let faces: Vec<_> = closed_fan(MILLION).collect();
    let in_file_order = mesh(MILLION + 1, faces.clone());
    for (cache, order) in linear_orders(&in_file_order) {
        let misses = cache::misses(&order.apply(in_file_order.faces()), cache);
        // All but a few faces share an edge with the face before.
        assert!(misses < u64::from(MILLION) * 3 / 2, "{cache}: {misses}");
    }
    let shuffled = baselines::random(faces.len(), 1).apply(&faces);
    linear_orders(&mesh(MILLION + 1, shuffled));
}

/// While a hub is drawn in a random order it leaves the cache and enters it again all the time.
#[test]
fn a_hub_that_enters_again_and_again() {
    for (rim, seed) in [(353, 1), (370, 0), (442, 2), (3110, 0), (6560, 0)] {
        let faces: Vec<_> = closed_fan(rim).collect();
        let shuffled = baselines::random(faces.len(), seed).apply(&faces);
        let mesh = mesh(rim + 1, shuffled);
        for size in [3, 4, 6, 12, 16] {
            for keep_corners in [false, true] {
                let algorithm = KCacheReorder {
                    cache: CacheModel::fifo(size),
                    keep_corners,
                    ..Default::default()
                };
                let order = algorithm.face_order(&mesh);
                let ordered = order.apply(mesh.faces());
                let misses = cache::misses(&ordered, algorithm.cache);
                assert!(misses >= u64::from(rim + 1), "fifo:{size}");
            }
        }
    }
}

#[test]
fn a_bipyramid_over_a_million_vertices() {
    let upper: Vec<_> = closed_fan(MILLION).collect();
    let lower = upper.iter().map(|&[_, a, b]| [MILLION + 1, b, a]);
    let faces: Vec<_> = upper.iter().copied().chain(lower).collect();
    let in_file_order = mesh(MILLION + 2, faces.clone());
    linear_orders(&in_file_order);
    let shuffled = baselines::random(faces.len(), 1).apply(&faces);
    linear_orders(&mesh(MILLION + 2, shuffled));
}

#[test]
fn thirteen_thousand_parts() {
    // A quad each, with four vertices of its own.
    let quad = |part: u32| {
        let v = 4 * part;
        [[v, v + 1, v + 2], [v + 2, v + 1, v + 3]]
    };
    let faces: Vec<_> = (0..13_000).flat_map(quad).collect();
    let shuffled = baselines::random(faces.len(), 1).apply(&faces);
    let mesh = mesh(52_000, shuffled);
    for (cache, order) in linear_orders(&mesh) {
        if cache.size() > 3 {
            let misses = cache::misses(&order.apply(mesh.faces()), cache);
            assert_eq!(misses, 52_000, "{cache}");
        }
    }
    faithful_orders(&mesh);
}

#[test]
fn all_faces_the_same() {
    for face in [[0, 1, 2], [1, 1, 1], [2, 0, 2]] {
        let mesh = mesh(3, vec![face; 5000]);
        for (cache, order) in linear_orders(&mesh) {
            let used = cache::report(mesh.faces(), cache).used_vertices as u64;
            let misses = cache::misses(&order.apply(mesh.faces()), cache);
            assert_eq!(misses, used, "{cache}");
        }
        faithful_orders(&mesh);
    }
}

#[test]
fn a_cache_that_holds_one_face_and_one_that_holds_all() {
    let strip: Vec<_> = (0..900).map(|i| [i, i + 1, i + 2]).collect();
    let shuffled = baselines::random(strip.len(), 1).apply(&strip);
    let mesh = mesh(902, shuffled);
    for (cache, order) in linear_orders(&mesh) {
        let misses = cache::misses(&order.apply(mesh.faces()), cache);
        assert!(misses >= 902, "{cache}");
        if cache.size() == 1024 {
            assert_eq!(misses, 902, "{cache}");
        }
    }
    faithful_orders(&mesh);
}

#[test]
fn no_faces_and_no_vertices() {
    for vertex_count in [0, 1, 5] {
        let mesh = mesh(vertex_count, vec![]);
        for (_, order) in linear_orders(&mesh) {
            assert!(order.is_empty());
        }
        faithful_orders(&mesh);
    }
}
