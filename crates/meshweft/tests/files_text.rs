//! OBJ, PLY, OFF and STL files: records are permuted, every other byte stays.
#![cfg(feature = "files")]
#![expect(clippy::cast_possible_truncation, reason = "test meshes are small")]

#[path = "files_text/broken.rs"]
mod broken;
#[path = "data/folder.rs"]
mod data;
#[path = "files_errors/mod.rs"]
mod errors;
#[path = "files_text/follow.rs"]
mod follow;
#[path = "files_text/free_off.rs"]
mod free_off;
#[path = "files_text/not_finite.rs"]
mod not_finite;
#[path = "files_text/obj_comments.rs"]
mod obj_comments;
#[path = "files_text/obj_materials.rs"]
mod obj_materials;
#[path = "files_text/obj_runs.rs"]
mod obj_runs;
#[path = "files_text/obj_values.rs"]
mod obj_values;
#[path = "files_text/off_attributes.rs"]
mod off_attributes;
#[path = "files_text/others.rs"]
mod others;
#[path = "files_text/ply_strips.rs"]
mod ply_strips;
#[path = "files_text/ply_values.rs"]
mod ply_values;
#[path = "files_random/mod.rs"]
mod random;
#[path = "files_text/real.rs"]
mod real;
#[path = "../../../fuzz/fuzz_targets/round_trip/mod.rs"]
mod round_trip;
#[path = "files_text/simple.rs"]
mod simple;
#[path = "files_text/simple_stl.rs"]
mod simple_stl;
#[path = "files_text/stl.rs"]
mod stl;
#[path = "files_text/stl_attributes.rs"]
mod stl_attributes;

use std::path::Path;

use errors::error_of;
use meshweft::files::{Document, Edit, Format, MeshEntry};
use meshweft::{FaceOrder, Limits, Permutation, VertexOrder};
use random::Random;
use simple::Pieces;

fn name_of(format: Format) -> &'static Path {
    Path::new(match format {
        Format::Obj => "mesh.obj",
        Format::Ply => "mesh.ply",
        Format::Stl => "mesh.stl",
        _ => "mesh.off",
    })
}

fn open(bytes: &[u8], format: Format) -> Document {
    let limits = Limits::default();
    Document::from_bytes(bytes.to_vec(), format, name_of(format), limits).unwrap()
}

fn entry_of(bytes: &[u8], format: Format) -> MeshEntry {
    open(bytes, format).meshes()[0].clone()
}

fn error(bytes: &[u8], format: Format) -> String {
    let name = name_of(format).to_str().unwrap();
    error_of(bytes, name, Limits::default())
}

fn written(document: &Document) -> Vec<u8> {
    document.to_main_bytes().unwrap()
}

/// Asserts that `new` is `old` with its records in these orders, and nothing else.
fn assert_permuted(old: &Pieces, new: &Pieces, faces: &FaceOrder, vertices: &VertexOrder) {
    assert!(old.rest == new.rest, "bytes outside records changed");
    let permuted = vertices.permutation().apply(&old.vertices);
    assert!(
        permuted == new.vertices,
        "vertex records are not the old ones in the new order"
    );
    let old_of = |vertex: &usize| vertices.new_to_old()[*vertex] as usize;
    let lines: Vec<usize> = new.lines.iter().map(old_of).collect();
    assert_eq!(lines, old.lines);
    assert_eq!(new.definitions, old.definitions);
    let below = faces.new_to_old().iter().zip(&new.below);
    for (&record, &below) in below {
        let before = old.below[record as usize];
        assert!(below <= before, "face {record} went above what it names");
    }
    assert_eq!(new.faces.len(), old.faces.len());
    for (number, (face, &record)) in new.faces.iter().zip(faces.new_to_old()).enumerate() {
        let mut expected = old.faces[record as usize].clone();
        let rotation = usize::from(faces.rotation(number));
        if !expected.vertices.is_empty() {
            expected.vertices.rotate_left(rotation);
            expected.glued.rotate_left(rotation);
        }
        let mut found = face.clone();
        found.vertices = found.vertices.iter().map(old_of).collect();
        assert_eq!(found, expected, "face {number}");
    }
}

/// Asserts that what one document has after its orders is what the other was read with.
fn assert_same_attributes(moved: &Document, read: &Document) {
    assert_eq!(moved.attributes(0), read.attributes(0));
    for info in moved.attributes(0) {
        let numbers = [moved, read].map(|document| document.attribute(0, &info));
        let numbers = numbers.map(|read| read.ok().map(|attribute| attribute.to_f32()));
        let bits = numbers.map(|numbers| {
            let bits = |numbers: Vec<f32>| numbers.into_iter().map(f32::to_bits).collect();
            numbers.map(bits)
        });
        let [moved, read]: [Option<Vec<u32>>; 2] = bits;
        assert!(moved == read, "{info:?}");
    }
}

