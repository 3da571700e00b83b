//! The paper's example, and laws for any faces.

use std::collections::VecDeque;

use super::sweep::Sweep;
use super::*;
use crate::faces::Faces;
use crate::index::index32;
use crate::random::SplitMix64;

/// Table 2, in the paper's order.
const TABLE_2: [([u32; 3], Membership); 17] = {
    use Membership::{Left, List, Previous};
    [
        ([0, 1, 2], List),
        ([0, 2, 3], List),
        ([0, 3, 4], List),
        ([0, 4, 5], List),
        ([0, 5, 6], List),
        ([0, 6, 1], List),
        ([1, 6, 7], Previous),
        ([1, 7, 8], List),
        ([1, 8, 2], List),
        ([2, 8, 9], Previous),
        ([2, 9, 3], List),
        ([3, 9, 4], Previous),
        ([4, 9, 10], Previous),
        ([4, 10, 11], List),
        ([4, 11, 12], List),
        ([4, 12, 5], List),
        ([5, 7, 6], Left),
    ]
};

#[test]
fn the_papers_example_gives_its_table_2_and_a_buffer_of_9() {
    let faces = TABLE_2.map(|(face, _)| face);
    let lists = TrimmedLists::new(&faces, 0);
    assert!(lists.vertices().is_identity());
    assert_eq!(lists.lengths()[..5], [6, 2, 1, 0, 3]);

    // An edge leads from each vertex to the next.
    assert_eq!(lists.joined_share(&faces), 1.0);

    let (code, _, order) = TrimmedListCode::new(&faces, 0);
    assert!(order.is_identity());
    let found: Vec<_> = code.with_memberships().collect();
    assert_eq!(found, TABLE_2);

    let rendering = MinimumTimeRendering::new(&faces);
    assert_eq!(rendering.buffer_size(), 9);
    assert!(rendering.order().is_identity());
}

/// Faces of any kind: flipped, repeated, with a vertex twice, and vertices without faces.
pub(super) fn soup(random: &mut SplitMix64) -> (Vec<[u32; 3]>, usize) {
    let vertex_count = 1 + random.below(24);
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for _ in 0..random.below(48) {
        let any = |random: &mut SplitMix64| index32(random.below(vertex_count));
        let face = match (random.below(8), faces.last()) {
            (0, Some(&face)) => face,
            (1, Some(&[a, b, c])) => [a, c, b],
            (2..5, Some(&[a, b, _])) => [b, a, any(random)],
            _ => [any(random), any(random), any(random)],
        };
        faces.push(face);
    }
    (faces, vertex_count)
}

/// A face with its least vertex first.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap()
}

#[test]
fn any_faces_come_back_with_their_direction() {
    let mut random = SplitMix64(1);
    for _ in 0..3000 {
        let (faces, vertex_count) = soup(&mut random);
        let first = index32(random.below(vertex_count));
        let faces = Faces::new(&faces, vertex_count).unwrap();
        let (code, vertices, order) = TrimmedListCode::new(faces, first);
        assert_eq!(vertices.new_to_old()[0], first);

        let expected = vertices.renumber(&order.apply(faces.as_slice()));
        let decoded = code.decode();
        assert_eq!(
            decoded.iter().copied().map(turned).collect::<Vec<_>>(),
            expected.into_iter().map(turned).collect::<Vec<_>>()
        );
        let least_first = |face: &[u32; 3]| face[0] == *face.iter().min().unwrap();
        assert!(decoded.iter().all(least_first));
        assert!(decoded.is_sorted_by_key(|face| face[0]));
    }
}

/// Draws with a buffer that really is first-in first-out, and returns the most that it held.
fn replayed(rendering: &MinimumTimeRendering, drawn: &[[u32; 3]]) -> usize {
    let mut buffer = VecDeque::new();
    let (mut sent, mut most) = (0, 0);
    for (focus, step) in (0..).zip(rendering.steps()) {
        for vertex in step.sent.clone() {
            assert_eq!(vertex, sent, "each once, in the order of the numbers");
            sent += 1;
            buffer.push_back(vertex);
        }
        most = most.max(buffer.len());
        let faces = step.faces.start as usize..step.faces.end as usize;
        for corner in drawn[faces].as_flattened() {
            assert!(buffer.contains(corner), "{corner} is not in the buffer");
        }
        assert_eq!(buffer.pop_front(), Some(focus));
    }
    assert!(buffer.is_empty());
    most
}

