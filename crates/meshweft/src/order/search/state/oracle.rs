//! The state compared with plain recounts, on random faces.

use proptest::prelude::*;

use super::caches::RING;
use super::*;
use crate::cache::{self, BatchModel, CacheModel};
use crate::random::SplitMix64;

/// Faces of a few vertices: fans, repeated and degenerate faces all occur.
fn soup() -> impl Strategy<Value = Vec<[u32; 3]>> {
    prop_oneof![
        prop::collection::vec(prop::array::uniform3(0..12_u32), 0..60),
        prop::collection::vec(prop::array::uniform3(0..90_u32), 0..200),
        // A strip with a random face here and there.
        prop::collection::vec((0..80_u32, any::<bool>()), 0..200).prop_map(|faces| {
            let face = |(i, odd): (u32, bool)| match odd {
                true => [i, i + 9, i + 1],
                false => [i + 1, i + 9, i + 10],
            };
            faces.into_iter().map(face).collect()
        }),
    ]
}

fn limits() -> impl Strategy<Value = CacheLimits> {
    (3..40_u32, prop::option::of((1..40_u32, 3..40_u32))).prop_map(|(size, batch)| {
        let (batch_faces, batch_vertices) = batch.unwrap_or((u32::MAX, u32::MAX));
        CacheLimits {
            batch_faces,
            batch_vertices,
            ..CacheLimits::fifo(size)
        }
    })
}

fn model(limits: CacheLimits) -> CacheModel {
    let limit = |limit: u32| if limit == u32::MAX { 0 } else { limit };
    CacheModel::Batch(BatchModel::new(
        limits.size,
        limit(limits.batch_vertices),
        limit(limits.batch_faces),
    ))
}

fn turned<M, const CACHES: usize>(state: &State<'_, M, CACHES>) -> Vec<[u32; 3]> {
    let orders = state.new_to_old.iter().zip(&state.rotations);
    let turn = |(&face, &rotation): (&u32, &u8)| {
        let mut corners = state.faces[face as usize];
        corners.rotate_left(usize::from(rotation));
        corners
    };
    orders.map(turn).collect()
}

impl<M: Mask, const CACHES: usize> State<'_, M, CACHES> {
    /// Recounts missing neighbours, live faces and candidates from the drawn faces, and compares.
    fn assert_counts(&self) {
        for (v, vertex) in (0_u32..).zip(&self.vertices[..self.vertices.len() - 1]) {
            let mut missing = [0_u32; CACHES];
            let mut live = 0;
            for (face, _) in self
                .faces
                .iter()
                .zip(&self.drawn)
                .filter(|(_, drawn)| !**drawn)
            {
                for i in 0..3 {
                    if face[i] == v {
                        live += 1;
                        for other in [face[(i + 1) % 3], face[(i + 2) % 3]] {
                            for (cache, missing) in missing.iter_mut().enumerate() {
                                *missing += u32::from(self.is_missing(other, cache));
                            }
                        }
                    }
                }
            }
            assert_eq!(vertex.live, live, "faces left of {v}");
            for (cache, missing) in missing.into_iter().enumerate() {
                let counted = vertex.missing_corners >> (16 * cache) & 0xffff;
                assert_eq!(counted, missing, "neighbours of {v} missing from {cache}");
            }
        }

        let mut expected: Vec<u32> = (0..index32(self.vertices.len() - 1))
            .filter(|&v| {
                let vertex = &self.vertices[v as usize];
                let age = self.caches[0].pushes - vertex.entered[0];
                vertex.live != 0 && age <= self.window
            })
            .collect();
        expected.sort_by_key(|&v| self.vertices[v as usize].entered[0]);
        let mut candidates = Vec::new();
        self.candidates(u32::MAX, |_, candidate| candidates.push(candidate.vertex));
        assert_eq!(candidates, expected);
    }
}