/// Puts the records in random orders, once and once more, and compares what is written with the
/// independent reader's view.
fn check(bytes: &[u8], format: Format, seed: u64) {
    check_times(bytes, format, seed, 2);
}

/// [`check`] with as many orders as `times` says.
fn check_times(bytes: &[u8], format: Format, seed: u64, times: usize) {
    let mut random = Random(seed);
    let mut document = open(bytes, format);
    assert!(
        written(&document) == bytes,
        "a file is written as it was read"
    );
    let Some(entry) = document.meshes().first() else {
        return;
    };
    let identity = FaceOrder::identity(entry.record_count());
    let stay = VertexOrder::identity(entry.mesh.vertex_count());
    document.edit(Edit::order(0, &identity, &stay)).unwrap();
    assert!(
        written(&document) == bytes,
        "orders that move nothing change nothing"
    );
    for _ in 0..times {
        let before = simple::read(&written(&document), format);
        let (faces, vertices) = random.orders(&document.meshes()[0]);
        document
            .edit(Edit::order(0, &faces, vertices.as_ref()))
            .unwrap();
        let after = written(&document);
        let vertices = vertices.unwrap_or_else(|| stay.clone());
        assert_permuted(&before, &simple::read(&after, format), &faces, &vertices);
        let again = open(&after, format);
        let (now, read) = (&document.meshes()[0], &again.meshes()[0]);
        assert_eq!(now.mesh.faces(), read.mesh.faces());
        assert_eq!((&now.polygons, &now.runs), (&read.polygons, &read.runs));
        assert_same_attributes(&document, &again);
        assert!(
            written(&again) == after,
            "reading and writing again changes nothing"
        );
    }
}

const OBJ: &str = "\u{feff}# a comment\r\n\tmtllib a.mtl \r\no  first thing \r\n\
v 0 0 0 1 0 0 # red\r\n  v 1 0 0\r\nv\t0 1 0\r\n\r\nv 0 0 1   \r\nvt 0 0\r\nvt 1 1\r\nvn 0 0 1\r\n\
f 1/1/1 2/2/1 3/1/1 # one\r\n# between\r\n\r\n  f 1//1  2//1\t4//1\r\nf +2/1 -2/2 -1\r\n\
usemtl b\r\nf 3 2 1\r\nl 1 2/1 -1\r\np 3 4\r\nf 4 3 1  \r\nf 1 2 4";

#[test]
fn obj_records_move_within_their_runs() {
    for seed in 1..40 {
        check(OBJ.as_bytes(), Format::Obj, seed);
    }
    let entry = &entry_of(OBJ.as_bytes(), Format::Obj);
    assert_eq!(entry.name, "first thing");
    assert_eq!(entry.runs, [0, 3]);
    assert!(entry.corners_turnable && entry.vertices_movable);
}

#[test]
fn obj_polygons_are_not_turned() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 2\nf\nf -1 -2 -3\n";
    for seed in 1..10 {
        check(text.as_bytes(), Format::Obj, seed);
    }
    let entry = &entry_of(text.as_bytes(), Format::Obj);
    assert_eq!(entry.polygons, Some(vec![0, 2, 2, 2, 3]));
    assert!(!entry.corners_turnable);
}

#[test]
fn an_obj_statement_goes_on_after_a_backslash() {
    let text = "v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 \\\r\n 3\nf 2 3 4 \\\n\nf 1 3 4 # \\\nf 1 2 4\n";
    let mut document = open(text.as_bytes(), Format::Obj);
    assert_eq!(document.meshes()[0].mesh.face_count(), 4);
    let order = FaceOrder::from(Permutation::new(vec![3, 2, 1, 0]).unwrap());
    let last_first = VertexOrder::from(Permutation::new(vec![3, 2, 1, 0]).unwrap());
    document.edit(Edit::order(0, &order, &last_first)).unwrap();
    let expected = "v 0 0 1\nv 0 1 0\nv 1 0 0\nv 0 \\\n 0 0\nf 4 3 1\nf 4 2 1 # \\ \\\n\nf 3 2 1\nf 4 3 \\\r\n 2\n";
    assert_eq!(String::from_utf8(written(&document)).unwrap(), expected);
}

