//! Values of face sets, by hand and by law.

use meshweft::Limits;
use meshweft::files::{Document, Edit};

use super::follow::{all, assert_follow, assert_same, listed, values};
use super::{BINDINGS, SHARING, data, face_set, open, written};
use crate::random::Random;

/// Puts all face sets in random orders, and asserts that all values follow; how many attributes
/// there are.
fn check_values(text: &str, seed: u64) -> usize {
    let mut random = Random(seed);
    let mut document = open(text.as_bytes());
    let mut count = 0;
    for mesh in 0..document.meshes().len() {
        for _ in 0..2 {
            let entry = document.meshes()[mesh].clone();
            let before = all(&document, mesh);
            let (faces, vertices) = random.orders(&entry);
            document
                .edit(Edit::order(mesh, &faces, vertices.as_ref()))
                .unwrap();
            let after = all(&document, mesh);
            assert_follow(&before, &entry, &after, &faces, vertices.as_ref());
        }
        count += document.attributes(mesh).len();
    }
    let again = open(written(&document).as_bytes());
    for mesh in 0..document.meshes().len() {
        assert_same(&all(&document, mesh), &all(&again, mesh));
    }
    count
}

#[test]
fn values_are_those_of_the_lists() {
    let document = open(BINDINGS.as_bytes());
    let house = [
        "POSITION Vertex 3 F32",
        "NORMAL Face 3 F32",
        "COLOR_0 Face 3 F32",
        "TEXCOORD_0 Corner 2 F32",
    ];
    assert_eq!(listed(&document, 0), house);
    assert_eq!(
        values(&document, 0, "POSITION")[6..12],
        [1., 1., 0., 0., 1., 0.]
    );
    let [x, y, z] = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    assert_eq!(values(&document, 0, "NORMAL"), [z, z, y, x].as_flattened());
    assert_eq!(values(&document, 0, "COLOR_0"), [y, y, x, y].as_flattened());
    let [a, b, c] = [[0., 0.], [1., 0.], [1., 1.]];
    let texture = [a, b, c, a, c, a, c, b, a, b, b, c];
    assert_eq!(values(&document, 0, "TEXCOORD_0"), texture.as_flattened());

    let second = [
        "POSITION Vertex 3 F32",
        "NORMAL Corner 3 F32",
        "COLOR_0 Vertex 3 F32",
        "TEXCOORD_0 Vertex 2 F32",
    ];
    assert_eq!(listed(&document, 1), second);
    assert_eq!(
        values(&document, 1, "NORMAL"),
        [z, y, x, x, y, z].as_flattened()
    );
    assert_eq!(
        values(&document, 1, "COLOR_0")[..6],
        [1., 0., 0., 0., 1., 0.]
    );
    assert_eq!(
        values(&document, 1, "TEXCOORD_0"),
        [0., 0., 1., 0., 1., 1., 0., 1.]
    );
    for seed in 1..40 {
        assert_eq!(check_values(BINDINGS, seed), 8);
    }
}