#[test]
fn each_vertex_is_sent_once_through_a_buffer_of_the_size_that_is_said() {
    let mut random = SplitMix64(2);
    for _ in 0..1000 {
        let (faces, vertex_count) = soup(&mut random);
        let faces = Faces::new(&faces, vertex_count).unwrap();
        let rendering = MinimumTimeRendering::new(faces);
        let drawn = rendering.order().apply(faces.as_slice());
        assert_eq!(replayed(&rendering, &drawn), rendering.buffer_size());
    }
}

#[test]
fn no_order_needs_less_than_the_bound() {
    let mut random = SplitMix64(3);
    for _ in 0..1000 {
        let (faces, vertex_count) = soup(&mut random);
        let faces = Faces::new(&faces, vertex_count).unwrap();
        let mut sweep = Sweep::new(faces);

        // By the exact diameter of each part.
        let of_part = |vertex: u32| {
            let part = sweep.from(vertex).0.to_vec();
            let diameter = part
                .iter()
                .map(|&vertex| sweep.from(vertex).1)
                .max()
                .unwrap();
            (part.len() - 1) as f64 / f64::from(diameter.max(1))
        };
        let exact = (0..index32(vertex_count)).map(of_part).fold(0.0, f64::max);
        assert!(MinimumTimeRendering::new(faces).buffer_size() as f64 >= exact);
        // The diameter that it takes is never too large, and at least half of the exact one.
        let bound = buffer_bound(faces);
        assert!((exact..=2.0 * exact).contains(&bound), "{bound}, {exact}");
    }
    // A strip: one face after the other, 22 vertices, a diameter of 11 edges.
    let strip: Vec<[u32; 3]> = (0..20).map(|i| [i, i + 1, i + 2]).collect();
    assert_eq!(buffer_bound(&strip), 21.0 / 11.0);
}

#[test]
fn the_first_vertex_is_the_best_of_its_candidates() {
    // A strip of two rows of cells: beginning at an end, each column of three vertices is sent once.
    let positions: Vec<[f32; 3]> = (0..63)
        .map(|i| [(i / 3) as f32, (i % 3) as f32, 0.0])
        .collect();
    let cell = |i: u32| [[i, i + 3, i + 1], [i + 1, i + 3, i + 4]];
    let faces: Vec<[u32; 3]> = (0..60).filter(|i| i % 3 != 2).flat_map(cell).collect();
    let mesh = crate::Mesh::new(positions, faces).unwrap();
    let size = |first: u32| {
        let renumbered = TrimmedLists::new(&mesh, first)
            .vertices()
            .renumber(mesh.faces());
        MinimumTimeRendering::new(&renumbered).buffer_size()
    };
    let chosen = FirstVertex::MinBuffer.choose(&mesh).unwrap();
    let candidates = FirstVertex::candidates(&mesh);
    assert!(candidates.contains(&chosen) && candidates.len() >= 4);
    assert!(candidates.iter().all(|&other| size(chosen) <= size(other)));
    assert!(
        size(chosen) <= 6 && size(31) > 6,
        "{} {}",
        size(chosen),
        size(31)
    );

    let bytes = |first: u32| FanCode::new(&mesh, first).bytes().len();
    let chosen = FirstVertex::MinBits.choose(&mesh).unwrap();
    assert!(candidates.contains(&chosen));
    assert!(
        candidates
            .iter()
            .all(|&other| bytes(chosen) <= bytes(other))
    );

    assert_eq!(FirstVertex::Given(31).choose(&mesh), Ok(31));
    let error = FirstVertex::Given(63).choose(&mesh).unwrap_err();
    assert!(error.to_string().contains("64"), "{error}");
}