#[test]
fn obj_vertices_stay_where_something_may_name_them() {
    let reasons = [
        (
            "v 0 0 0\nf 1 1 1\nv 1 1 1\n",
            "mesh.obj",
            3,
            "this one comes after faces, lines or points",
        ),
        (
            "v 0 0 0\nf 1 1 1\nsurf 0 1 0 1 1\n",
            "",
            3,
            "the statement \"surf\" may name them",
        ),
        (
            "v 0 0 0\nvn 0 0 1\nf 1 1 1\n",
            "",
            2,
            "the vn lines, one for each and not used by any face, may belong to them",
        ),
    ];
    for (text, _, line, reason) in reasons {
        let document = open(text.as_bytes(), Format::Obj);
        assert!(!document.meshes()[0].vertices_movable);
        let [note] = document.notes() else {
            panic!("one note: {:?}", document.notes());
        };
        assert_eq!(
            note.text,
            format!("the vertices stay where they are: {reason}")
        );
        assert_eq!(note.place, meshweft::files::Place::Line(line));
        check(text.as_bytes(), Format::Obj, 5);
    }
}

const PLY: &str = "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 4\r\n\
property float x\r\nproperty double y\r\nproperty int z\r\nproperty uchar label\r\n\
element face 3\r\nproperty uchar red\r\nproperty list uchar int vertex_indices\r\nproperty float quality\r\n\
end_header\r\n0 0 0 7\r\n  1 nan 0 8 \r\n\r\n0 1 -inf 9\r\n0 0 1 10\r\n255 3 0 1 2 0.5\r\n\
7 3 1 2 3  .25\r\n  0 3 3 1 0 1e3 \r\nwhat comes after\r\n";

#[test]
fn ply_rows_move_with_all_they_hold() {
    for seed in 1..40 {
        check(PLY.as_bytes(), Format::Ply, seed);
    }
    let entry = &entry_of(PLY.as_bytes(), Format::Ply);
    assert!(entry.corners_turnable && entry.vertices_movable);
}

/// A binary PLY with lists of both kinds, polygons where `mixed`, indices of type `index`.
fn binary_ply(big: bool, index: &str, mixed: bool, more: &str) -> Vec<u8> {
    let format = if big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement face 5\nproperty uchar red\n\
         property list ushort {index} vertex_index\n{more}element vertex 6\nproperty short a\n\
         property float x\nproperty float y\nproperty float z\nend_header\n"
    )
    .into_bytes();
    let width = match index {
        "uchar" => 1,
        "short" => 2,
        _ => 4,
    };
    let put = |bytes: &mut Vec<u8>, value: u32, width: usize| match big {
        true => bytes.extend(&value.to_be_bytes()[4 - width..]),
        false => bytes.extend(&value.to_le_bytes()[..width]),
    };
    for face in 0..5_u32 {
        bytes.push(face as u8);
        let count = if mixed { face } else { 3 };
        put(&mut bytes, count, 2);
        for corner in 0..count {
            put(&mut bytes, (face + corner * 2) % 6, width);
        }
        if !more.is_empty() {
            bytes.extend([1, face as u8]);
        }
    }
    for vertex in 0..6 {
        put(&mut bytes, vertex, 2);
        bytes.extend([vertex as u8; 12]);
    }
    bytes.extend(b"\r\ntail");
    bytes
}

#[test]
fn binary_ply_rows_of_every_shape_move() {
    for big in [false, true] {
        for index in ["uchar", "short", "int", "uint32"] {
            for mixed in [false, true] {
                for more in ["", "property list uchar uchar texcoord\n"] {
                    let bytes = binary_ply(big, index, mixed, more);
                    let entry = &entry_of(&bytes, Format::Ply);
                    assert_eq!(entry.corners_turnable, !mixed && more.is_empty());
                    assert!(entry.vertices_movable);
                    for seed in 1..5 {
                        check(&bytes, Format::Ply, seed);
                    }
                }
            }
        }
    }
}

const PLY_HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
property float z\nelement face 2\nproperty list uchar int vertex_indices\n";
const PLY_ROWS: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n";

#[test]
fn ply_elements_that_go_by_numbers_keep_them() {
    let note = |more: &str, rows: &str| {
        let text = format!("{PLY_HEAD}{more}end_header\n{PLY_ROWS}{rows}");
        let document = open(text.as_bytes(), Format::Ply);
        check(text.as_bytes(), Format::Ply, 3);
        let notes = document.notes().iter().map(|note| note.text.clone());
        let entry = &document.meshes()[0];
        (
            entry.vertices_movable,
            entry.runs.len(),
            notes.collect::<Vec<_>>(),
        )
    };
    let stay = "the vertices stay where they are: the element";
    let edges = note(
        "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
        "0 1\n",
    );
    assert_eq!(
        edges,
        (
            false,
            1,
            vec![format!("{stay} \"edge\" may name them by number")]
        )
    );
    let material = note("element material 1\nproperty int red\n", "0\n");
    assert_eq!(material, (true, 1, vec![]));
    // Two rows beside two faces.
    let unknown = note("element patch 2\nproperty int kind\n", "4\n5\n");
    let faces = "the faces stay where they are: the element \"patch\" may go by their order";
    let vertices = format!("{stay} \"patch\" may name them by number");
    assert_eq!(unknown, (false, 2, vec![vertices, faces.to_owned()]));
    let strip = "property list uchar int flags\n";
    let text = format!("{PLY_HEAD}{strip}end_header\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2 0\n3 2 1 0 0\n");
    assert!(!open(text.as_bytes(), Format::Ply).meshes()[0].vertices_movable);
}

