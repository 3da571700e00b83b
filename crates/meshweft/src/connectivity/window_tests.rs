//! Laws of window orders, for surfaces and for any faces, against plain readings.

use std::collections::BTreeSet;

use super::tests::soup;
use super::*;
use crate::cache::{self, CacheModel};
use crate::faces::Faces;
use crate::index::index32;
use crate::random::SplitMix64;

const SIZES: [WindowSize; 6] = [
    WindowSize::OfBuffer(6),
    WindowSize::OfBuffer(1),
    WindowSize::Faces(0),
    WindowSize::Faces(1),
    WindowSize::Faces(7),
    WindowSize::Faces(u32::MAX),
];

/// Rows of squares, cut in two, whose last row meets the first one, with some faces taken out.
fn ring(random: &mut SplitMix64, width: u32, height: u32, holes: usize) -> Vec<[u32; 3]> {
    let vertex = |x: u32, y: u32| (y % height) * width + x;
    let mut faces = Vec::new();
    for y in 0..height {
        for x in 0..width - 1 {
            let [a, b] = [vertex(x, y), vertex(x + 1, y)];
            let [c, d] = [vertex(x + 1, y + 1), vertex(x, y + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    for _ in 0..holes {
        faces.swap_remove(random.below(faces.len()));
    }
    faces
}

/// Any faces; as they are decoded, or as they are.
fn stream(random: &mut SplitMix64) -> Vec<[u32; 3]> {
    let (faces, vertex_count) = match random.below(2) {
        0 => soup(random),
        _ => {
            let [width, height] = [0; 2].map(|_| 3 + index32(random.below(12)));
            let holes = random.below(5);
            (
                ring(random, width, height, holes),
                (width * height) as usize,
            )
        }
    };
    if random.below(4) == 0 {
        return faces;
    }
    let first = index32(random.below(vertex_count));
    let code = FanCode::new(Faces::new(&faces, vertex_count).unwrap(), first);
    FanCode::decode(code.bytes(), faces.len(), vertex_count).unwrap()
}

/// All windows: faces, their places in the window as it came, and what is finished.
fn all(windows: &mut WindowOrder, faces: &[[u32; 3]]) -> Vec<(Vec<[u32; 3]>, Vec<u32>, u32)> {
    let owned = |it: Window<'_>| (it.faces.to_vec(), it.order.to_vec(), it.finished);
    let mut found = Vec::new();
    for face in faces {
        found.extend(windows.push(*face).map(owned));
    }
    found.extend(windows.finish().map(owned));
    found
}

#[test]
fn each_window_is_the_next_faces_in_another_order() {
    let mut random = SplitMix64(1);
    let mut reused = WindowOrder::default();
    for _ in 0..2000 {
        let faces = stream(&mut random);
        for size in SIZES {
            let found = all(&mut WindowOrder::new(size), &faces);
            let mut whole = Vec::new();
            for (drawn, order, _) in &found {
                // Corners are as they came.
                let came = &faces[whole.len()..whole.len() + drawn.len()];
                assert!(!order.is_empty());
                assert!(order.iter().collect::<BTreeSet<_>>().len() == drawn.len());
                assert!(
                    order
                        .iter()
                        .map(|&at| came[at as usize])
                        .eq(drawn.iter().copied())
                );
                whole.extend_from_slice(drawn);
            }
            let order = WindowOrder::of_faces(&faces, size);
            assert_eq!(order.apply(&faces), whole);
        }
        // After the end another list can follow.
        let default = WindowSize::default();
        assert_eq!(
            all(&mut reused, &faces),
            all(&mut WindowOrder::new(default), &faces)
        );
    }
}

#[test]
fn no_later_window_uses_what_is_finished_and_none_is_larger_than_it_may() {
    let mut random = SplitMix64(2);
    for _ in 0..2000 {
        let faces = stream(&mut random);
        let rendering = MinimumTimeRendering::new(&faces);
        let faces = rendering.order().apply(&faces);
        for size in SIZES {
            let found = all(&mut WindowOrder::new(size), &faces);
            let mut finished = 0;
            for (drawn, _, now_finished) in &found {
                assert!(
                    drawn
                        .as_flattened()
                        .iter()
                        .all(|&vertex| vertex >= finished)
                );
                assert!(*now_finished >= finished);
                finished = *now_finished;
                let limit = match size {
                    WindowSize::OfBuffer(scale) => scale as usize * rendering.buffer_size().max(16),
                    WindowSize::Faces(count) => count.max(1) as usize,
                };
                assert!(drawn.len() <= limit, "{} {limit}", drawn.len());
            }
            let end = faces.as_flattened().iter().max().map_or(0, |last| last + 1);
            assert_eq!(finished, end);
        }
    }
}

/// The vertices that are needed at once, face by face, by looking at all faces.
fn released_by_hand(faces: &[[u32; 3]]) -> usize {
    let vertices =
        |faces: &[[u32; 3]]| -> BTreeSet<u32> { faces.as_flattened().iter().copied().collect() };
    let held = |at: usize| {
        let (sent, needed) = (vertices(&faces[..=at]), vertices(&faces[at..]));
        sent.intersection(&needed).count()
    };
    (0..faces.len()).map(held).max().unwrap_or(0)
}

#[test]
fn slots_that_are_freed_are_counted_as_by_hand() {
    let mut random = SplitMix64(3);
    for _ in 0..500 {
        let faces = stream(&mut random);
        let drawn = WindowOrder::of_faces(&faces, WindowSize::default()).apply(&faces);
        assert_eq!(released_buffer_size(&drawn), released_by_hand(&drawn));
        let rendering = MinimumTimeRendering::new(&faces);
        let drawn = rendering.order().apply(&faces);
        assert!(released_buffer_size(&drawn) <= rendering.buffer_size());
    }
}

#[test]
fn columns_miss_less_and_the_buffer_stays() {
    let faces = ring(&mut SplitMix64(4), 90, 300, 40);
    let code = FanCode::new(&faces, 0);
    let faces = FanCode::decode(code.bytes(), faces.len(), 90 * 300).unwrap();
    let buffer = MinimumTimeRendering::new(&faces).buffer_size();
    let misses = |faces: &[[u32; 3]]| cache::acmr(faces, CacheModel::fifo(16));
    assert!(misses(&faces) > 0.95);

    // A ring around 90 vertices, two faces a vertex.
    for (rings, most) in [(1, 1.01), (2, 0.77), (3, 0.69), (4, 0.66)] {
        let drawn = WindowOrder::of_faces(&faces, WindowSize::OfBuffer(2 * rings)).apply(&faces);
        assert!(misses(&drawn) < most, "{rings} rings: {}", misses(&drawn));
        let released = released_buffer_size(&drawn);
        assert!(released * 20 <= buffer * 21, "{released} {buffer}");
    }
}

#[test]
fn numbers_that_no_traversal_gives_take_no_memory() {
    let far = u32::MAX;
    let faces = [
        [0, 1, far],
        [0, far, 2],
        [far, far, far],
        [1, 2, 3],
        [far - 1, far - 1, 0],
        [1 << 31, far, 7],
    ];
    for size in SIZES {
        let mut windows = WindowOrder::new(size);
        let found = all(&mut windows, &faces.repeat(50));
        assert_eq!(found.iter().map(|it| it.0.len()).sum::<usize>(), 300);
        assert!(format!("{windows:?}").len() < 100_000);

        // Roots far apart.
        let apart: Vec<[u32; 3]> = (0..400).map(|i| [i << 23, (i << 23) + 1, far]).collect();
        let found = all(&mut windows, &apart);
        assert_eq!(found.iter().map(|it| it.0.len()).sum::<usize>(), 400);
        assert!(format!("{windows:?}").len() < 100_000);
    }
    assert!(WindowOrder::default().finish().is_none());
}