/// Draws everything, with attempts in between that are taken back.
fn draw_all<M: Mask, const CACHES: usize>(
    faces: &[[u32; 3]],
    limits: [CacheLimits; CACHES],
    window: u32,
    keep_corners: bool,
    seed: u64,
) {
    let faces = Faces::from(faces);
    let mut numbers = SplitMix64(seed);
    let mut state = State::<M, CACHES>::new(faces, limits);
    state.window = window.max(limits[0].size).min(M::SPAN);
    state.keep_corners = keep_corners;
    let mut redo = Redo::default();
    let mut is_odd = false;
    let mut any_live = |state: &State<'_, M, CACHES>| {
        let from = index32(numbers.below(faces.vertex_count() + 1));
        state.first_live(from).or_else(|| state.first_live(0))
    };

    while let Some(focus) = any_live(&state) {
        // An attempt of up to four vertices.
        let before = (
            state.vertices.clone(),
            state.drawn.clone(),
            state.dead_ends.clone(),
        );
        let saved = state.save();
        state.begin();
        for _ in 0..4 {
            if let Some(focus) = any_live(&state) {
                state.draw::<true>(focus);
                state.assert_counts();
            }
        }

        // Taken back, nothing but the attempt numbers has changed.
        let attempted = (
            state.vertices.clone(),
            state.drawn.clone(),
            state.dead_ends.clone(),
            state.new_to_old.clone(),
            state.rotations.clone(),
        );
        state.undo_to_redo(&saved, &mut redo);
        let known = |vertices: &[SearchVertex<CACHES>]| -> Vec<_> {
            let known =
                |v: &SearchVertex<CACHES>| (v.entered, v.row_start, v.live, v.missing_corners);
            vertices.iter().map(known).collect()
        };
        assert_eq!(known(&state.vertices), known(&before.0));
        assert_eq!((&state.drawn, &state.dead_ends), (&before.1, &before.2));

        // Every other time it is drawn again, as it was.
        is_odd = !is_odd;
        if is_odd {
            state.draw::<false>(focus);
        } else {
            state.redo(&mut redo);
            assert_eq!(known(&state.vertices), known(&attempted.0));
            let drawn = (&state.drawn, &state.dead_ends);
            assert_eq!(drawn, (&attempted.1, &attempted.2));
            let order = (&state.new_to_old, &state.rotations);
            assert_eq!(order, (&attempted.3, &attempted.4));
        }
        state.assert_counts();
    }

    // The pushes are those of a replay; a controllable cache has no fewer than the best schedule.
    assert_eq!(state.new_to_old.len(), faces.len());
    let turned = turned(&state);
    for (cache, limits) in state.caches.iter().zip(limits) {
        let pushes = u64::from(cache.pushes) - RING as u64;
        if limits.is_controllable {
            assert!(pushes >= cache::misses(&turned, CacheModel::controllable(limits.size)));
        } else {
            assert_eq!(pushes, cache::misses(&turned, model(limits)), "{limits:?}");
        }
    }
}

proptest! {
    #[test]
    fn one_cache_is_what_a_replay_counts(
        faces in soup(), limits in limits(), window in 3..64_u32,
        keep_corners in any::<bool>(), random in any::<u64>(),
    ) {
        draw_all::<u64, 1>(&faces, [limits], window, keep_corners, random);
    }

    #[test]
    fn two_caches_are_what_replays_count(
        faces in soup(), first in limits(), second in limits(), window in 3..128_u32,
        keep_corners in any::<bool>(), random in any::<u64>(),
    ) {
        draw_all::<u128, 2>(&faces, [first, second], window, keep_corners, random);
    }

    #[test]
    fn a_controllable_cache_counts_right(
        faces in soup(), size in 3..30_u32, random in any::<u64>(),
    ) {
        let limits = CacheLimits { is_controllable: true, ..CacheLimits::fifo(size) };
        draw_all::<u64, 1>(&faces, [limits], 64, false, random);
    }
}
