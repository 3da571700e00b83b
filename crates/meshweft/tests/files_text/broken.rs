//! Files that are broken, cut or spoilt: exact errors, and no harm done.

use meshweft::Limits;
use meshweft::files::Format;

use super::errors::error_of;
use super::stl::{ASCII, binary};
use super::{OBJ, PLY, PLY_HEAD, PLY_ROWS, binary_ply, error, name_of, round_trip};
use crate::random::Random;

#[test]
fn limits_are_kept() {
    let mut limits = Limits::default();
    (limits.vertices, limits.faces) = (2, 1);
    let open = |text: &str, format| {
        let name = name_of(format).to_str().unwrap();
        error_of(text.as_bytes(), name, limits)
    };
    let obj = open("v 0 0 0\nv 0 0 0\nv 0 0 0\n", Format::Obj);
    assert_eq!(
        obj,
        "mesh.obj: line 3: 3 vertices: more than the limit of 2"
    );
    let obj = open("v 0 0 0\nf 1 1 1\nf 1 1 1\n", Format::Obj);
    assert_eq!(obj, "mesh.obj: line 3: 2 faces: more than the limit of 1");
    let ply = open(&format!("{PLY_HEAD}end_header\n{PLY_ROWS}"), Format::Ply);
    assert_eq!(
        ply,
        "mesh.ply: line 3: 3 vertices: more than the limit of 2"
    );
    let stl = open(ASCII, Format::Stl);
    assert_eq!(stl, "mesh.stl: line 9: 2 faces: more than the limit of 1");
    let off = open("OFF\n1 1 0\n0 0 0\n4 0 0 0 0\n", Format::Off);
    assert_eq!(off, "mesh.off: line 4: 2 faces: more than the limit of 1");
}

