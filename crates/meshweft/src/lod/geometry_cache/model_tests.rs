//! The cache against its model, on walks that try to break it.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::model::Model;
use super::oldest_first::OldestFirst;
use super::{EvictionPolicy, FrameMode, GeometryCache, GeometryCacheError, SlotPolicy};
use crate::random::{SplitMix64, from_environment};

/// A vertex buffer as the card has it, written by uploads.
#[derive(Default)]
struct Card {
    slots: Vec<Option<u32>>,
    stream: Vec<Option<u32>>,
}

impl Card {
    /// Writes the ranges of the last upload and nothing else, and looks for each active vertex.
    fn draw(&mut self, cache: &GeometryCache) {
        let upload = cache.upload();
        let mut data = upload.inserts().iter().peekable();
        let is_cached = upload.mode() == FrameMode::Cached;
        let buffer = if is_cached {
            &mut self.slots
        } else {
            &mut self.stream
        };
        let size = if is_cached {
            cache.slots()
        } else {
            cache.active().len()
        };
        buffer.resize(size, None);
        for slot in upload.ranges().iter().cloned().flatten() {
            let insert = data.next_if(|insert| insert.slot == slot);
            let vertex = insert.map_or_else(|| cache.vertex(slot), |insert| Some(insert.vertex));
            buffer[slot as usize] = vertex;
        }
        assert!(data.next().is_none(), "an insert outside all ranges");
        for &vertex in cache.active() {
            let slot = cache.slot(vertex).expect("an active vertex has a place");
            assert_eq!(buffer[slot as usize], Some(vertex));
        }
    }
}

/// What holds after every frame.
fn check(cache: &GeometryCache) {
    let upload = cache.upload();
    assert_eq!(upload.statistics().overruled, 0);
    assert_eq!(upload.statistics().active, cache.active().len());
    assert_eq!(upload.statistics().inserts, upload.inserts().len());
    let sent: usize = upload.ranges().iter().map(|range| range.len()).sum();
    assert_eq!(upload.statistics().bytes(7), 7 * sent as u64);
    assert!(
        upload
            .ranges()
            .windows(2)
            .all(|pair| pair[0].end < pair[1].start)
    );
    if upload.mode() == FrameMode::Streamed {
        return;
    }
    for vertex in 0..u32::try_from(cache.vertices()).unwrap() {
        if let Some(slot) = cache.slot(vertex) {
            assert_eq!(cache.vertex(slot), Some(vertex));
        }
    }
    for insert in upload.inserts() {
        assert!(cache.is_active(insert.vertex));
        assert_eq!(cache.slot(insert.vertex), Some(insert.slot));
    }
}

fn errors(vertices: usize, random: &mut SplitMix64) -> Vec<f32> {
    let error = |_| match random.below(8) {
        0 => 0.0,
        exponent => {
            2_f32.powi(i32::try_from(exponent).unwrap() - 4) * (1.0 + random.below(8) as f32 / 8.0)
        }
    };
    (0..vertices).map(error).collect()
}

/// The next active set of a walk: a few changes, none, all others, as many as slots, nobody.
fn next_active(active: &[u32], slots: usize, vertices: usize, random: &mut SplitMix64) -> Vec<u32> {
    let number = |random: &mut SplitMix64| u32::try_from(random.below(vertices)).unwrap();
    let mut next = active.to_vec();
    match random.below(12) {
        0 => next.clear(),
        1 => next = (0..slots).map(|_| number(random)).collect(),
        2 => {
            next = (0..u32::try_from(vertices).unwrap())
                .filter(|v| !active.contains(v))
                .collect()
        }
        3 => {}
        4 => next.extend((0..slots).map(|_| number(random))),
        _ => {
            for _ in 0..random.below(4) {
                if !next.is_empty() {
                    next.swap_remove(random.below(next.len()));
                }
                next.push(number(random));
            }
        }
    }
    // Most frames fit, many of them to the last slot.
    if random.below(8) > 0 {
        next = distinct(&next);
        next.truncate(slots);
    }
    next
}

