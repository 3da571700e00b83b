//! Laws for any faces, and hostile bytes.

use super::super::soups::soup;
use super::FanCode;
use crate::bits::DecodeError;
use crate::faces::Faces;
use crate::index::index32;
use crate::random::SplitMix64;

fn check(faces: &[[u32; 3]], vertex_count: usize, first: u32) -> Result<Vec<u8>, DecodeError> {
    let of = Faces::new(faces, vertex_count).unwrap();
    let code = FanCode::new(of, first);
    let decoded = FanCode::decode(code.bytes(), faces.len(), vertex_count)?;
    assert_eq!(
        decoded,
        code.vertices().renumber(&code.faces().apply(faces)),
        "{faces:?}"
    );

    // A mesh that was decoded has the same code.
    let again = FanCode::new(Faces::new(&decoded, vertex_count).unwrap(), 0);
    assert_eq!(again.bytes(), code.bytes(), "{faces:?}");
    assert!(again.vertices().is_identity() && again.faces().is_identity());
    Ok(code.bytes().to_vec())
}

#[test]
fn any_faces_come_back_and_have_the_same_code_then() {
    let mut random = SplitMix64(1);
    for _ in 0..5000 {
        let (faces, vertex_count) = soup(&mut random);
        let first = index32(random.below(vertex_count));
        check(&faces, vertex_count, first).unwrap();
    }
    check(&[], 0, 0).unwrap();
    check(&[], 3, 2).unwrap();
}

#[test]
fn large_fans_and_books_take_no_longer_a_face() {
    // Many faces at one vertex, in one fan, in pages at an edge, and apart.
    let count = 30_000;
    let fan: Vec<[u32; 3]> = (0..count)
        .map(|i| [0, i + 1, (i + 1) % count + 1])
        .collect();
    let pages: Vec<[u32; 3]> = (0..count).map(|i| [0, 1, i + 2]).collect();
    let apart: Vec<[u32; 3]> = (0..count).map(|i| [0, 2 * i + 1, 2 * i + 2]).collect();
    let reversed: Vec<[u32; 3]> = (0..count).map(|i| [2 * i, 2 * i + 1, 2 * count]).collect();
    let same = vec![[0, 1, 2]; count as usize];
    for faces in [fan, pages, apart, reversed, same] {
        let vertex_count = *faces.as_flattened().iter().max().unwrap() as usize + 1;
        check(&faces, vertex_count, 0).unwrap();
    }
}

#[test]
fn faces_that_name_a_vertex_twice_take_a_third_of_their_numbers() {
    // A strip, and between two of its faces one without area, the vertex that is there twice at any corner.
    let faces = (0..10_000_u32).flat_map(|i| {
        let (mut face, mut flat) = ([i, i + 1, i + 2], [i, i, i + 1 + i % 2]);
        face.rotate_left(i as usize % 3);
        flat.rotate_left(i as usize % 3);
        [face, flat]
    });
    let faces: Vec<_> = faces.collect();
    let bytes = check(&faces, 10_002, 0).unwrap();
    // Three numbers of two bytes each.
    assert!(bytes.len() < 20_000, "{} bytes", bytes.len());
}

#[test]
fn damaged_bytes_give_an_error_or_faces_that_are_there() {
    let mut random = SplitMix64(2);
    for _ in 0..1000 {
        let (faces, vertex_count) = soup(&mut random);
        let bytes = check(&faces, vertex_count, 0).unwrap();
        for _ in 0..20 {
            let mut damaged = bytes.clone();
            for _ in 0..=random.below(3) {
                match (random.below(3), damaged.len()) {
                    (_, 0) => damaged.push(7),
                    (0, length) => damaged.truncate(random.below(length)),
                    (1, length) => damaged[random.below(length)] ^= 1 << random.below(8),
                    (_, length) => {
                        damaged.insert(random.below(length), random.next().to_le_bytes()[0])
                    }
                }
            }
            let counts = [
                faces.len() + random.below(3),
                vertex_count + random.below(3),
            ];
            if let Ok(decoded) = FanCode::decode(&damaged, counts[0], counts[1]) {
                assert_eq!(decoded.len(), counts[0]);
                let is_there = |&vertex: &u32| (vertex as usize) < counts[1];
                assert!(decoded.as_flattened().iter().all(is_there));
            }
        }
    }
}
