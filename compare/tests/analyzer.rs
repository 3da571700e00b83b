//! Our counts equal meshoptimizer's analyzer to the miss, and a replay written a third time.

use std::collections::VecDeque;

use compare::rivals::{bytes_fetched, vertices_transformed};
use meshweft::cache::{self, BatchModel};
use meshweft::order::{KCacheReorder, baselines, vertex_fetch};
use meshweft::{CacheModel, Mesh};

/// The cache as a queue of vertices, searched from end to end.
fn replayed(faces: &[[u32; 3]], model: BatchModel) -> u64 {
    let mut queue: VecDeque<u32> = VecDeque::new();
    let (mut misses, mut batch_misses, mut batch_faces) = (0, 0, 0);
    for face in faces {
        let missing = face.iter().filter(|vertex| !queue.contains(vertex)).count();
        let is_full = model.batch_faces() != 0 && batch_faces == model.batch_faces();
        let is_over =
            model.batch_vertices() != 0 && batch_misses + missing > model.batch_vertices() as usize;
        if is_full || is_over {
            queue.clear();
            (batch_misses, batch_faces) = (0, 0);
        }
        for &vertex in face {
            if queue.contains(&vertex) {
                continue;
            }
            if queue.len() == model.cache_size() as usize {
                queue.pop_front();
            }
            queue.push_back(vertex);
            misses += 1;
            batch_misses += 1;
        }
        batch_faces += 1;
    }
    misses
}

fn fifo(size: u32) -> BatchModel {
    BatchModel::new(size, 0, 0)
}

#[track_caller]
fn assert_same_misses(mesh: &Mesh, model: BatchModel) {
    let faces = mesh.faces();
    let theirs = vertices_transformed(mesh, model);
    assert_eq!(cache::misses(faces, CacheModel::Batch(model)), theirs);
    assert_eq!(replayed(faces, model), theirs, "the test's own replay");
    if model.batch_vertices() == 0 && model.batch_faces() == 0 {
        let ours = cache::misses(faces, CacheModel::fifo(model.cache_size()));
        assert_eq!(ours, theirs);
    }
}

#[track_caller]
fn assert_same_fetches(mesh: &Mesh, vertex_size: usize) {
    let faces = mesh.faces();
    let theirs = bytes_fetched(mesh, vertex_size);
    let stored = used_vertices(faces) * vertex_size;
    let expected = match stored {
        0 => 0.0,
        _ => theirs as f64 / stored as f64,
    };
    assert_eq!(cache::overfetch(faces, vertex_size), expected);
    let report = cache::report(faces, CacheModel::fifo(16));
    assert_eq!(report.used_vertices * vertex_size, stored);
    if stored != 0 {
        let misses = vertices_transformed(mesh, fifo(16)) as f64;
        assert_eq!(report.acmr(), misses / faces.len() as f64);
        assert_eq!(report.atvr(), misses / (stored / vertex_size) as f64);
    }
}

fn used_vertices(faces: &[[u32; 3]]) -> usize {
    let mut used = faces.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    used.len()
}

const GPUS: [BatchModel; 3] = [
    BatchModel::MESHOPT_NVIDIA,
    BatchModel::AMD,
    BatchModel::INTEL,
];

/// Numbers below a bound, the same in every run (xorshift by George Marsaglia).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        u32::try_from((self.0 >> 32) % u64::from(bound)).unwrap()
    }
}

#[test]
fn ten_thousand_random_cases_agree() {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    for _ in 0..10_000 {
        let vertex_count = 1 + numbers.below(60);
        let face_count = numbers.below(201);
        // Half of the cases stay near the face before, so that caches have something to hit.
        let spread = match numbers.below(2) {
            0 => vertex_count,
            _ => vertex_count.min(1 + numbers.below(8)),
        };
        let faces: Vec<[u32; 3]> = (0..face_count)
            .map(|face| {
                [(); 3].map(|()| (face * vertex_count / 201 + numbers.below(spread)) % vertex_count)
            })
            .collect();
        let mesh = Mesh::connectivity_only(vertex_count as usize, faces).unwrap();
        let own = BatchModel::new(
            3 + numbers.below(68),
            [0, 3 + numbers.below(70)][numbers.below(2) as usize],
            numbers.below(40),
        );
        assert_same_misses(&mesh, fifo(3 + numbers.below(68)));
        assert_same_misses(&mesh, own);
        for gpu in GPUS {
            assert_same_misses(&mesh, gpu);
        }
        let vertex_size = 1 + numbers.below(256) as usize;
        assert_same_fetches(&mesh, vertex_size);
    }
}

#[test]
fn every_real_mesh_agrees_in_every_order() {
    compare::for_each_mesh("analyzer", |_, mesh| {
        assert_agreement(mesh);
        for size in [12, 16, 32] {
            let algorithm = KCacheReorder {
                cache: CacheModel::fifo(size),
                ..Default::default()
            };
            let ordered = mesh.with_face_order(&algorithm.face_order(mesh));
            assert_agreement(&ordered);
            let by_use = vertex_fetch(&ordered);
            assert_same_fetches(&ordered.with_vertex_order(&by_use), 32);
        }
    });
}

fn assert_agreement(mesh: &Mesh) {
    for size in [10, 12, 16, 24, 32, 64] {
        assert_same_misses(mesh, fifo(size));
    }
    for gpu in GPUS {
        assert_same_misses(mesh, gpu);
    }
    for vertex_size in [12, 32, 48] {
        assert_same_fetches(mesh, vertex_size);
    }
}

#[test]
fn shuffled_faces_agree() {
    let faces: Vec<[u32; 3]> = (0..5000).map(|i| [i, i + 1, i + 2]).collect();
    let shuffled = baselines::random(faces.len(), 3).apply(&faces);
    let shuffled = Mesh::connectivity_only(5002, shuffled).unwrap();
    for gpu in GPUS {
        assert_same_misses(&shuffled, gpu);
    }
    // Enough records to wrap the 128 KiB of the fetch cache.
    assert_same_fetches(&shuffled, 200);
}