#[test]
fn a_broken_file_says_what_where_and_what_to_do() {
    let (obj, off, ply) = (Format::Obj, Format::Off, Format::Ply);
    let cut = "Fetch it again or re-export it: it is incomplete";
    let head = format!("{PLY_HEAD}end_header\n");
    let cases: Vec<(String, Format, String)> = vec![
        ("v 0 0 0\n\nf 1 1 9\n".into(), obj, "line 3: face 0, corner 2: index 9 is past the last vertex (1)".to_string()),
        ("f 1 2 3\n".into(), obj, "line 1: face 0, corner 0: index 1, but the file has no vertices".to_string()),
        ("v 0 0 0\nf 1 0 1\n".into(), obj, "line 2: face 0, corner 1: index 0: vertices are counted from 1 (or back from -1)".into()),
        ("v 0 0 0\nf 1 1 1\nf 1 -2 1\n".into(), obj, "line 3: face 1, corner 1: index -2 counts back past the first of the 1 vertices above it".into()),
        ("v 0 0 0\nf 1 99999999999999999999 1\n".into(), obj, "line 2: face 0, corner 1: \"99999999999999999999\" is not a vertex number".into()),
        ("v 0 0 0\nf 1/2/3/4 1 1\n".into(), obj, "line 2: face 0, corner 0: \"1/2/3/4\" is not of the form 1/2/3".into()),
        ("v 0 0 0\nl 1 5\n".into(), obj, "line 2: line or point 0, corner 1: index 5 is past the last vertex (1)".to_string()),
        ("v 0 0\n".into(), obj, "line 1: vertex 1 has 2 coordinates and needs 3".into()),
        ("v 0 0 0 \\ \n".into(), obj, "line 1: a \\ at the end that is not followed by a line end: remove it".into()),
        ("\rv 0 zero 0\n".into(), obj, "line 2: \"zero\" is not a coordinate: write a number".into()),
        (String::new(), off, format!("line 1: the file ends inside the header: an OFF file starts with the word OFF. {cut}")),
        ("solid x\n".into(), off, "line 1: \"solid\" where an OFF file has the word OFF: is it another format?".into()),
        ("OFF BINARY\n".into(), off, "line 1: binary OFF is not read. Convert it to ascii OFF or to PLY first".into()),
        ("OFF\n-4 2 0\n".into(), off, "line 2: the number of vertices is \"-4\", which is not a count".into()),
        ("OFF\n1 1 0.5 0 0\n3 0 0 0\n".into(), off, "line 2: after the counts of vertices and faces comes that of edges, or a new line".into()),
        ("OFF\n2 1 0\n0 0 0\n0 0\n".into(), off, "line 4: vertex 1 has 2 numbers on its line and needs 3".into()),
        ("OFF\n2 1 0\n0 0 0\n".into(), off, format!("line 4: the file ends inside vertex 1 of 2. {cut}")),
        ("OFF\n1 1 0\n0 0 0\n3 0 0\n".into(), off, format!("line 5: the file ends inside face 0 of 1. {cut}")),
        ("OFF\n1 3 0\n0 0 0\n3 0 0 0\n3 0 0\n3 0 0 0\n".into(), off, "line 5: face 1 has 2 corners on its line, not the 3 it says".into()),
        ("OFFx 1 1\n".into(), off, "line 1: \"OFFx\" where an OFF file has the word OFF: is it another format?".into()),
        ("OFF\n1 1 0\n0 0 0\n3 0 -1 0\n".into(), off, "line 4: face 0, corner 1: index -1 is below zero".to_string()),
        ("OFF\n1 1 0\n0 0 0\n3 0 1X 0\n".into(), off, "line 4: face 0, corner 1: \"1X\" is not a vertex number".into()),
        (String::new(), ply, "line 1: a PLY file starts with the word ply: is it another format?".into()),
        ("ply\nformat ascii 1.0\n".into(), ply, format!("line 3: the file ends inside the header: there is no end_header. {cut}")),
        ("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar float vertex_indices\nend_header\n".into(), ply, "line 3: the corners of the faces are floats: export them as whole numbers".into()),
        ("ply\nformat ascii 1.0\nelement face 1\nproperty int a\nend_header\n".into(), ply, "line 3: the faces have no list vertex_indices or vertex_index: their corners are not known".into()),
        (format!("{head}0 0 0\n1 0 0\n"), ply, format!("line 12: the file ends inside vertex 2 of 3. {cut}")),
        (format!("{head}0 0 0\n1 0 0\n0 1 0 0\n"), ply, "line 12: vertex 2: more values on its line than the header declares".into()),
        (format!("{head}{}", PLY_ROWS.replace("3 2 1 0", "3 2 1 3")), ply, "line 14: face 1, corner 2: index 3 is past the last vertex (2)".to_string()),
        (format!("{head}{}", PLY_ROWS.replace("3 2 1 0", "-1 2 1 3")), ply, "line 14: face 1: a list of -1 entries".into()),
    ];
    for (text, format, expected) in cases {
        let found = error(text.as_bytes(), format);
        let prefix = format!("{}: ", name_of(format).display());
        assert_eq!(found, prefix + &expected);
    }
    for (bytes, expected) in stl_cases() {
        assert_eq!(error(&bytes, Format::Stl), format!("mesh.stl: {expected}"));
    }
    let mut bytes = binary_ply(true, "int", false, "");
    bytes.truncate(bytes.len() - 20);
    let end = bytes.len();
    let expected = format!("mesh.ply: byte {end}: the file ends inside vertex 5 of 6. {cut}");
    assert_eq!(error(&bytes, Format::Ply), expected);
}

