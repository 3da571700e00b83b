#![no_main]
//! Any faces: every order is a permutation, every schedule can be played.

use libfuzzer_sys::fuzz_target;
use meshweft::order::baselines::tipsify;
use meshweft::order::{KCacheReorder, Mode};
use meshweft::{CacheModel, FaceOrder, Mesh, cache};

fuzz_target!(|data: &[u8]| {
    let Some((&[vertices, size, flags], corners)) = data.split_first_chunk() else {
        return;
    };
    let vertex_count = u32::from(vertices) + 1;
    let faces: Vec<[u32; 3]> = corners
        .chunks_exact(3)
        .take(500)
        .map(|c| [c[0], c[1], c[2]].map(|v| u32::from(v) % vertex_count))
        .collect();
    let mesh = Mesh::connectivity_only(vertex_count as usize, faces).expect("in range");
    let size = u32::from(size).max(3);
    let controllable = flags & 1 != 0;
    let algorithm = KCacheReorder {
        cache: match controllable {
            true => CacheModel::controllable(size),
            false => CacheModel::fifo(size),
        },
        mode: if flags & 2 != 0 {
            Mode::Faithful
        } else {
            Mode::Fast
        },
        keep_corners: flags & 4 != 0,
        first_focus: (flags & 8 != 0).then(|| u32::from(flags) % vertex_count),
        ..Default::default()
    };
    let (order, schedule) = algorithm.schedule(&mesh);
    check(&mesh, &order);
    check(&mesh, &tipsify(&mesh, size));
    let ordered = order.apply(mesh.faces());
    let best = cache::misses(&ordered, algorithm.cache);
    if controllable {
        let pushes = schedule.play(&ordered, size).expect("a schedule that fits");
        assert!(best <= pushes);
    }
    assert!(best <= 3 * mesh.face_count() as u64);
});

fn check(mesh: &Mesh, order: &FaceOrder) {
    let least_first = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
    let sorted = |faces: &[[u32; 3]]| {
        let mut sorted: Vec<_> = faces.iter().map(|&face| least_first(face)).collect();
        sorted.sort_unstable();
        sorted
    };
    assert_eq!(sorted(&order.apply(mesh.faces())), sorted(mesh.faces()));
}
