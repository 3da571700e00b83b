//! Laws for any faces, and hostile bytes.

use super::FanCode;
use crate::bits::DecodeError;
use crate::faces::Faces;
use crate::index::index32;
use crate::random::SplitMix64;

/// Faces of any kind: parts of surfaces, flipped, repeated, with a vertex twice, many at one edge or vertex.
fn soup(random: &mut SplitMix64) -> (Vec<[u32; 3]>, usize) {
    let vertex_count = 1 + random.below(30);
    let mut faces: Vec<[u32; 3]> = Vec::new();
    if random.below(3) > 0 {
        // A piece of a grid, perhaps closed to a torus.
        let (width, height) = (3 + index32(random.below(4)), 3 + index32(random.below(4)));
        let closes = random.below(2) == 0;
        let vertex = |x: u32, y: u32| (y % height) * width + x % width;
        for y in 0..height - u32::from(!closes) {
            for x in 0..width - u32::from(!closes) {
                let [a, b] = [vertex(x, y), vertex(x + 1, y)];
                let [c, d] = [vertex(x + 1, y + 1), vertex(x, y + 1)];
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        for _ in 0..random.below(6) {
            faces.swap_remove(random.below(faces.len()));
        }
    }
    for _ in 0..random.below(24) {
        let any = |random: &mut SplitMix64| index32(random.below(vertex_count));
        let face = match (random.below(8), faces.last()) {
            (0, Some(&face)) => face,
            (1, Some(&[a, b, c])) => [a, c, b],
            (2..5, Some(&[a, b, _])) => [b, a, any(random)],
            (5, Some(&[a, b, _])) => [a, b, any(random)],
            _ => [any(random), any(random), any(random)],
        };
        faces.push(face);
    }

    // Any numbers, in any order.
    let most = faces.as_flattened().iter().copied().max().unwrap_or(0);
    let count = most as usize + 1 + random.below(4);
    let numbers = crate::random::shuffled(count, random.next());
    let mut faces: Vec<[u32; 3]> = crate::random::shuffled(faces.len(), random.next())
        .into_iter()
        .map(|face| faces[face as usize].map(|vertex| numbers[vertex as usize]))
        .collect();
    faces
        .iter_mut()
        .for_each(|face| face.rotate_left(random.below(3)));
    (faces, count)
}

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
