//! Files that are broken, cut or spoilt: exact errors, and no harm done.

use std::fmt::Write as _;

use meshweft::Limits;
use meshweft::files::Format;

use super::errors::error_of;
use super::{BINDINGS, NAME, SHARING, face_set, round_trip};
use crate::random::Random;

fn error(text: &str) -> String {
    error_of(text.as_bytes(), NAME, Limits::default())
}

#[test]
fn a_broken_file_says_what_where_and_what_to_do() {
    let cut = "Fetch it again or re-export it: it is incomplete";
    let headers = [
        (
            "",
            format!("the file ends inside the header: a VRML file starts with #VRML V2.0. {cut}"),
        ),
        (
            "#VRML V",
            format!("the file ends inside the header: a VRML file starts with #VRML V2.0. {cut}"),
        ),
        (
            "#VRML V1.0 ascii\n",
            "VRML 1.0 and Open Inventor are not read. Convert it to VRML 2.0 (VRML97) first".into(),
        ),
        (
            "#Inventor V2.1 ascii\n",
            "VRML 1.0 and Open Inventor are not read. Convert it to VRML 2.0 (VRML97) first".into(),
        ),
        (
            "#X3D V3.0 utf8\n",
            "X3D is not read. Convert it to VRML 2.0 (VRML97) first".into(),
        ),
        (
            "\u{feff}\n<?xml version=\"1.0\"?>",
            "X3D is not read. Convert it to VRML 2.0 (VRML97) first".into(),
        ),
        (
            "ply\n",
            "a VRML file starts with #VRML V2.0 and this one does not: is it another format?"
                .into(),
        ),
    ];
    for (text, expected) in headers {
        assert_eq!(error(text), format!("{NAME}: line 1: {expected}"));
    }
    let set = |points: &str, indices: &str| {
        format!(
            "IndexedFaceSet {{ coord Coordinate {{ point [\n{points} ] }} coordIndex [\n{indices} ] }}"
        )
    };
    let cases = [
        (
            set("0 0 0", "0 0 0 -1\n0 9 0 -1"),
            "line 5: face 1, corner 1: index 9 is past the last vertex (0)".to_string(),
        ),
        (
            set("0 0 0", "0 -2 0"),
            "line 4: face 0, corner 1: index -2 is below zero".to_string(),
        ),
        (
            set("", "0 0 0"),
            "line 4: face 0, corner 0: index 0, but the file has no vertices".to_string(),
        ),
        (
            set("0 0 0", "0 0.5 0"),
            "line 4: \"0.5\" is not a vertex number".into(),
        ),
        (
            set("0 0 0", "0 0x 0"),
            "line 4: \"0x\" is not a vertex number".into(),
        ),
        (
            set("0 0 0 1", "0"),
            "line 3: the Coordinate has 4 numbers, which are not three a vertex".into(),
        ),
        (
            set("0\n0 1-1", "0"),
            "line 4: \"1-1\" is not a coordinate: write a number".into(),
        ),
        (
            set("0 zero 0", "0"),
            "line 3: \"zero\" where a number of \"point\" is expected".into(),
        ),
        (
            "IndexedFaceSet { coordIndex }".into(),
            "line 2: \"}\" where a number of \"coordIndex\" is expected".into(),
        ),
        (
            "IndexedFaceSet { coordIndex [ 0".into(),
            format!("line 2: the file ends inside the numbers of \"coordIndex\". {cut}"),
        ),
        (
            "IndexedFaceSet { colorPerVertex 1 }".into(),
            "line 2: \"1\" where TRUE or FALSE is expected".into(),
        ),
        (
            "Group { children [ \"a\\\"".into(),
            format!("line 2: the file ends inside a string: there is no \" that ends it. {cut}"),
        ),
        (
            "Group {\nchildren [".into(),
            format!(
                "line 3: the file ends inside a list: there is no ] for what is opened here. {cut}"
            ),
        ),
        (
            "Group {\nchildren [ ]".into(),
            format!(
                "line 2: the file ends inside a node: there is no }} for what is opened here. {cut}"
            ),
        ),
        (
            "Group { children [ }".into(),
            "line 2: a } that closes nothing".into(),
        ),
        ("]".into(), "line 2: a ] that closes nothing".into()),
        (
            "{ }".into(),
            "line 2: a { without the type of a node in front of it".into(),
        ),
        (
            "Shape { geometry DEF {".into(),
            "line 2: no name after DEF".into(),
        ),
        (
            "Shape { geometry USE".into(),
            format!("line 2: the file ends inside what follows USE. {cut}"),
        ),
        (
            "ROUTE a.b c.d e f".into(),
            "line 2: a ROUTE without the word TO".into(),
        ),
        (
            "PROTO P { }".into(),
            "line 2: a PROTO without the [ of its interface".into(),
        ),
        (
            "PROTO P [ ] Group { }".into(),
            "line 2: a PROTO without the { of its body".into(),
        ),
        (
            "Group { children [ ".repeat(600),
            "line 2: 257 nodes and lists inside each other: more than the limit of 256".into(),
        ),
    ];
    for (text, expected) in cases {
        let found = error(&format!("#VRML V2.0 utf8\n{text}"));
        assert_eq!(found, format!("{NAME}: {expected}"), "{text}");
    }
}