#[test]
fn shared_points_are_those_that_faces_name() {
    let document = open(SHARING.as_bytes());
    let points = |mesh| document.positions(mesh).unwrap().unwrap();
    assert_eq!(points(0), [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
    assert_eq!(points(1), [[1., 0., 0.], [0., 1., 0.]]);
    check_values(SHARING, 7);

    let more = "Shape { geometry IndexedFaceSet { coord USE C coordIndex [ 2 0 2 -1 0 0 2 ]\n\
                color Color { color [ 1 0 0 0 1 0 0 0 1 ] } } }";
    let text = face_set("", more).replace("coord Coordinate", "coord DEF C Coordinate");
    let document = open(text.as_bytes());
    assert_eq!(listed(&document, 1)[1..], ["COLOR_0 Vertex 3 F32"]);
    assert_eq!(values(&document, 1, "COLOR_0"), [1., 0., 0., 0., 0., 1.]);
    check_values(&text, 7);
}

#[test]
fn only_what_every_vertex_or_face_has_is_listed() {
    let infos = |more: &str| {
        let text = face_set(more, "ROUTE a.b TO N . vector");
        check_values(&text, 3);
        listed(&open(text.as_bytes()), 0)[1..].join(", ")
    };
    assert_eq!(infos(""), "");
    assert_eq!(infos("color USE C"), "");
    assert_eq!(infos("color USE C colorIndex [ 0 1 2 -1 1 1 1 -1 ]"), "");
    assert_eq!(
        infos("color USE C colorIndex [ 0 1 ] colorPerVertex FALSE"),
        ""
    );
    assert_eq!(infos("color Color { color [ 1 0 0 0 1 0 ] }"), "");
    let longer = "color Color { color [ 1 0 0 0 1 0 0 0 1 0 1 1 ] }";
    assert_eq!(infos(longer), "COLOR_0 Vertex 3 F32");
    let named = "normal DEF N Normal { vector [ 1 0 0 0 1 0 0 0 1 ] }";
    assert_eq!(infos(named), "NORMAL Vertex 3 F32");
    let empty = "colorIndex [ ] color Color { color [ 1 0 0 0 1 0 0 0 1 ] }";
    assert_eq!(infos(empty), "COLOR_0 Vertex 3 F32");
}

#[test]
fn bad_values_say_where_they_are() {
    let error = |more: &str| {
        let text = face_set(more, "");
        let document = open(text.as_bytes());
        let info = document.attributes(0).pop().unwrap();
        document.attribute(0, &info).unwrap_err().to_string()
    };
    let end = ". Fix it there, or re-export the file";
    let cases = [
        (
            "color Color { color [ 1 0 0\n0 1 0x 0 0 1 ] }",
            "6: \"0x\" is not a value: write a number",
        ),
        (
            "texCoord TextureCoordinate { point [ 0 0 ] } texCoordIndex [ 0 0 0 -1\n0 0 1 -1 ]",
            "6: texCoordIndex names texCoord 1, and there are 1",
        ),
        (
            "color Color { color [ 1 0 0 ] } colorIndex [ 0\n2 ] colorPerVertex FALSE",
            "6: colorIndex names color 2, and there are 1",
        ),
        (
            "normal Normal { vector [ ] } normalIndex [ 0 0 0 -1 0 0 -2 -1 ]",
            "5: normalIndex names normal 0, and there are 0",
        ),
    ];
    for (more, expected) in cases {
        assert_eq!(error(more), format!("mesh.wrl: line {expected}{end}"));
    }
}

#[test]
fn values_of_spoilt_files_are_refused_or_survive() {
    let pieces: [&[u8]; 8] = [b"\n", b" ", b"#", b"-", b"0", b"7", b"]", b"x"];
    let mut random = Random(5);
    for text in [BINDINGS, SHARING] {
        for _ in 0..10_000 {
            let spoilt = random.spoilt(text.as_bytes(), &pieces, 3);
            let (format, path) = (
                meshweft::files::Format::Vrml,
                std::path::Path::new(super::NAME),
            );
            let document = Document::from_bytes(spoilt, format, path, Limits::default());
            let Ok(mut document) = document else { continue };
            for mesh in 0..document.meshes().len() {
                let (faces, vertices) = random.orders(&document.meshes()[mesh]);
                document
                    .edit(Edit::order(mesh, &faces, vertices.as_ref()))
                    .unwrap();
                for info in document.attributes(mesh) {
                    let _ = document.attribute(mesh, &info);
                }
            }
        }
    }
}

#[test]
fn values_of_the_real_file_are_all_there() {
    let Some(folder) = data::folder() else { return };
    let path = folder.join("meshes/sextant.wrl.gz");
    let document = Document::open(&path, Limits::default()).unwrap();
    let attributes = check_values(&written(&document), 1);
    assert!(attributes >= document.meshes().len());
    eprintln!("{attributes} attributes of 1 file read, moved and compared");
}
