//! The order face by face against a plain reading of the description, at every size of hubs.

use super::scores::{LIST_SIZE, SCORES_OUTSIDE, VERTEX_SCORES};
use super::{Work, face_numbers};
use crate::cache::{self, CacheModel};
use crate::faces::Faces;
use crate::index::index32;
use crate::order::baselines::{linear_speed, random};
use crate::permutation::Permutation;
use crate::random::{SplitMix64, from_environment};

/// Every list as a list, every score where it changes, no hubs.
fn plain(faces: Faces<'_>) -> Vec<u32> {
    let corners = faces.as_slice();
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); faces.vertex_count()];
    for (number, face) in (0..).zip(corners) {
        for &corner in face {
            rows[corner as usize].push(number);
        }
    }
    let live = |row: &Vec<u32>| index32(row.len());
    let mut vertex_scores: Vec<f32> = rows
        .iter()
        .map(|row| SCORES_OUTSIDE.of(live(row)))
        .collect();
    let mut scores: Vec<f32> = corners
        .iter()
        .map(|&[a, b, c]| {
            let of = |vertex: u32| vertex_scores[vertex as usize];
            of(a) + of(b) + of(c)
        })
        .collect();
    let mut list: Vec<u32> = Vec::new();
    let mut order: Vec<u32> = Vec::new();
    let mut next = None;
    while order.len() < corners.len() {
        let in_file_order = || (0..index32(corners.len())).find(|face| !order.contains(face));
        let face = next.or_else(in_file_order).expect("some are left");
        order.push(face);
        let drawn = corners[face as usize];
        for corner in drawn {
            let row = &mut rows[corner as usize];
            let at = row.iter().position(|&other| other == face);
            row.swap_remove(at.expect("it stands there once for each corner"));
        }
        list.truncate(LIST_SIZE);
        list.retain(|vertex| !drawn.contains(vertex));
        list.splice(0..0, drawn);

        next = None;
        let mut greatest = 0.0;
        for (place, &vertex) in list.iter().enumerate() {
            let row = &rows[vertex as usize];
            if row.is_empty() {
                continue;
            }
            let score = VERTEX_SCORES[place].of(live(row));
            let before = std::mem::replace(&mut vertex_scores[vertex as usize], score);
            for &face in row {
                scores[face as usize] += score - before;
                if scores[face as usize] > greatest {
                    (greatest, next) = (scores[face as usize], Some(face));
                }
            }
        }
    }
    order
}

/// The order at every size of hubs is the plain one.
fn check(name: &str, vertex_count: usize, corners: &[[u32; 3]]) {
    let faces = Faces::new(corners, vertex_count).unwrap();
    let expected = plain(faces);
    for most_walked in [0, 1, 2, 3, 5, 8, 20, 100, u32::MAX] {
        let order = face_numbers(faces, most_walked, &Work::default()).unwrap();
        let differs = order.iter().zip(&expected).position(|(a, b)| a != b);
        assert_eq!(differs, None, "{name}, hubs above {most_walked}");
        assert_eq!(order.len(), expected.len(), "{name}");
    }
    assert!(Permutation::new(expected.clone()).is_ok(), "{name}");
    assert_eq!(
        linear_speed(faces).new_to_old(),
        expected,
        "{name}, as shipped"
    );
}

/// In file order, and with the faces shuffled and their corners turned.
fn check_shuffled(name: &str, vertex_count: usize, corners: &[[u32; 3]]) {
    check(name, vertex_count, corners);
    for seed in 0..3 {
        let mut numbers = SplitMix64(seed);
        let mut shuffled = random(corners.len(), seed).apply(corners);
        for face in &mut shuffled {
            face.rotate_left(numbers.below(3));
        }
        check(name, vertex_count, &shuffled);
    }
}

/// A regular grid of `side` × `side` squares.
fn grid(side: u32) -> Vec<[u32; 3]> {
    let squares = (0..side * side).map(|i| i / side * (side + 1) + i % side);
    let faces = squares.map(|v| [[v, v + 1, v + side + 2], [v, v + side + 2, v + side + 1]]);
    faces.flatten().collect()
}