#[test]
fn limits_are_kept() {
    let mut limits = Limits::default();
    limits.faces = 1;
    let text = face_set("", "");
    let found = error_of(text.as_bytes(), NAME, limits);
    assert_eq!(found, "mesh.wrl: line 4: 2 faces: more than the limit of 1");
    limits.vertices = 2;
    let found = error_of(text.as_bytes(), NAME, limits);
    assert_eq!(
        found,
        "mesh.wrl: line 3: 3 vertices: more than the limit of 2"
    );
}

#[test]
fn cut_files_are_refused_or_survive() {
    for text in [BINDINGS, SHARING] {
        for length in 0..text.len() {
            round_trip::check(&text.as_bytes()[..length], Format::Vrml, NAME);
        }
    }
}

/// What the fuzz target does, for a second and from known files.
#[test]
fn spoilt_files_are_refused_or_survive() {
    let pieces = [
        " ",
        ",",
        "#",
        "\n",
        "\"",
        "\\",
        "{",
        "}",
        "[",
        "]",
        "-1",
        "0",
        "9",
        ".",
        "-1 ",
        " -1 -1 ",
        "FALSE",
        "TRUE",
        "NULL",
        " USE C ",
        "DEF C ",
        "IS x",
        "\u{1}",
        "PROTO P [ ] {",
        "Coordinate {",
        "IndexedFaceSet {",
        " coordIndex [",
        " point [",
        " colorIndex [ ] ",
    ];
    let mut random = Random(99);
    for text in [BINDINGS, SHARING] {
        round_trip::check(text.as_bytes(), Format::Vrml, NAME);
        for _ in 0..10_000 {
            let spoilt = random.spoilt(text.as_bytes(), &pieces, 4);
            round_trip::check(&spoilt, Format::Vrml, NAME);
        }
    }
}

/// Many face sets, many that share points, notes on many lines: each takes as long as the one
/// before, or this would not end.
#[test]
fn many_face_sets_take_linear_time() {
    let mut text =
        String::from("#VRML V2.0 utf8\nIndexedFaceSet { coord DEF C Coordinate { point [\n");
    for point in 0..20_000 {
        let _ = writeln!(text, "{point} 0 0");
    }
    text.push_str("] } coordIndex [ 0 1 2 -1 ] }\n");
    for set in 0..20_000 {
        let _ = writeln!(
            text,
            "IndexedFaceSet {{ coord USE C coordIndex [ {set} 1 2 -1 3 4 5 -1 ] }}"
        );
    }
    round_trip::check(text.as_bytes(), Format::Vrml, NAME);
}
