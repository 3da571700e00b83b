//! The index buffer as a card has it, against the faces that live.

use std::collections::BTreeMap;

use super::{EvictionPolicy, FrameMode, GeometryCache, IndexSlots, IndexSlotsError, SlotIndices};
use crate::random::SplitMix64;

/// Faces by number, and the buffers of a card that get what the uploads and patches say.
#[derive(Default)]
struct Scene {
    living: BTreeMap<u32, [u32; 3]>,
    vertices: Vec<Option<u32>>,
    stream: Vec<Option<u32>>,
    indices: Vec<[u32; 3]>,
}

impl Scene {
    /// What is drawn is what lives.
    fn draw(&mut self, cache: &mut GeometryCache, indices: &IndexSlots) {
        let corners = indices.corners();
        let mut expected: Vec<[u32; 3]> = self.living.values().copied().collect();
        expected.sort_unstable();
        let mut drawn = Vec::new();
        let is_streamed = cache.upload().mode() == FrameMode::Streamed;
        let vertices = if is_streamed {
            &mut self.stream
        } else {
            &mut self.vertices
        };
        vertices.resize(
            if is_streamed {
                cache.active().len()
            } else {
                cache.slots()
            },
            None,
        );
        for insert in cache.upload().inserts() {
            vertices[insert.slot as usize] = Some(insert.vertex);
        }

        if cache.upload().mode() == FrameMode::Passes {
            assert!(indices.indices().is_empty());
            let mut passes = cache.passes(corners).unwrap();
            while let Some(pass) = passes.next_pass() {
                for insert in pass.upload().inserts() {
                    vertices[insert.slot as usize] = Some(insert.vertex);
                }
                drawn.extend(pass.indices());
                let places = pass.faces();
                for (place, slots) in places.zip(pass.indices()) {
                    let has_area = slots != [0; 3];
                    let found = slots.map(|slot| vertices[slot as usize]);
                    assert!(!has_area || found == corners[place].map(Some));
                }
            }
            drawn.retain(|&slots| slots != [0; 3]);
            assert_eq!(drawn.len(), expected.len());
            return;
        }

        assert!(indices.is_true_to(cache));
        self.indices
            .resize(indices.indices().len() / 3, [u32::MAX; 3]);
        for range in indices.patch().ranges() {
            for place in range.start as usize..range.end as usize {
                self.indices[place] = indices.indices().face(place);
            }
        }
        for &slots in self.indices.iter().filter(|&&slots| slots != [0; 3]) {
            drawn.push(slots.map(|slot| vertices[slot as usize].unwrap()));
        }
        drawn.sort_unstable();
        assert_eq!(drawn, expected);
    }
}

/// A frame of a walk: vertices change, faces of vertices that left leave, or get other corners.
fn step(
    scene: &mut Scene,
    cache: &mut GeometryCache,
    indices: &mut IndexSlots,
    random: &mut SplitMix64,
    has_gap: bool,
) {
    let vertices = cache.vertices();
    let faces = 2 * vertices;
    let number =
        |below: usize, random: &mut SplitMix64| u32::try_from(random.below(below)).unwrap();
    let many = 1 + random.below(8) * random.below(2);
    let removed: Vec<u32> = (0..random.below(many + 1))
        .map(|_| number(vertices, random))
        .collect();
    let added: Vec<u32> = (0..random.below(many + 1))
        .map(|_| number(vertices, random))
        .collect();
    cache.change(&added, &removed).unwrap();

    let active = cache.active().to_vec();
    let mut removed_faces = Vec::new();
    let mut added_faces = Vec::new();
    let corner = |random: &mut SplitMix64| {
        let first = random.below(active.len());
        [0, 1, 2].map(|i| active[(first + i) % active.len()])
    };
    for (&face, corners) in &scene.living {
        if !corners.iter().all(|&vertex| cache.is_active(vertex)) {
            match active.len() >= 3 && random.below(2) == 0 {
                true => added_faces.push((face, corner(random))),
                false => removed_faces.push(face),
            }
        } else if random.below(12) == 0 {
            removed_faces.push(face);
        }
    }
    for _ in 0..random.below(many + 1) * usize::from(active.len() >= 3) {
        let face = number(faces, random);
        added_faces.push((face, corner(random)));
        if random.below(4) == 0 {
            removed_faces.push(face);
        }
    }
    for face in &removed_faces {
        scene.living.remove(face);
    }
    scene.living.extend(added_faces.iter().copied());
    let patch = indices.update(cache, &removed_faces, &added_faces).unwrap();
    let statistics = patch.statistics();
    assert_eq!(statistics.living, scene.living.len());
    if !statistics.is_rewritten && !has_gap {
        // Each of them is written, and one is moved for each that is dead.
        assert!(statistics.patched <= 2 * removed_faces.len() + added_faces.len());
    }
}

