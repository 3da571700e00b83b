//! Any bytes as an archive and as a compressed mesh: no panic, no index beyond the vertices, no more than the limits
//! allow, polygons that are fans, and the same from bytes that arrive in pieces.
#![no_main]

use libfuzzer_sys::fuzz_target;
use meshweft::compression::{MeshArchive, MeshCode, MeshDecoder, PolygonOrder};
use meshweft::{Limits, Mesh};

fuzz_target!(|data: &[u8]| {
    let mut limits = Limits::default();
    limits.vertices = 1 << 14;
    limits.faces = 1 << 15;
    if let Ok(archive) = MeshArchive::from_bytes(data) {
        for mesh in 0..archive.len() {
            let _ = archive.decode_stored(mesh, limits);
        }
    }

    let whole = MeshCode::decode_stored(data, limits);
    let mut decoder = MeshDecoder::with_polygons(limits);
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let mut error = None;
    let mut left = data.len();
    for piece in data.chunks(7) {
        match decoder.push(piece) {
            Ok(used) => left -= used,
            Err(found) => error = Some(found),
        }
        positions.extend(decoder.take_positions());
        faces.extend(decoder.take_faces());
        if error.is_some() || decoder.is_complete() {
            break;
        }
    }
    let is_there = |&vertex: &u32| (vertex as usize) < limits.vertices;
    assert!(faces.as_flattened().iter().all(is_there));
    match whole {
        Ok(stored) => {
            assert!(error.is_none() && left == 0);
            decoder.finish().expect("as when it came at once");
            let polygons = decoder.take_polygons();
            assert_eq!(polygons, stored.polygons);
            if let Some(polygons) = polygons {
                check(&stored.mesh, &polygons);
            }
            let order = decoder.take_source_order().expect("it is complete");
            let mesh = MeshCode::decode(data, limits).expect("its triangles alone");
            assert_eq!(mesh.face_count(), stored.restore().0.face_count());
            let pieces = Mesh::new(positions, faces).expect("every vertex is there");
            let pieces = order.restore(pieces);
            let bits = |positions: &[[f32; 3]]| -> Vec<_> {
                positions.iter().map(|it| it.map(f32::to_bits)).collect()
            };
            assert_eq!(bits(pieces.positions()), bits(mesh.positions()));
            assert_eq!(pieces.faces(), mesh.faces());
        }
        Err(whole) => match error {
            Some(error) => assert_eq!(error, whole),
            None => assert!(left > 0 || decoder.finish().is_err()),
        },
    }
});

/// Each polygon is a fan.
fn check(mesh: &Mesh, polygons: &PolygonOrder) {
    let mesh = mesh.with_face_order(polygons.faces());
    let starts = polygons.starts();
    assert_eq!(
        starts.last().copied(),
        u32::try_from(mesh.face_count()).ok()
    );
    for ends in starts.windows(2) {
        for pair in mesh.faces()[ends[0] as usize..ends[1] as usize].windows(2) {
            assert_eq!([pair[1][0], pair[1][1]], [pair[0][0], pair[0][2]]);
        }
    }
}
