//! PLY, OFF and STL: random selections, compared by meaning and by the bytes of each record.

use meshweft::files::{Document, Edit, Format};

use crate::choice::Choice;
use crate::random::Random;
use crate::simple::{self, Pieces};
use crate::{assert_read_again, check, open, select, written};

/// Selects at random, again and again, until one face is left.
fn check_random(bytes: &[u8], format: Format, seed: u64) {
    let mut random = Random(seed);
    let mut document = open(bytes, format);
    let has_vertices = format != Format::Stl;
    let all = Choice::all(&document.meshes()[0]);
    select(&mut document, &[(0, all)]).unwrap();
    assert!(written(&document) == bytes, "everything is nothing to do");
    for round in 0..6 {
        // Orders that were given before are part of the file.
        if round % 2 == 1 {
            let entry = &document.meshes()[0];
            let (faces, vertices) = random.orders(entry);
            document
                .edit(Edit::order(0, &faces, vertices.as_ref()))
                .unwrap();
        }
        let choice = Choice::random(&document.meshes()[0], &mut random);
        let before = (written(&document), document.meshes()[0].polygons.is_some());
        if before.1 {
            check_polygons(&mut document, &choice);
        } else {
            check(&mut document, 0, &choice, has_vertices);
            let [old, new] = [&before.0, &written(&document)].map(|b| simple::read(b, format));
            assert_records(&old, &new, &choice, has_vertices);
        }
        if document.meshes()[0].mesh.face_count() == 1 {
            break;
        }
    }
}

/// Polygons stay where their first face was asked for, so the order of faces may be another.
fn check_polygons(document: &mut Document, choice: &Choice) {
    let faces = |document: &Document, kept: Option<&Vec<u32>>| {
        let old_of = |vertex: u32| kept.map_or(vertex, |kept| kept[vertex as usize]);
        let faces = document.meshes()[0].mesh.faces().iter();
        let mut faces: Vec<[u32; 3]> = faces.map(|face| face.map(old_of)).collect();
        faces.sort_unstable();
        faces
    };
    select(document, &[(0, choice.clone())]).unwrap();
    let mut expected: Vec<[u32; 3]> = choice.faces.iter().map(|face| face.corners).collect();
    expected.sort_unstable();
    assert_eq!(faces(document, choice.vertices.as_ref()), expected);
    assert_read_again(document);
}

/// Asserts that each vertex record is that of the source, and each face record too, but for the corners
/// that were to change; and that nothing else has changed but digits of the header and line ends.
fn assert_records(old: &Pieces, new: &Pieces, choice: &Choice, has_vertices: bool) {
    if has_vertices {
        let all: Vec<u32> = (0..old.vertices.len() as u32).collect();
        let kept = choice.vertices.as_ref().unwrap_or(&all);
        let expected = kept.iter().map(|&vertex| &old.vertices[vertex as usize]);
        assert!(new.vertices.iter().eq(expected));
    }
    for (face, selected) in new.faces.iter().zip(&choice.faces) {
        let old = &old.faces[selected.face as usize];
        if has_vertices {
            let corners = old.vertices.iter().zip(selected.corners);
            if corners.clone().all(|(&old, new)| old == new as usize) {
                assert_eq!((&face.glued, &face.between), (&old.glued, &old.between));
            }
            assert_eq!(face.between.first(), old.between.first());
            assert_eq!(face.between.last(), old.between.last());
        }
    }
    let rest = |pieces: &Pieces| {
        let rest = pieces.rest.iter().copied();
        let is_left =
            |byte: &u8| !byte.is_ascii_digit() && !byte.is_ascii_whitespace() && *byte > 8;
        rest.filter(is_left).collect::<Vec<u8>>()
    };
    if has_vertices {
        assert_eq!(
            String::from_utf8_lossy(&rest(old)),
            String::from_utf8_lossy(&rest(new))
        );
    }
}

/// A grid of `side` by `side` quads, each two faces: the positions and the faces.
fn grid(side: usize) -> (Vec<[f32; 3]>, Vec<[usize; 3]>) {
    let row = side + 1;
    let place = |v: usize| {
        [
            (v % row) as f32,
            (v / row) as f32 * 0.5,
            (v % 3) as f32 * 0.125,
        ]
    };
    let positions = (0..row * row).map(place).collect();
    let quads = (0..side * side).map(|q| q / side * row + q % side);
    let faces = quads.flat_map(|v| [[v, v + 1, v + row], [v + 1, v + row + 1, v + row]]);
    (positions, faces.collect())
}

