//! What holds on every walk between levels, whichever way it went.

use super::made::{boxed, hills, somewhere};
use super::{CheckpointWalk, Checkpoints, Collapses, IndexBuffer, ProgressiveMesh, Walk};
use crate::attribute::{Attribute, Semantic};
use crate::faces::Faces;
use crate::order::{Effort, KCacheReorder, Optimizer, Target, baselines};
use crate::random::SplitMix64;
use crate::{CacheModel, Mesh, cache};

/// Caches in which a degenerate face of the vertex that was drawn last is free.
const CACHES: [CacheModel; 5] = [
    CacheModel::fifo(3),
    CacheModel::fifo(16),
    CacheModel::lru(3),
    CacheModel::lru(16),
    CacheModel::controllable(12),
];

/// The faces of each level, sorted; histories have the same (`tests`).
fn levels(mesh: &ProgressiveMesh) -> Vec<Vec<[u32; 3]>> {
    let mut walk = Walk::new(mesh);
    let each = (0..=mesh.last_level()).map(|level| {
        walk.go_to(level);
        let mut faces = Vec::new();
        walk.emit(&mut faces);
        faces.sort_unstable();
        faces
    });
    each.collect()
}

/// A walk of a number of steps, and back to full resolution.
fn walk(checkpoints: &Checkpoints<'_>, levels: &[Vec<[u32; 3]>], steps: usize, seed: u64) {
    let mesh = checkpoints.mesh;
    let mut random = SplitMix64(seed);
    let (mut walk, mut stored) = (Walk::new(mesh), CheckpointWalk::new(checkpoints));
    let gap = random.below(4);
    let mut buffer = IndexBuffer::new(checkpoints).with_gap(gap);
    let (mut faces, mut in_order, mut start) = (Vec::new(), Vec::new(), Vec::new());
    stored.emit(&mut start);
    assert_eq!(buffer.faces(), start);

    let mut uploaded = buffer.faces().to_vec();
    for step in 0..=steps {
        // Far, near, or home.
        let level = match (step == steps, random.below(3)) {
            (true, _) => 0,
            (_, 0) => random.below(levels.len()),
            _ => (walk.level() + random.below(9))
                .saturating_sub(4)
                .min(levels.len() - 1),
        };
        walk.go_to(level);
        let is_other = stored.go_to(level);
        walk.emit(&mut faces);
        stored.emit(&mut in_order);

        // Exactly the faces of that level, each once; those of the mesh in its own sequence.
        let numbers = 0..u32::try_from(mesh.faces().len()).unwrap();
        let present = numbers.filter(|&face| walk.has(face));
        assert!(
            faces
                .iter()
                .copied()
                .eq(present.map(|face| walk.face(face)))
        );
        for faces in [&faces, &in_order] {
            let mut faces = faces.clone();
            faces.sort_unstable();
            assert_eq!(faces, levels[level], "level {level}");
        }

        // The buffer has them too, at places between which others left; what it reports is what changed.
        let changed = buffer.go_to(level).to_vec();
        assert!(
            changed
                .windows(2)
                .all(|pair| pair[0].end + gap < pair[1].start)
        );
        if is_other {
            assert_eq!(changed.len(), 1);
            assert_eq!(changed[0], 0..buffer.faces().len());
            uploaded = buffer.faces().to_vec();
        }
        for range in changed {
            let ends = [range.start, range.end - 1];
            let is_changed = |place: usize| uploaded[place] != buffer.faces()[place];
            assert!(is_other || ends.into_iter().all(is_changed));
            uploaded[range.clone()].copy_from_slice(&buffer.faces()[range]);
        }
        assert_eq!(uploaded, buffer.faces());
        let places = (0..uploaded.len()).filter(|&place| buffer.is_live(place));
        assert!(
            places
                .map(|place| uploaded[place])
                .eq(in_order.iter().copied())
        );
        if !in_order.is_empty() {
            let misses = |faces| {
                let faces = Faces::new(faces, mesh.vertex_count()).unwrap();
                cache::misses_of(faces, &CACHES)
            };
            assert_eq!(misses(&uploaded), misses(&in_order), "level {level}");
        }
    }
    assert_eq!(faces, mesh.faces());
    assert_eq!((in_order.as_slice(), buffer.faces()), (&*start, &*start));
}

