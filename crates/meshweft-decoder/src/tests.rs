//! Meshes through the exports, as a host calls them.

use meshweft::Mesh;
use meshweft::compression::{CodeOptions, MeshCode};

use super::*;

/// Strips of faces, several blocks of them, and a vertex without faces.
fn mesh() -> Mesh {
    let width = 90_u32;
    let positions = (0..=width * width).map(|i| [i as f32, (i / width) as f32, 0.25]);
    let faces = (0..width * (width - 1) - 1).flat_map(|i| {
        let (below, next) = (i + width, i + width + 1);
        [[below, i, i + 1], [below, i + 1, next]]
    });
    Mesh::new(positions.collect::<Vec<_>>(), faces.collect::<Vec<_>>()).unwrap()
}

/// Gives some bytes; returns the status, and what came out.
fn push(decoder: *mut Decoder, bytes: &[u8]) -> (u32, Vec<[f32; 3]>, Vec<[u32; 3]>) {
    // SAFETY: `decoder` is there until the end of a test, and the host reads and writes only where it may.
    unsafe {
        let at = decoder_input(decoder, bytes.len());
        at.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len());
        let status = decoder_push(decoder);
        let (positions, faces) = (decoder_positions(decoder), decoder_faces(decoder));
        (
            status,
            std::slice::from_raw_parts(positions, decoder_position_count(decoder)).to_vec(),
            std::slice::from_raw_parts(faces, decoder_face_count(decoder)).to_vec(),
        )
    }
}

#[test]
fn a_mesh_arrives_in_pieces() {
    arrives_in_pieces(&MeshCode::new(&mesh(), &CodeOptions::default()).unwrap());
}

#[test]
fn polygons_are_passed_over() {
    let mesh = mesh();
    let starts: Vec<u32> = (0_u32..)
        .step_by(2)
        .take(mesh.face_count() / 2 + 1)
        .collect();
    let code = MeshCode::of_polygons(&mesh, &starts, &CodeOptions::default()).unwrap();
    assert!(code.polygons().kept > 5000);
    arrives_in_pieces(&code);
}

fn arrives_in_pieces(code: &MeshCode) {
    let whole = MeshCode::decode(code.bytes(), Limits::default()).unwrap();
    let bytes = [code.bytes(), &[7; 5]].concat();

    let decoder = decoder_new(usize::MAX, usize::MAX);
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let mut last = Status::Incomplete as u32;
    for some in bytes.chunks(1000) {
        assert_eq!(last, Status::Incomplete as u32);
        let (status, new_positions, new_faces) = push(decoder, some);
        positions.extend(new_positions);
        faces.extend(new_faces);
        last = status;
    }
    assert_eq!(last, Status::Complete as u32);
    assert_eq!(
        (&positions[..], &faces[..]),
        (whole.positions(), whole.faces())
    );
    // SAFETY: it is there until the last call.
    unsafe {
        assert_eq!(decoder_unused(decoder), 5);
        assert_eq!(decoder_all_vertices(decoder), whole.vertex_count());
        assert_eq!(decoder_all_faces(decoder), whole.face_count());
        decoder_free(decoder);
    }
}

#[test]
fn what_is_wrong_is_told_apart() {
    let mesh = mesh();
    let code = MeshCode::new(&mesh, &CodeOptions::default()).unwrap();
    // One face less than there are: the low byte of their number is after tier, flags and vertices.
    let mut damaged = code.bytes().to_vec();
    damaged[4] -= 1;
    let most = [mesh.vertex_count(), mesh.face_count()];
    for (bytes, [vertices, faces], expected, places) in [
        (&damaged[..], most, Status::Damaged, 5..damaged.len()),
        (&[200, 0][..], most, Status::Unknown, 0..3),
        (
            code.bytes(),
            [most[0] - 1, most[1]],
            Status::AboveLimit,
            0..9,
        ),
        (
            code.bytes(),
            [most[0], most[1] - 1],
            Status::AboveLimit,
            0..9,
        ),
    ] {
        let decoder = decoder_new(vertices, faces);
        assert_eq!(push(decoder, bytes).0, expected as u32);
        // It stays so.
        assert_eq!(push(decoder, bytes).0, expected as u32);
        // SAFETY: it is there until the last call.
        unsafe {
            let place = decoder_error_byte(decoder);
            assert!(places.contains(&place), "{expected:?} at {place}");
            decoder_free(decoder);
        }
    }
}
