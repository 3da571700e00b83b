//! Any bytes as settings and faces: every order is a permutation, and every schedule plays.
//!
//! Byte 0 and 1: cache size. Byte 2: vertex count less one. Byte 3: bit 0 keeps the corners, bit 1
//! lets byte 4 choose the first focus, bit 2 makes each of the first 24 faces a fan of 64, so that few
//! bytes make a hub, bits 3 to 5 choose what a search is for. Byte 5 to 7: weights in quarters. Then three bytes a face.
#![no_main]

use libfuzzer_sys::fuzz_target;
use meshweft::order::bogomjakov_gotsman::{LinearArrangement, RecursiveCut};
use meshweft::order::{Effort, KCacheReorder, Mode, Optimizer, Target, baselines, vertex_fetch};
use meshweft::{Budget, CacheModel, FaceOrder, Mesh, Permutation, cache};

fuzz_target!(|data: &[u8]| {
    let Some((settings, corners)) = data.split_first_chunk::<8>() else {
        return;
    };
    let [size_low, size_high, vertices, flags, focus, weights @ ..] = *settings;
    let size = 3 + u32::from(u16::from_le_bytes([size_low, size_high]) % 1022);
    let mesh = mesh(corners, u32::from(vertices) + 1, flags & 4 != 0);
    let weights = weights.map(|weight| f64::from(i16::from(weight) - 64) / 4.0);
    let [k1, k2, k3] = weights;
    let first_focus = u32::from(focus) % (u32::from(vertices) + 1);
    let algorithm = |cache, mode| KCacheReorder {
        cache,
        mode,
        k1,
        k2,
        k3,
        keep_corners: flags & 1 != 0,
        first_focus: (flags & 2 != 0).then_some(first_focus),
    };
    let (fifo, controllable) = (CacheModel::fifo(size), CacheModel::controllable(size));
    check_schedule(&mesh, &algorithm(fifo, Mode::Fast));
    check_schedule(&mesh, &algorithm(controllable, Mode::Fast));
    // The faithful mode runs every vertex in the cache at every step.
    if mesh.face_count() <= 200 {
        check_schedule(&mesh, &algorithm(fifo, Mode::Faithful));
        check_schedule(&mesh, &algorithm(controllable, Mode::Faithful));
    }
    check(&mesh, &baselines::tipsify(&mesh, size));
    search(&mesh, size, flags);
    check(&mesh, &RecursiveCut::default().face_order(&mesh));
    check(&mesh, &LinearArrangement::default().face_order(&mesh));
    let by_use = vertex_fetch(&mesh);
    Permutation::new(by_use.new_to_old().to_vec()).expect("each vertex once");
});

fn search(mesh: &Mesh, size: u32, flags: u8) {
    let target = match flags >> 3 & 7 {
        0 => CacheModel::fifo(size).into(),
        1 => CacheModel::lru(size).into(),
        2 => CacheModel::controllable(size).into(),
        3 => CacheModel::Nvidia.into(),
        4 => CacheModel::AMD.into(),
        5 => CacheModel::INTEL.into(),
        _ => Target::Universal,
    };
    for effort in [Effort::Fast, Effort::Best] {
        let optimizer = Optimizer {
            target,
            effort,
            seed: size.into(),
            keep_corners: flags & 1 != 0,
            budget: Budget::Unlimited,
        };
        check(mesh, &optimizer.face_order(mesh));
    }
}

fn mesh(corners: &[u8], vertex_count: u32, fans: bool) -> Mesh {
    let named = corners.chunks_exact(3);
    let faces = named.map(|c| [c[0], c[1], c[2]].map(|v| u32::from(v) % vertex_count));
    let (vertex_count, faces): (u32, Vec<[u32; 3]>) = match fans {
        false => (vertex_count, faces.collect()),
        true => {
            // Around the first corner, over vertices that all fans share.
            let rim = |i: u32| vertex_count + i % 512;
            let fan = |[hub, from, _]: [u32; 3]| {
                (from * 64..from * 64 + 64).map(move |i| [hub, rim(i), rim(i * 7 + 1)])
            };
            (vertex_count + 512, faces.take(24).flat_map(fan).collect())
        }
    };
    Mesh::connectivity_only(vertex_count as usize, faces).expect("indices are in range")
}

fn check(mesh: &Mesh, order: &FaceOrder) {
    assert_eq!(order.len(), mesh.face_count());
    Permutation::new(order.new_to_old().to_vec()).expect("each face once");
    assert!(order.rotations().iter().all(|&rotation| rotation < 3));
}

fn check_schedule(mesh: &Mesh, algorithm: &KCacheReorder) {
    let (order, schedule) = algorithm.schedule(mesh);
    check(mesh, &order);
    let is_fast_fifo =
        matches!(algorithm.cache, CacheModel::Fifo { .. }) && algorithm.mode == Mode::Fast;
    if is_fast_fifo {
        assert!(schedule.events.is_empty());
        return;
    }
    let size = algorithm.cache.size();
    let ordered = order.apply(mesh.faces());
    let pushes = schedule
        .play(&ordered, size)
        .expect("the schedule can be played");
    assert!(cache::misses(&ordered, CacheModel::controllable(size)) <= pushes);
}