/// Walks with checkpoints of several kinds.
fn walks(mesh: &ProgressiveMesh, steps: usize, seed: u64) {
    let levels = levels(mesh);
    let cache = CacheModel::fifo(11);
    let greedy = KCacheReorder {
        cache,
        ..KCacheReorder::default()
    };
    let ratio = [0.2, 0.5, 0.8, 0.97][SplitMix64(seed).below(4)];
    let optimizer = Optimizer {
        target: [cache.into(), Target::Universal][SplitMix64(seed).below(2)],
        effort: [Effort::Fast, Effort::Best][SplitMix64(seed + 1).below(2)],
        ..Optimizer::default()
    };
    let checkpoints = [
        Checkpoints::new(mesh, ratio, |faces| greedy.face_order(faces)).unwrap(),
        Checkpoints::new(mesh, ratio, |faces| {
            baselines::random(faces.len(), 1).into()
        })
        .unwrap(),
        Checkpoints::optimized(mesh, ratio, &optimizer),
    ];
    for checkpoints in &checkpoints {
        walk(checkpoints, &levels, steps, seed);
    }
}

#[test]
fn walks_over_a_sheet() {
    let progressive = Collapses::default().build(&hills(20, 20), &[]).unwrap();
    walks(&progressive, 600, 1);
    walks(&progressive, 600, 2);
}

#[test]
fn walks_over_seams() {
    let (mesh, attributes) = boxed(6);
    let progressive = Collapses::default().build(&mesh, &attributes).unwrap();
    walks(&progressive, 600, 3);
    walks(&progressive, 600, 4);
}

#[test]
fn walks_over_parts_that_leave() {
    // Sheets of several sizes, beside each other.
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for size in 1..12_u32 {
        let sheet = hills(size, 3);
        let first = u32::try_from(positions.len()).unwrap();
        let aside = |&[x, y, z]: &[f32; 3]| [x, y + 10.0 * size as f32, z];
        positions.extend(sheet.positions().iter().map(aside));
        faces.extend(sheet.faces().iter().map(|face| face.map(|v| v + first)));
    }
    let mesh = Mesh::new(positions, faces).unwrap();
    let settings = Collapses {
        drop_parts: true,
        ..Collapses::default()
    };
    let progressive = settings.build(&mesh, &[]).unwrap();
    walks(&progressive, 600, 5);
    walks(&progressive, 600, 6);
}

#[test]
fn walks_over_soups() {
    let mut random = SplitMix64(7);
    for round in 0..200 {
        let vertices = 1 + random.below(12);
        let faces: Vec<[u32; 3]> = (0..random.below(40))
            .map(|_| [(); 3].map(|()| u32::try_from(random.below(vertices)).unwrap()))
            .collect();
        let places = somewhere(1 + random.below(vertices), round);
        let positions: Vec<_> = (0..vertices)
            .map(|_| places[random.below(places.len())])
            .collect();
        let ids: Vec<[f32; 1]> = (0..vertices).map(|_| [random.below(2) as f32]).collect();
        let attributes = [Attribute::of_vertices(Semantic::TexCoord(0), &ids)];
        let settings = Collapses {
            drop_parts: random.below(2) == 0,
            ..Collapses::default()
        };
        let mesh = Mesh::new(positions, faces).unwrap();
        let progressive = settings.build(&mesh, &attributes).unwrap();
        walks(&progressive, 20, round);
    }
}

#[test]
fn a_vertex_less_of_any_single_cache() {
    let progressive = Collapses::default().build(&hills(9, 9), &[]).unwrap();
    for target in [
        "fifo:3",
        "fifo:12",
        "lru:3",
        "lru:16",
        "controllable:3",
        "nvidia",
        "universal",
    ] {
        let optimizer = Optimizer {
            target: target.parse().unwrap(),
            ..Optimizer::default()
        };
        let checkpoints = Checkpoints::optimized(&progressive, 0.5, &optimizer);
        assert!(checkpoints.levels().len() > 4, "{target}");
    }
}