fn walk(eviction: EvictionPolicy, is_explicit: bool, seed: u64) {
    let random = &mut SplitMix64(seed);
    let slots = 3 + random.below(30) * random.below(2);
    let vertices = slots + random.below(3 * slots);
    let errors = errors(vertices, random);
    let gap = u32::try_from(random.below(2) * random.below(4)).unwrap();
    let mut cache = GeometryCache::new(slots, errors.clone(), eviction)
        .unwrap()
        .with_gap(gap);
    let mut model = Model::new(slots, &errors, eviction);
    let mut card = Card::default();
    // In the order of an implicit front.
    let mut active: Vec<u32> = Vec::new();
    for _ in 0..60 {
        let next = next_active(&active, slots, vertices, random);
        let mut added: Vec<u32> = next
            .iter()
            .filter(|v| !active.contains(v))
            .copied()
            .collect();
        let mut removed: Vec<u32> = active
            .iter()
            .filter(|v| !next.contains(v))
            .copied()
            .collect();
        let before = cache.active().to_vec();
        if is_explicit {
            // Removed and added in one frame, added twice, removed though it is not there.
            let again =
                (0..random.below(3)).filter_map(|_| next.get(random.below(next.len().max(1))));
            for &vertex in again {
                added.push(vertex);
                removed.push(vertex);
            }
            cache.change(&added, &removed).unwrap();
        } else {
            cache.set_active(&next).unwrap();
        }
        let order = distinct(&next);
        let expected = model.frame(&added, &removed, (!is_explicit).then_some(&order));
        assert_eq!(
            cache.upload().inserts(),
            expected,
            "{eviction}, seed {seed}"
        );

        let mut sets = [cache.active().to_vec(), model.active.clone()];
        sets.iter_mut().for_each(|set| set.sort_unstable());
        assert_eq!(sets[0], sets[1]);
        let stayed = before
            .iter()
            .filter(|&&vertex| cache.is_active(vertex))
            .count();
        let statistics = cache.upload().statistics();
        assert!(statistics.added >= cache.active().len() - stayed);
        check(&cache);
        card.draw(&cache);
        active = order;
    }
}

/// Each number once, where it comes first.
fn distinct(numbers: &[u32]) -> Vec<u32> {
    let mut distinct = Vec::new();
    for number in numbers {
        if !distinct.contains(number) {
            distinct.push(*number);
        }
    }
    distinct
}

#[test]
fn every_policy_decides_as_its_model() {
    let cases = from_environment("MESHWEFT_CASES", 60);
    let first = from_environment("MESHWEFT_SEED", 1);
    let evictions = EvictionPolicy::ALL.into_iter().chain([
        EvictionPolicy::queued_by_error(40, 2),
        EvictionPolicy::queued_by_error(100, 0),
        EvictionPolicy::queued_by_error(0, u32::MAX),
    ]);
    for eviction in evictions {
        for seed in first..first + cases {
            walk(eviction, false, seed);
            walk(eviction, true, seed);
        }
    }
}

/// Both kinds of front, fed with the same frames in the same order, decide alike.
/// Errors that are given one by one, before a vertex is added for the first time, count as if all had been known.
#[test]
fn errors_may_come_later() {
    let random = &mut SplitMix64(5);
    let half = EvictionPolicy::queued_by_error(50, 2);
    for eviction in EvictionPolicy::ALL.into_iter().chain([half]) {
        let (slots, vertices) = (20, 70);
        let errors = errors(vertices, random);
        let mut known = GeometryCache::new(slots, errors.clone(), eviction).unwrap();
        let mut told = GeometryCache::new(slots, vec![0.0; vertices], eviction).unwrap();
        let mut is_other = false;
        let mut untold = GeometryCache::new(slots, vec![0.0; vertices], eviction).unwrap();
        let mut active: Vec<u32> = Vec::new();
        for _ in 0..200 {
            active = distinct(&next_active(&active, slots, vertices, random));
            for &vertex in &active {
                told.set_error(vertex, errors[vertex as usize]).unwrap();
            }
            let expected = known.set_active(&active).unwrap().inserts();
            assert_eq!(told.set_active(&active).unwrap().inserts(), expected);
            is_other |= untold.set_active(&active).unwrap().inserts() != expected;
        }
        let is_by_error = [EvictionPolicy::FinestFirst, half].contains(&eviction);
        assert!(!is_by_error || is_other, "{eviction}");
    }

    let mut cache = GeometryCache::new(3, vec![1.0; 4], EvictionPolicy::FinestFirst).unwrap();
    let error = cache.set_error(4, 1.0).unwrap_err();
    assert!(matches!(
        error,
        GeometryCacheError::Vertex { vertex: 4, .. }
    ));
    for wrong in [-1.0, f32::NAN] {
        let error = cache.set_error(2, wrong).unwrap_err();
        assert!(matches!(error, GeometryCacheError::Error { vertex: 2, .. }));
    }
}

#[test]
fn an_implicit_front_is_an_explicit_one() {
    for eviction in EvictionPolicy::ALL {
        let random = &mut SplitMix64(5);
        let errors = errors(200, random);
        let mut explicit = GeometryCache::new(64, errors.clone(), eviction).unwrap();
        let mut implicit = GeometryCache::new(64, errors, eviction).unwrap();
        let mut active: Vec<u32> = Vec::new();
        for _ in 0..300 {
            // Where more is active than fits, the two have it in different orders.
            let mut next = distinct(&next_active(&active, 64, 200, random));
            next.truncate(64);
            let added: Vec<u32> = next
                .iter()
                .filter(|v| !active.contains(v))
                .copied()
                .collect();
            let removed: Vec<u32> = active
                .iter()
                .filter(|v| !next.contains(v))
                .copied()
                .collect();
            explicit.change(&added, &removed).unwrap();
            implicit.set_active(&next).unwrap();
            let [a, b] = [&explicit, &implicit].map(GeometryCache::upload);
            assert_eq!(a.statistics(), b.statistics());
            if eviction != EvictionPolicy::Nothing {
                assert_eq!(a.inserts(), b.inserts());
            }
            active = next;
        }
    }
}