fn stl_cases() -> Vec<(Vec<u8>, String)> {
    let cut = "Fetch it again or re-export it: it is incomplete";
    let facet =
        "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet";
    let text = |text: String, expected: &str| (text.into_bytes(), expected.to_owned());
    let mut short = binary("made by hand", 3, b"");
    short.truncate(84 + 149);
    let mut solid = binary("solid", 3, b"");
    solid.pop();
    let mut other = binary("made by hand", 1, b"");
    other[80..84].copy_from_slice(b"text");
    vec![
        (Vec::new(), format!("byte 0: the file ends inside the 84 bytes that a binary STL file starts with (an ascii one starts with the word solid). {cut}")),
        (short, format!("byte 233: the file ends inside facet 2 of 3. {cut}")),
        (solid, format!("byte 233: the file ends inside facet 2 of 3. {cut}")),
        (other, "byte 134: 1954047348 facets are promised and 1 are there: is it another format? An ascii STL file starts with the word solid".into()),
        text("solid\nendsolid\nx".into(), "line 3: \"x\" where \"solid\" or the end of the file is expected"),
        text("solidx\nendsolid\n".into(), "line 1: \"solidx\" where \"solid\" or the end of the file is expected"),
        text(format!("solid\n{facet}\n"), &format!("line 3: the file ends inside solid 0: there is no endsolid. {cut}")),
        text(format!("solid\n{facet}\nfacet\n"), &format!("line 4: the file ends inside facet 1. {cut}")),
        text(format!("solid\n{facet}\nsolid\n"), "line 3: \"solid\" where \"facet\" or \"endsolid\" is expected"),
        text(format!("solid\n{}", facet.replace("endloop", "vertex")), "line 2: \"vertex\" where \"endloop\" of facet 0 is expected"),
        text(format!("solid\n{}", facet.replace("vertex 1 0 0", "vertex 1 zero 0")), "line 2: facet 0, corner 1: \"zero\" is not a coordinate: write a number"),
        text(format!("solid\n{}", facet.replace("normal 0 0 1", "normal 0 0 ü")), "line 2: facet 0: \"ü\" is not part of a normal: write a number"),
    ]
}

/// One file of each kind, small enough to be spoilt in thousands of ways.
pub(super) fn small_files() -> Vec<(Vec<u8>, Format)> {
    let off = b"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0 # c\n3 0 1 2\n4 2 1 0 1 255 0\n";
    let obj = b"\\\n\nv 0 0 \\\n 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n 3\nf 3 2 1\nl -1 2";
    let runs = include_bytes!("../../../../fuzz/corpus/obj/runs.obj");
    let lists = "property list uchar uchar texcoord\n";
    vec![
        (OBJ.into(), Format::Obj),
        (obj.into(), Format::Obj),
        (runs.into(), Format::Obj),
        (PLY.into(), Format::Ply),
        (binary_ply(false, "int", true, ""), Format::Ply),
        (binary_ply(true, "uchar", false, lists), Format::Ply),
        (off.into(), Format::Off),
        (
            b"OFF 4 3 0 0 0 0 1 0 0\n0 1 0 2 2 2 3 0 1 2 3 2\n1 0 3 3 2 1".into(),
            Format::Off,
        ),
        (
            b"COFF\n2\n3\n0\n0 0\n0 1 1 1 1 1\n0 0 0 0 0 1\n3\n0 1 # c\n0 9\n2 0 1\n1 1\n".into(),
            Format::Off,
        ),
        (
            b"OFF3 2 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n4 2 1 0 1 1 0 0\n".into(),
            Format::Off,
        ),
        (ASCII.into(), Format::Stl),
        (binary("solid", 4, b"tail"), Format::Stl),
    ]
}

/// What the fuzz targets do, for a second and from known files.
#[test]
fn spoilt_files_are_refused_or_survive() {
    let pieces: [&[u8]; 20] = [
        b"\nvt 1\n",
        b"\nv 1 1 1\n",
        b"\nusemtl a\n",
        b"\nf -1/-1 -2/-2 1\n",
        b"\n",
        b"\r",
        b" ",
        b"#",
        b"\\",
        b"\\\n",
        b"-",
        b"/",
        b"0",
        b"1",
        b"\nf 1 2 3",
        b"\nv 1 1 1",
        b"f",
        b"\0",
        b"\xff",
        b"99999999999",
    ];
    let mut random = Random(77);
    for (bytes, format) in small_files() {
        let name = name_of(format).to_str().unwrap();
        round_trip::check(&bytes, format, name);
        for _ in 0..10_000 {
            let spoilt = random.spoilt(&bytes, &pieces, 4);
            round_trip::check(&spoilt, format, name);
        }
    }
}

#[test]
fn cut_files_are_refused_or_survive() {
    for (bytes, format) in small_files() {
        for length in 0..bytes.len() {
            round_trip::check(&bytes[..length], format, name_of(format).to_str().unwrap());
        }
    }
}