#[test]
fn the_card_draws_what_lives() {
    for seed in 0..60 {
        let random = &mut SplitMix64(seed);
        let slots = 6 + random.below(30);
        let vertices = slots + random.below(2 * slots);
        let eviction = EvictionPolicy::ALL[random.below(5)];
        let mut cache = GeometryCache::new(slots, vec![1.0; vertices], eviction).unwrap();
        if random.below(2) == 0 {
            cache = cache.with_passes();
        }
        let most_dead = [0.0, 0.25, 0.5, 1.0][random.below(4)];
        let gap = u32::try_from(random.below(2) * random.below(5)).unwrap();
        let indices = IndexSlots::new(2 * vertices).with_most_dead(most_dead);
        let mut indices = indices.with_gap(gap);
        let mut scene = Scene::default();
        for _ in 0..200 {
            step(&mut scene, &mut cache, &mut indices, random, gap > 0);
            scene.draw(&mut cache, &indices);
            let statistics = indices.patch().statistics();
            let places = statistics.living + statistics.dead;
            assert!(statistics.dead as f32 <= most_dead * places as f32);
        }
    }
}

#[test]
fn a_buffer_that_is_told_all_that_lives_finds_what_changed() {
    for seed in 0..40 {
        let random = &mut SplitMix64(seed);
        let (slots, vertices) = (12 + random.below(30), 20 + random.below(40));
        let mut cache = GeometryCache::new(slots, Vec::new(), EvictionPolicy::default()).unwrap();
        cache.grow(&vec![1.0; vertices]).unwrap();
        assert!(cache.grow(&[1.0, -1.0]).is_err());
        assert_eq!(cache.vertices(), vertices);
        let mut changed = IndexSlots::new(2 * vertices);
        let mut whole = IndexSlots::new(0);
        whole.grow(2 * vertices);
        let mut scene = Scene::default();
        for _ in 0..100 {
            step(&mut scene, &mut cache, &mut changed, random, true);
            let living: Vec<(u32, [u32; 3])> = scene.living.clone().into_iter().collect();
            let before = living.iter().filter(|(face, corners)| {
                let place = whole.place(*face).map(|it| whole.corners()[it as usize]);
                place != Some(*corners)
            });
            let came = before.count();
            let found = whole.set_living(&cache, &living).unwrap().statistics();
            assert!(whole.is_true_to(&cache));
            assert_eq!(found.living, living.len());
            assert!(living.iter().all(|&(face, corners)| {
                let place = whole.place(face).unwrap();
                whole.corners()[place as usize] == corners
            }));
            if !found.is_rewritten {
                assert!(found.patched >= came);
                let again = whole.set_living(&cache, &living).unwrap().statistics();
                assert_eq!(again.patched, 0);
            }
        }
        let living: Vec<(u32, [u32; 3])> = scene.living.clone().into_iter().collect();
        assert!(whole.set_living(&cache, &[(u32::MAX, [0; 3])]).is_err());
        if let Some((face, corners)) = living.first() {
            cache.change(&[], &corners[..1]).unwrap();
            let error = whole.set_living(&cache, &living).unwrap_err();
            let is_named =
                matches!(error, IndexSlotsError::Inactive { vertex, .. } if vertex == corners[0]);
            assert!(is_named, "{face}: {error}");
        }
    }
}

