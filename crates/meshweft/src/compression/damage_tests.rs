//! Streams that were damaged.

use super::tests::{KEPT, any_mesh, ways};
use super::{CodeOptions, MeshCode, Tier};
use crate::index::index32;
use crate::limits::Limits;
use crate::random::{SplitMix64, from_environment};

#[test]
fn damaged_bytes_give_an_error_or_a_mesh() {
    let cases = from_environment("MESHWEFT_CASES", 500);
    let seed = from_environment("MESHWEFT_SEED", 5);
    let mut random = SplitMix64(seed);
    let (mut streams, mut read) = (0_u64, 0_u64);
    for case in 0..cases {
        let mesh = any_mesh(&mut random);
        let positions = ways(&mesh)[random.below(2)];
        let options = CodeOptions {
            tier: Tier::ALL[random.below(Tier::ALL.len())],
            positions,
            keep_order: KEPT[(case % 4) as usize],
            ..Default::default()
        };
        let starts = any_polygons(&mut random, mesh.face_count());
        let Ok(code) = MeshCode::of_polygons(&mesh, &starts, &options) else {
            continue;
        };
        for _ in 0..20 {
            streams += 1;
            read += u64::from(is_read(&damaged(code.bytes(), &mut random)));
        }
    }
    println!("{streams} damaged streams of {cases} meshes from seed {seed}: {read} give a mesh");
    assert!(read > 0 && read < streams);
}

/// Polygons of some of the faces, one after the other.
fn any_polygons(random: &mut SplitMix64, faces: usize) -> Vec<u32> {
    let mut starts = vec![0];
    let mut next = 0;
    while next < faces {
        next = (next + 1 + random.below(3)).min(faces);
        starts.push(index32(next));
    }
    starts
}

/// Bytes that were cut, changed or added to at one to three places.
fn damaged(bytes: &[u8], random: &mut SplitMix64) -> Vec<u8> {
    let mut damaged = bytes.to_vec();
    for _ in 0..=random.below(3) {
        match (random.below(3), damaged.len()) {
            (_, 0) => damaged.push(7),
            (0, length) => damaged.truncate(random.below(length)),
            (1, length) => damaged[random.below(length)] ^= 1 << random.below(8),
            (_, length) => damaged.insert(random.below(length), 1 << random.below(8)),
        }
    }
    damaged
}

/// Whether bytes give a mesh: then its faces and polygons are sound, and within limits.
fn is_read(bytes: &[u8]) -> bool {
    let limits = Limits {
        vertices: 1000,
        faces: 1000,
        ..Limits::default()
    };
    let Ok(decoded) = MeshCode::decode_stored(bytes, limits) else {
        return false;
    };
    let (mesh, starts) = decoded.restore();
    assert!(mesh.vertex_count() <= 1000 && mesh.face_count() <= 1000);
    let is_there = |&vertex: &u32| (vertex as usize) < mesh.vertex_count();
    assert!(mesh.faces().as_flattened().iter().all(is_there));
    let starts = starts.unwrap_or_else(|| vec![0, index32(mesh.face_count())]);
    assert!(starts.is_sorted() && starts.last() == Some(&index32(mesh.face_count())));
    true
}
