//! Triangle strips of PLY, as they are and as faces.

use meshweft::files::{Document, Edit, Format, Place, ReadOptions};
use meshweft::{FaceOrder, Limits, Permutation};

use super::{check, name_of, open, round_trip, written};
use crate::random::Random;

/// Two strips, the second of two pieces; one triangle has a vertex twice.
const STRIPS: [&[i32]; 3] = [&[0, 1, 2, 3, 3, 4], &[2, 1, 0, -1, 4, 3, 2, 1], &[5, 0]];
const FACES: [[u32; 3]; 5] = [[0, 1, 2], [1, 3, 2], [2, 1, 0], [4, 3, 2], [3, 1, 2]];

fn head(encoding: &str, types: &str, end: &str) -> String {
    format!(
        "ply\nformat {encoding} 1.0\nelement vertex 6\nproperty float x\nproperty float y\n\
         property float z\nelement tristrips 3\ncomment strips\nproperty list {types} vertex_indices\n\
         element camera 1\nproperty uchar id\nend_header\n"
    )
    .replace('\n', end)
}

fn as_faces(bytes: &[u8]) -> Document {
    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    Document::from_bytes(bytes.to_vec(), Format::Ply, name_of(Format::Ply), options).unwrap()
}

fn ascii(end: &str) -> String {
    let mut text = head("ascii", "int int", end);
    for x in 0..6 {
        text += &format!("{x} 0 0{end}");
    }
    for strip in STRIPS {
        let numbers: Vec<String> = strip.iter().map(i32::to_string).collect();
        text += &format!("{} {}{end}", strip.len(), numbers.join(" "));
    }
    text + &format!("7{end}")
}

fn binary(encoding: &str, types: &str, size: usize) -> Vec<u8> {
    let is_big = encoding == "binary_big_endian";
    let number = |number: i32, size: usize| match is_big {
        true => number.to_be_bytes()[4 - size..].to_vec(),
        false => number.to_le_bytes()[..size].to_vec(),
    };
    let mut bytes = head(encoding, types, "\n").into_bytes();
    bytes.extend([1; 72]);
    for strip in STRIPS {
        bytes.extend(number(strip.len() as i32, 4));
        strip.iter().for_each(|&v| bytes.extend(number(v, size)));
    }
    bytes.push(7);
    bytes
}

#[test]
fn strips_stay_unless_faces_are_asked_for() {
    let text = ascii("\n");
    let document = open(text.as_bytes(), Format::Ply);
    assert!(document.meshes().is_empty());
    assert_eq!(document.notes()[0].place, Place::Line(7));
    assert_eq!(
        document.notes()[0].text,
        "triangle strips stay as they are; strips_to_lists makes faces of them"
    );
    assert_eq!(written(&document), text.as_bytes());
}

#[test]
fn strips_become_faces_in_text() {
    for end in ["\n", "\r\n"] {
        let document = as_faces(ascii(end).as_bytes());
        assert_eq!(document.meshes()[0].mesh.faces(), FACES);
        assert!(document.meshes()[0].vertices_movable);
        assert_eq!(
            document.notes()[0].text,
            "the triangle strips are 5 faces now; 2 triangles with a vertex twice are left out"
        );
        let text = String::from_utf8(written(&document)).unwrap();
        let expected = ascii(end).replace("element tristrips 3", "element face 5");
        let expected = expected.replace("list int int", "list uchar int");
        let (before, _) = expected.split_once("6 0 1 2 3 3 4").unwrap();
        let rows = "3 0 1 2\n3 1 3 2\n3 2 1 0\n3 4 3 2\n3 3 1 2";
        assert_eq!(text, format!("{before}{rows}{end}7{end}"));
        check(text.as_bytes(), Format::Ply, 3);
    }
}

#[test]
fn strips_become_faces_in_binary() {
    for encoding in ["binary_little_endian", "binary_big_endian"] {
        for (types, size) in [
            ("int int", 4),
            ("uint uint32", 4),
            ("int short", 2),
            ("int char", 1),
        ] {
            let bytes = binary(encoding, types, size);
            let mut document = as_faces(&bytes);
            assert_eq!(
                document.meshes()[0].mesh.faces(),
                FACES,
                "{encoding} {types}"
            );
            let lists = written(&document);
            assert!(lists.ends_with(&[7]));
            let item = types.split_once(' ').unwrap().1;
            let line = format!("property list uchar {item} vertex_indices\n");
            assert!(
                lists
                    .windows(line.len())
                    .any(|window| window == line.as_bytes())
            );
            check(&lists, Format::Ply, 4);

            // They are ordered as faces.
            let order = Permutation::new(vec![4, 3, 2, 1, 0]).unwrap();
            let order = FaceOrder::from(order);
            document.edit(Edit::order(0, &order, None)).unwrap();
            let again = open(&written(&document), Format::Ply);
            let reversed: Vec<[u32; 3]> = FACES.into_iter().rev().collect();
            assert_eq!(again.meshes()[0].mesh.faces(), reversed);
        }
    }
}

#[test]
fn strips_with_more_than_numbers_stay() {
    let text = ascii("\n");
    let error = {
        let mut options = ReadOptions::from(Limits::default());
        options.strips_to_lists = true;
        let broken = text.replace("6 0 1 2 3 3 4", "6 0 1 2 3 3 9");
        let read = Document::from_bytes(broken.into(), Format::Ply, name_of(Format::Ply), options);
        read.unwrap_err().to_string()
    };
    assert!(error.contains("line 19: "), "{error}");
    assert!(
        error.contains("index 9 is past the last vertex (5)"),
        "{error}"
    );

    let with_more = text.replace(
        "property list int int vertex_indices\n",
        "property list int int vertex_indices\nproperty int id\n",
    );
    let with_more = with_more
        .replace("3 4\n", "3 4 0\n")
        .replace("2 1\n", "2 1 1\n")
        .replace("5 0\n", "5 0 2\n");
    assert!(as_faces(with_more.as_bytes()).meshes().is_empty());
}

/// What the fuzz target does, for a second and from known files.
#[test]
fn spoilt_strips_are_refused_or_become_faces() {
    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    let read = |bytes: &[u8], options: &ReadOptions| {
        Document::from_bytes(bytes.to_vec(), Format::Ply, name_of(Format::Ply), options)
    };
    let mut random = Random(9);
    let pieces: [&[u8]; 6] = [b"\n", b" ", b"0", b"-1 ", b"tristrips", b"\nelement face 0"];
    let mut accepted = 0;
    for file in [
        ascii("\n").into_bytes(),
        binary("binary_little_endian", "int int", 4),
        binary("binary_big_endian", "int char", 1),
    ] {
        for _ in 0..4000 {
            let spoilt = random.spoilt(&file, &pieces, 3);
            let Ok(document) = read(&spoilt, &options) else {
                continue;
            };
            let bytes = written(&document);
            let again = read(&bytes, &ReadOptions::default()).unwrap();
            assert_eq!(document.meshes().len(), again.meshes().len());
            for (made, read) in document.meshes().iter().zip(again.meshes()) {
                assert_eq!(made.mesh.faces(), read.mesh.faces());
                accepted += 1;
            }
            round_trip::check(&bytes, Format::Ply, "mesh.ply");
        }
    }
    assert!(accepted > 300, "{accepted}");
}