#[test]
fn a_frame_without_changes_writes_nothing() {
    let mut cache = GeometryCache::new(9, vec![1.0; 20], EvictionPolicy::default()).unwrap();
    let mut indices = IndexSlots::new(4);
    cache.change(&[1, 2, 3, 4], &[]).unwrap();
    let added = [(0, [1, 2, 3]), (3, [3, 2, 4])];
    assert!(
        indices
            .update(&cache, &[], &added)
            .unwrap()
            .statistics()
            .is_rewritten
    );
    // Other vertices come and go: faces stay as they are.
    for vertex in 5..20 {
        cache
            .change(&[vertex], &[vertex - 1].map(|left| left.max(5)))
            .unwrap();
        let statistics = indices.update(&cache, &[], &[]).unwrap().statistics();
        assert_eq!((statistics.patched, statistics.living), (0, 2));
    }
    // One leaves, and another comes to its place: one patch.
    let patch = indices.update(&cache, &[0], &[(1, [1, 2, 4])]).unwrap();
    assert_eq!(patch.ranges().first(), Some(&(0..1)));
    assert_eq!((patch.ranges().len(), patch.statistics().bytes), (1, 6));
}

#[test]
fn what_cannot_be_drawn_is_refused_and_changes_nothing() {
    let mut cache = GeometryCache::new(9, vec![1.0; 20], EvictionPolicy::default()).unwrap();
    cache.change(&[1, 2, 3], &[]).unwrap();
    let mut indices = IndexSlots::new(4);
    indices.update(&cache, &[], &[(0, [1, 2, 3])]).unwrap();
    let before = indices.indices().face(0);
    let error = indices.update(&cache, &[0], &[(1, [1, 2, 7])]).unwrap_err();
    let text = error.to_string();
    assert!(
        text.starts_with("face 1 is added, but its vertex 7 is not active"),
        "{text}"
    );
    let error = indices.update(&cache, &[0, 4], &[]).unwrap_err();
    let text = error.to_string();
    assert_eq!(
        text,
        "removed faces, position 1: face 4 does not exist; the 4 faces are numbered from 0"
    );
    let error = indices.update(&cache, &[0], &[(9, [1, 2, 3])]).unwrap_err();
    assert!(matches!(
        error,
        IndexSlotsError::Face {
            list: "added faces",
            face: 9,
            ..
        }
    ));
    // Resident, but not active.
    cache.change(&[], &[3]).unwrap();
    assert!(cache.is_resident(3));
    let error = indices.update(&cache, &[], &[(1, [1, 2, 3])]).unwrap_err();
    assert_eq!(error, IndexSlotsError::Inactive { face: 1, vertex: 3 });
    assert_eq!(
        (indices.indices().face(0), indices.place(0)),
        (before, Some(0))
    );
    assert!(!indices.is_true_to(&cache));
}

#[test]
fn indices_are_as_wide_as_the_slots_need() {
    let face = |indices: &mut IndexSlots, cache: &GeometryCache| {
        let last = *cache.active().last().unwrap();
        indices.update(cache, &[], &[(0, [0, 1, last])]).unwrap();
        match indices.indices() {
            SlotIndices::Narrow(indices) => (2, u32::from(indices[2])),
            SlotIndices::Wide(indices) => (4, indices[2]),
        }
    };
    let mut indices = IndexSlots::new(1);
    let mut cache =
        GeometryCache::new(65_536, vec![1.0; 70_000], EvictionPolicy::default()).unwrap();
    let active: Vec<u32> = (0..70_000).collect();
    cache.set_active(&active[..65_536]).unwrap();
    assert_eq!(face(&mut indices, &cache), (2, 65_535));
    // A stream of more, and back.
    cache.set_active(&active).unwrap();
    assert_eq!(face(&mut indices, &cache), (4, 69_999));
    cache.set_active(&active[..3]).unwrap();
    assert_eq!(face(&mut indices, &cache), (2, 2));

    let mut indices = IndexSlots::new(1);
    let mut cache =
        GeometryCache::new(65_537, vec![1.0; 70_000], EvictionPolicy::default()).unwrap();
    cache.set_active(&active[..3]).unwrap();
    assert_eq!(face(&mut indices, &cache), (4, 2));
}