#[test]
fn ascii_ply() {
    let (positions, faces) = grid(4);
    let mut text = format!(
        "ply\r\nformat ascii 1.0\r\ncomment element vertex 7\r\nelement  vertex\t{} \r\nproperty float x\r\n\
         property float y\r\nproperty float z\r\nproperty uchar red\r\nelement face {}\r\nproperty int id\r\n\
         property list uchar int vertex_indices\r\nproperty float quality\r\nelement camera 2\r\n\
         property float view\r\nend_header\r\n",
        positions.len(),
        faces.len()
    );
    for (number, [x, y, z]) in positions.iter().enumerate() {
        text += &format!(" {x} {y}\t{z} {number} \r\n");
    }
    for (number, [a, b, c]) in faces.iter().enumerate() {
        text += &format!("{number} 3 {a}  {b} {c} 0.{number}\r\n");
        text += ["", "\r\n"][usize::from(number % 7 == 3)];
    }
    text += "1.5\r\n2.5\r\nafter";
    for seed in 1..60 {
        check_random(text.as_bytes(), Format::Ply, seed);
    }
}

/// A binary PLY of the grid, with quads as well if `has_quads`.
fn binary_ply(is_big: bool, width: usize, has_quads: bool) -> Vec<u8> {
    let (positions, faces) = grid(4);
    let order = ["little", "big"][usize::from(is_big)];
    let index = ["", "uchar", "ushort", "", "int"][width];
    let quads: &[[usize; 4]] = if has_quads {
        &[[0, 1, 6, 5], [12, 13, 18, 17]]
    } else {
        &[]
    };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex {}\nproperty double x\nproperty float y\n\
         property float z\nproperty list uchar float data\nelement face {}\nproperty uchar red\n\
         property list uchar {index} vertex_indices\nproperty short flag\nelement camera 1\nproperty int id\n\
         end_header\n",
        positions.len(),
        faces.len() + quads.len()
    )
    .into_bytes();
    let put = |bytes: &mut Vec<u8>, mut number: Vec<u8>| {
        if is_big {
            number.reverse();
        }
        bytes.extend(number);
    };
    for (number, [x, y, z]) in positions.into_iter().enumerate() {
        put(&mut bytes, f64::from(x).to_le_bytes().to_vec());
        put(&mut bytes, y.to_le_bytes().to_vec());
        put(&mut bytes, z.to_le_bytes().to_vec());
        bytes.push((number % 3) as u8);
        for _ in 0..number % 3 {
            put(&mut bytes, (number as f32).to_le_bytes().to_vec());
        }
    }
    let triangles = faces.iter().map(<[usize; 3]>::as_slice);
    let quads = quads.iter().map(<[usize; 4]>::as_slice);
    for (number, corners) in triangles.chain(quads).enumerate() {
        bytes.extend([number as u8, corners.len() as u8]);
        for corner in corners {
            put(&mut bytes, corner.to_le_bytes()[..width].to_vec());
        }
        put(&mut bytes, (number as u16).to_le_bytes().to_vec());
    }
    bytes.extend(b"\x01\x02\x03\x04trailing\n");
    bytes
}

#[test]
fn binary_ply_of_either_order() {
    for is_big in [false, true] {
        for width in [1, 2, 4] {
            for seed in 1..20 {
                check_random(&binary_ply(is_big, width, false), Format::Ply, seed);
                check_random(&binary_ply(is_big, width, true), Format::Ply, seed);
            }
        }
    }
}

#[test]
fn off_lines() {
    let (positions, faces) = grid(4);
    let counts = format!("{} {} 0", positions.len(), faces.len());
    let mut text = format!("# first\nCOFF # colours\n{counts} # counts\n");
    for (number, [x, y, z]) in positions.iter().enumerate() {
        let comment = ["", " # here"][usize::from(number % 5 == 2)];
        text += &format!("\t{x} {y} {z} {number} 0 255{comment}\n");
    }
    text += "# between\n\n";
    for (number, [a, b, c]) in faces.iter().enumerate() {
        let comment = ["", "  # face"][usize::from(number % 4 == 1)];
        text += &format!("3  {a} {b} {c} {number} 1 2{comment}\n");
    }
    text += "# after";
    for seed in 1..60 {
        check_random(text.as_bytes(), Format::Off, seed);
        let polygons = text.replacen(&counts, &format!("{} {} 0", positions.len(), 33), 1);
        let polygons = polygons.replace("# after", "4 0 1 6 5 9 9 9\n# after");
        check_random(polygons.as_bytes(), Format::Off, seed);
    }
}

#[test]
fn stl_facets() {
    let (positions, faces) = grid(3);
    let facets = faces
        .iter()
        .map(|face| face.map(|vertex| positions[vertex]));
    let mut binary = vec![b'x'; 80];
    binary.extend((faces.len() as u32).to_le_bytes());
    let mut text = String::from("solid one\n");
    for (number, corners) in facets.enumerate() {
        for value in [[0.0, 0.0, 2.0], corners[0], corners[1], corners[2]].as_flattened() {
            binary.extend(value.to_le_bytes());
        }
        binary.extend((number as u16).to_le_bytes());
        if number == 9 {
            text += "endsolid one\nsolid two\n";
        }
        text += "  facet normal 0 0 2\n    outer loop\n";
        for [x, y, z] in corners {
            text += &format!("      vertex {x}  {y:.3} {z:e}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text += "endsolid two\n";
    binary.extend(b"behind");
    for seed in 1..60 {
        check_random(&binary, Format::Stl, seed);
        check_random(text.as_bytes(), Format::Stl, seed);
    }
}