#[test]
fn narrow_ply_indices_keep_their_vertices() {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 257\nproperty float x\nelement face 1\n\
                    property list uchar uchar vertex_indices\nend_header\n"
        .to_owned();
    text.push_str(&"0\n".repeat(257));
    text.push_str("3 0 1 255\n");
    let document = open(text.as_bytes(), Format::Ply);
    assert!(!document.meshes()[0].vertices_movable);
    assert!(document.positions(0).unwrap().is_none());
    assert_eq!(
        document.notes()[0].text,
        "the vertices stay where they are: their indices are stored in 1 bytes, which cannot name all 257"
    );
}

#[test]
fn rows_of_texture_faces_go_with_their_faces() {
    let more = "element multi_texture_face 2\nproperty uchar tx\n\
                property list uchar int texture_vertex_indices\n";
    let text = format!("{PLY_HEAD}{more}end_header\n{PLY_ROWS}0 3 7 8 9\n1 3 9 8 7 \n");
    let mut document = open(text.as_bytes(), Format::Ply);
    let entry = &document.meshes()[0];
    assert!(entry.vertices_movable && !entry.corners_turnable);
    let order = FaceOrder::from(Permutation::new(vec![1, 0]).unwrap());
    document.edit(Edit::order(0, &order, None)).unwrap();
    let output = String::from_utf8(written(&document)).unwrap();
    assert!(
        output.ends_with("3 2 1 0\n3 0 1 2\n1 3 9 8 7\n0 3 7 8 9 \n"),
        "{output}"
    );
}

#[test]
fn ply_headers_may_end_their_lines_with_returns() {
    let head = PLY_HEAD
        .replace('\n', "\r")
        .replace("ascii", "binary_little_endian");
    let mut bytes = format!("{head}end_header\r").into_bytes();
    // The first byte of the rows is a line feed.
    bytes.extend([b'\n'; 36]);
    for face in [[0, 1, 2], [2, 1, 0_u32]] {
        bytes.push(3);
        bytes.extend(face.map(u32::to_le_bytes).concat());
    }
    let document = open(&bytes, Format::Ply);
    assert_eq!(document.meshes()[0].mesh.faces(), [[0, 1, 2], [2, 1, 0]]);
}

#[test]
fn off_records_move_with_all_they_hold() {
    let texts = [
        "OFF\n4 3 0\n0 0 0\n1 0 0 # here\n\n# a comment\n 0 1 0 9 9\n0 0 1\n3 0 1 2\n  3 1 2 3 255 0 0 # red\n3 3 2 0",
        "# first\r\nCOFF 4 2 0\r\n0 0 0 1 1 1 1\r\n1 0 0 1 1 1 1\r\n0 1 0 1 0 0 1\r\n0 0 1 0 0 1 1\r\n4 0 1 2 3 0.5\r\n3 2 1 0\r\nafter\r\n",
        "4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0\n1 3\n2 1 2\n",
        "STCN4OFF\n1 1 0\n0 0 0 1  0 0 1 1  1 1 1  0 0\n3 0 0 0\n",
    ];
    for text in texts {
        for seed in 1..20 {
            check(text.as_bytes(), Format::Off, seed);
        }
    }
    let plane = open(b"nOFF\n2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n", Format::Off);
    assert_eq!(plane.positions(0).unwrap().unwrap()[1], [1.0, 0.0, 0.0]);
}

#[test]
fn files_without_faces_have_nothing_to_order() {
    let points = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n";
    let strips = "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n2 0 1\n";
    for (bytes, format) in [
        ("", Format::Obj),
        ("v 0 0 0\np 1\n", Format::Obj),
        ("OFF\n1 0 0\n0 0 0\n", Format::Off),
        ("ply\nformat ascii 1.0\nend_header\n", Format::Ply),
        (points, Format::Ply),
        (strips, Format::Ply),
    ] {
        let document = open(bytes.as_bytes(), format);
        assert_eq!((document.meshes().len(), document.notes().len()), (0, 1));
        assert_eq!(written(&document), bytes.as_bytes());
    }
}