/// Triangles of a wall of `rows` rings of `rim` vertices, and a fan at each end of it.
fn drum(rim: u32, rows: u32) -> Vec<[u32; 3]> {
    let at = |row: u32, i: u32| 2 + row * rim + i % rim;
    let mut faces = Vec::new();
    for i in 0..rim {
        faces.push([0, at(0, i + 1), at(0, i)]);
        faces.push([1, at(rows, i), at(rows, i + 1)]);
        for row in 0..rows {
            faces.push([at(row, i), at(row, i + 1), at(row + 1, i)]);
            faces.push([at(row + 1, i), at(row, i + 1), at(row + 1, i + 1)]);
        }
    }
    faces
}

#[test]
fn soups_are_drawn_as_described() {
    let cases = from_environment("MESHWEFT_CASES", 300);
    let first = from_environment("MESHWEFT_SEED", 0);
    for seed in first..first + cases {
        let mut numbers = SplitMix64(seed);
        let vertices = 1 + numbers.below(60);
        // Often few of them, so that faces repeat and name a vertex twice.
        let used = 1 + numbers.below(vertices);
        let corners: Vec<_> = (0..numbers.below(250))
            .map(|_| [(); 3].map(|()| index32(numbers.below(used))))
            .collect();
        check(&format!("soup {seed}"), vertices, &corners);
    }
}

#[test]
fn surfaces_are_drawn_as_described() {
    check_shuffled("grid", 14 * 14, &grid(13));
    check_shuffled("drum", 2 + 40 * 3, &drum(40, 2));
    check_shuffled("flat drum", 2 + 90, &drum(90, 0));
}

#[test]
fn fans_and_repeated_faces_are_drawn_as_described() {
    let fan: Vec<_> = (1..150).map(|i| [0, i, i + 1]).collect();
    check_shuffled("fan", 151, &fan);
    let book: Vec<_> = (2..150).map(|i| [0, 1, i]).collect();
    check_shuffled("book", 150, &book);
    for face in [[0, 1, 2], [1, 1, 1], [2, 0, 2]] {
        check(&format!("{face:?} again and again"), 4, &[face; 120]);
    }
    // A grid whose index buffer is filled up.
    let padded = [grid(7), vec![[3, 3, 3]; 100], vec![[3, 9, 3]; 50]].concat();
    check_shuffled("padded grid", 64, &padded);
    let double = [grid(7), grid(7)].concat();
    check_shuffled("double grid", 64, &double);
}

#[test]
fn nothing_is_drawn_of_nothing() {
    for vertex_count in [0, 1, 5] {
        check("nothing", vertex_count, &[]);
    }
}

#[test]
fn a_grid_is_drawn_with_few_misses_in_every_cache() {
    let shuffled = random(5000, 3).apply(&grid(50));
    let faces = Faces::new(&shuffled, 51 * 51).unwrap();
    let ordered = linear_speed(faces).apply(&shuffled);
    for (size, most) in [(12, 0.75), (16, 0.72), (32, 0.68)] {
        let acmr = cache::acmr(&ordered, CacheModel::fifo(size));
        assert!(acmr < most, "{acmr} misses a face at K = {size}");
    }
}

#[test]
fn a_traversal_ends_where_it_may_do_no_more() {
    let faces: Vec<[u32; 3]> = (0..30_000).map(|i| [i, i + 1, i + 2]).collect();
    let faces = Faces::of_checked(&faces, 30_002);
    let order = super::linear_speed_within_limits(faces, &|| true);
    assert_eq!(order, Some(super::linear_speed(faces)));
    assert_eq!(super::linear_speed_within_limits(faces, &|| false), None);

    // A strip has a few undrawn faces at the vertices of the list.
    let within = |most| {
        let work = Work {
            most,
            ..Work::default()
        };
        face_numbers(faces, super::HUB, &work)
    };
    assert!(within(30_000).is_none() && within(60 * 30_000).is_some());
}