#[test]
fn an_active_vertex_never_moves() {
    for eviction in EvictionPolicy::ALL.into_iter().skip(1) {
        let random = &mut SplitMix64(9);
        let errors = errors(90, random);
        let mut cache = GeometryCache::new(40, errors, eviction).unwrap();
        let mut places: Vec<(u32, u32)> = Vec::new();
        for _ in 0..400 {
            let next = next_active(cache.active(), 40, 90, random);
            if cache.set_active(&next).unwrap().mode() == FrameMode::Streamed {
                continue;
            }
            for &(vertex, slot) in &places {
                assert!(!cache.is_active(vertex) || cache.slot(vertex) == Some(slot));
            }
            let place = |&vertex: &u32| (vertex, cache.slot(vertex).unwrap());
            places = cache.active().iter().map(place).collect();
        }
    }
}

/// Now and then names a slot that is not open, or none, and does not take it.
#[derive(Debug)]
struct Careless {
    open: OldestFirst,
    random: SplitMix64,
    is_open: Vec<bool>,
    lies: Arc<AtomicUsize>,
}

impl SlotPolicy for Careless {
    fn open(&mut self, slot: u32, error: Option<f32>, frame: u32) {
        self.open.open(slot, error, frame);
        self.is_open[slot as usize] = true;
    }

    fn close(&mut self, slot: u32) {
        self.open.close(slot);
        self.is_open[slot as usize] = false;
    }

    fn take(&mut self, frame: u32) -> Option<u32> {
        let slot = self.random.below(60);
        if self.random.below(3) > 0 || self.is_open.get(slot) == Some(&true) {
            let slot = self.open.take(frame)?;
            self.is_open[slot as usize] = false;
            return Some(slot);
        }
        self.lies.fetch_add(1, Ordering::Relaxed);
        (slot > 10).then_some(u32::try_from(slot).unwrap())
    }
}

#[test]
fn a_policy_that_errs_never_gives_a_wrong_vertex() {
    let random = &mut SplitMix64(3);
    let errors = errors(120, random);
    let lies = Arc::new(AtomicUsize::new(0));
    let policy = Box::new(Careless {
        open: OldestFirst::new(40),
        random: SplitMix64(4),
        is_open: vec![false; 40],
        lies: Arc::clone(&lies),
    });
    let mut cache = GeometryCache::with_policy(40, errors, policy).unwrap();
    let (mut card, mut overruled) = (Card::default(), 0);
    for _ in 0..500 {
        let next = next_active(cache.active(), 40, 120, random);
        overruled += cache.set_active(&next).unwrap().statistics().overruled;
        card.draw(&cache);
    }
    assert!(overruled > 100 && overruled == lies.load(Ordering::Relaxed));
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let new = |slots, errors| GeometryCache::new(slots, errors, EvictionPolicy::default());
    let text = |slots, errors| new(slots, errors).unwrap_err().to_string();
    assert_eq!(
        text(2, vec![1.0]),
        "2 slots: give 3, which a face needs, to 1073741824"
    );
    let most = GeometryCacheError::MOST_SLOTS + 1;
    assert_eq!(
        new(most, vec![]).unwrap_err(),
        GeometryCacheError::Slots { slots: most }
    );
    assert_eq!(
        text(3, vec![1.0, f32::NAN]),
        "the error of vertex 1 is NaN: give 0 or more"
    );
    assert_eq!(
        text(3, vec![-1.0]),
        "the error of vertex 0 is -1: give 0 or more"
    );

    let mut cache = new(3, vec![1.0; 4]).unwrap();
    cache.set_active(&[1, 2]).unwrap();
    for error in [
        cache.set_active(&[0, 4]).unwrap_err(),
        cache.change(&[0], &[1, 4]).unwrap_err(),
        cache.change(&[0, 4], &[1]).unwrap_err(),
    ] {
        let text = error.to_string();
        assert!(
            text.ends_with(
                "position 1: vertex 4 does not exist; the 4 vertices are numbered from 0"
            ),
            "{text}"
        );
    }
    assert_eq!(
        (cache.active(), cache.upload().inserts().len()),
        (&[1, 2][..], 2)
    );
}

/// After one round of a walk that comes back, nothing is allocated.
#[test]
fn a_steady_state_needs_no_memory() {
    for eviction in EvictionPolicy::ALL {
        let mut cache = GeometryCache::new(100, vec![1.0; 300], eviction).unwrap();
        let round = |cache: &mut GeometryCache| {
            for start in (0..200).step_by(7) {
                let active: Vec<u32> = (start..start + 90).collect();
                cache.set_active(&active).unwrap();
            }
            cache.capacities()
        };
        round(&mut cache);
        let capacities = round(&mut cache);
        assert_eq!(capacities, round(&mut cache));
    }
}
